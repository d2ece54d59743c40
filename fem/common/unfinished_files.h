// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Registers a file to be deleted unless it is finished. Returns its index in the list, or -1 without registering if
/// the list is full (64 files) or the path is longer than 1,000 bytes.
int noteUnfinishedFile(const std::string& path);

/// Removes a file from the list; -1 is allowed.
void forgetUnfinishedFile(int place);

/// Deletes all files of the list. Safe in a signal handler.
BULLETFEM_API void removeUnfinishedFiles();

}  // namespace bullet_fem
