// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string_view>

namespace bullet_fem
{

/// Number of bytes used to recognise a file's format.
constexpr std::size_t kHeadBytes = 512;

/// Throws std::runtime_error if a file with these first bytes is binary and not supported: the message names its
/// format, if recognised, and a remedy; `endings` are the supported extensions, ".off or .ply".
void refuseForeignFile(std::string_view bytes, const char* endings);

/// The text without UTF-8's byte order mark, which some editors insert.
inline std::string_view withoutByteOrderMark(std::string_view bytes)
{
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return bytes.substr(0, mark.size()) == mark ? bytes.substr(mark.size()) : bytes;
}

}  // namespace bullet_fem
