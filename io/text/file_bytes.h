// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// The extension of a file's name with its dot, in lower case; empty if there is none.
BULLETFEM_API std::string lowerCaseEnding(const std::string& path);

/// Throws std::runtime_error with the cause, without the path, unless this is a regular file.
BULLETFEM_API void checkIsFile(const std::string& path);

/// All bytes of a regular file. Throws std::runtime_error with the cause, without the path.
BULLETFEM_API std::string readBytes(const std::string& path);

/// The first bytes of a file, at most `most`; none if it cannot be read.
std::string readHead(const std::string& path, std::size_t most);

}  // namespace bullet_fem
