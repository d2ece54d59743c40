// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <string_view>

namespace bullet_fem
{

/// Writes a file as one act: to `path`.part, which then takes the name, so that a reader, a crash or a full disk never
/// leaves half a file under it. What the name stood for is replaced; devices and pipes are written to. Throws
/// std::runtime_error naming the path and the cause; an older file of the name is left as it was, and no .part remains.
void writeOutputFile(const std::string& path, std::string_view bytes);

}  // namespace bullet_fem
