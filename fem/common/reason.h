// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <exception>
#include <string>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Readable text of an exception: the first 600 characters of what(), because library messages may echo a file; for
/// std::bad_alloc, that memory ran out, and the remedy.
BULLETFEM_API std::string reasonOf(const std::exception& error);

}  // namespace bullet_fem
