// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <exception>
#include <string>

namespace bullet_fem
{

/// Calls what may throw; false and the reason in `why` (if given) if it did.
template <class Call>
bool succeeds(const Call& call, std::string* why)
{
    try
    {
        call();
        return true;
    }
    catch (const std::exception& error)
    {
        if (why) *why = error.what();
        return false;
    }
}

}  // namespace bullet_fem
