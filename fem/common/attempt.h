// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <exception>
#include <string>

#include "fem/common/reason.h"

namespace bullet_fem
{

/// Calls a function that may throw, for functions whose last argument is `why`. If `why` is null, exceptions propagate.
/// Otherwise an exception is caught, its reason is written to `why`, and false is returned.
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

/// Like attempt(), for a call that returns a value: returns a default-constructed value after an exception.
template <class Call>
auto attemptValue(std::string* why, const Call& call)
{
    decltype(call()) value{};
    attempt(why, [&] { value = call(); });
    return value;
}

}  // namespace bullet_fem
