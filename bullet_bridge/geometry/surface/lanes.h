// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

namespace bullet_fem
{

/// Four floats of a SIMD vector (vector extension of GCC and Clang: SSE2 or NEON).
using FloatLanes = float __attribute__((vector_size(16)));
using LaneMask = std::int32_t __attribute__((vector_size(16)));  ///< result of comparisons: all bits of a lane are set
                                                                 ///< where it is true

/// Two doubles of a SIMD vector.
using DoubleLanes = double __attribute__((vector_size(16)));

// std::min and std::max per lane.
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

// True if any lane is set.
inline bool isAny(const LaneMask& mask)
{
    using Halves = std::int64_t __attribute__((vector_size(16)));
    const Halves halves = reinterpret_cast<Halves>(mask);
    return (halves[0] | halves[1]) != 0;
}

}  // namespace bullet_fem
