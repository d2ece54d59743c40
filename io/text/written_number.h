// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <charconv>
#include <string>

namespace bullet_fem
{

/// A number with nine digits, which represent a float exactly, independent of the locale.
inline std::string writtenNumber(double value)
{
    constexpr int digits = 9;
    char text[40];
    return std::string(text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr);
}

/// A number with the fewest digits for an exact round trip.
inline std::string exactNumber(double value)
{
    char text[40];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace bullet_fem
