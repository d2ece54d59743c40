// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// A number rounded to single precision. By way of memory: GCC 12.2 takes a vector's conversion there and back for none
/// at all.
inline double roundedToSingle(double value)
{
    const volatile float single = static_cast<float>(value);
    return static_cast<double>(single);
}

}  // namespace bullet_fem
