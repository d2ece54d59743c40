// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Notes a file that must not outlive the process unless it is finished. Returns its place in the list; -1 where the
/// list is full (64 files) or the path longer than 1,000 bytes, and then it is not noted.
int noteUnfinishedFile(const std::string& path);

/// Takes a file off the list; -1 is allowed.
void forgetUnfinishedFile(int place);

/// Deletes all files of the list. A signal handler may call it.
BULLETFEM_API void removeUnfinishedFiles();

}  // namespace bullet_fem
