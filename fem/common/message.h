// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace bullet_fem
{

/// Concatenates the parts; numbers have up to ten digits.
template <typename... Parts>
std::string message(const Parts&... parts)
{
    std::ostringstream out;
    out.precision(10);
    (out << ... << parts);
    return out.str();
}

/// Throws std::invalid_argument with message(parts...): name the value, the allowed range and the remedy.
template <typename... Parts>
[[noreturn]] void reject(const Parts&... parts)
{
    throw std::invalid_argument(message(parts...));
}

}  // namespace bullet_fem
