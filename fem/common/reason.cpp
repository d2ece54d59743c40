// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/reason.h"

#include <new>

namespace bullet_fem
{

std::string reasonOf(const std::exception& error)
{
    constexpr std::size_t kLongest = 600;  // characters: eight lines of a terminal
    if (dynamic_cast<const std::bad_alloc*>(&error))
        return "there is not enough memory; ask for fewer elements or bodies, or close other programs";
    std::string text = error.what();
    if (text.size() > kLongest) text.replace(kLongest, text.npos, "...");
    return text;
}

}  // namespace bullet_fem
