// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <stdexcept>
#include <string>

namespace bullet_fem
{

/// Expects std::invalid_argument from `build`, with all of `parts` in its message.
template <typename Build>
void expectRejected(Build build, std::initializer_list<const char*> parts)
{
    std::string text = "nothing was thrown";
    try
    {
        build();
    }
    catch (const std::invalid_argument& error)
    {
        text = error.what();
    }
    for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
}

}  // namespace bullet_fem
