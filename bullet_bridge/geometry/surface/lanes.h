// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

namespace bullet_fem
{

/// Four floats that are calculated with as one: a vector of GCC and Clang, which is SSE2 or NEON.
using FloatLanes = float __attribute__((vector_size(16)));
using LaneMask = std::int32_t __attribute__((vector_size(16)));  ///< of comparisons: all bits set where they hold

/// Likewise, two doubles.
using DoubleLanes = double __attribute__((vector_size(16)));

// As std::min and std::max in every lane.
template <class Lanes>
Lanes laneMin(const Lanes& a, const Lanes& b)
{
    return b < a ? b : a;
}
template <class Lanes>
Lanes laneMax(const Lanes& a, const Lanes& b)
{
    return a < b ? b : a;
}

inline bool isAny(const LaneMask& mask)
{
    using Halves = std::int64_t __attribute__((vector_size(16)));
    const Halves halves = reinterpret_cast<Halves>(mask);
    return (halves[0] | halves[1]) != 0;
}

}  // namespace bullet_fem
