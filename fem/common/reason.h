// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <exception>
#include <string>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// What an exception says, for people: of a long text, as libraries make that echo a file, the first 600 characters;
/// of std::bad_alloc, that memory ran out and what to do.
BULLETFEM_API std::string reasonOf(const std::exception& error);

}  // namespace bullet_fem
