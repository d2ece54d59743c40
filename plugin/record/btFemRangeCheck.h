// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

/// Returns `good`; if it is false and `why` is not null, writes the setting, its value and its range there.
inline bool btFemRangeCheck(bool good, std::string* why, const char* name, double value, const std::string& range)
{
    if (!good && why) *why = std::string(name) + " is " + std::to_string(value) + ", not in " + range;
    return good;
}
