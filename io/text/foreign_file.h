// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string_view>

namespace bullet_fem
{

/// Bytes looked at to tell what a file is.
constexpr std::size_t kHeadBytes = 512;

/// Throws std::runtime_error if a file that begins so is binary and none that is read: it says in words what the file
/// is, if its first bytes tell, and what to do; `endings` are those that can be read, ".off or .ply".
void refuseForeignFile(std::string_view bytes, const char* endings);

/// Without UTF-8's byte order mark, which some editors put in front of a text.
inline std::string_view withoutByteOrderMark(std::string_view bytes)
{
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return bytes.substr(0, mark.size()) == mark ? bytes.substr(mark.size()) : bytes;
}

}  // namespace bullet_fem
