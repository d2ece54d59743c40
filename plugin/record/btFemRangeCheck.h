// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

/// Returns `good`; where it is false and `why` is there, that tells the setting, its value and the range it must be in.
inline bool btFemRangeCheck(bool good, std::string* why, const char* name, double value, const std::string& range)
{
    if (!good && why) *why = std::string(name) + " is " + std::to_string(value) + ", not in " + range;
    return good;
}
