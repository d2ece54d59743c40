// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <exception>
#include <string>

#include "fem/common/reason.h"

namespace bullet_fem
{

/// Calls what may throw, for functions whose last argument is `why`. Null: what is thrown goes on. Else false is
/// returned, and the reason written to it, where something was thrown.
template <class Call>
bool attempt(std::string* why, const Call& call)
{
    if (!why)
    {
        call();
        return true;
    }
    try
    {
        call();
        return true;
    }
    catch (const std::exception& error)
    {
        *why = reasonOf(error);
        return false;
    }
}

/// The same for what returns a value: one made by its default constructor where something was thrown.
template <class Call>
auto attemptValue(std::string* why, const Call& call)
{
    decltype(call()) value{};
    attempt(why, [&] { value = call(); });
    return value;
}

}  // namespace bullet_fem
