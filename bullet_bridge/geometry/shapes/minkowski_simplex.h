// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_bridge/geometry/shapes/convex_core.h"

namespace bullet_fem
{

/// A point of the Minkowski difference soft - core, and the soft vertex that it comes from.
struct MinkowskiPoint
{
    Vec3 m_w;             ///< [m]
    int m_softIndex = 0;  ///< in [0, 3)
};

/// The Minkowski difference of a soft node or triangle and a convex core. A view of both: it must not outlive them.
struct MinkowskiDifference
{
    const ConvexCore& m_core;
    const Vec3* m_soft;  ///< in the core's frame [m], m_softCount of them
    int m_softCount;     ///< 1, 2 or 3

    /// Support point: the farthest in a direction, which must not be zero.
    MinkowskiPoint support(const Vec3& direction) const;
};

/// A simplex of one to four points of the difference, with the barycentric weights of its point nearest to the origin.
struct MinkowskiSimplex
{
    std::array<MinkowskiPoint, 4> m_points;
    std::array<double, 4> m_weights = {1, 0, 0, 0};  ///< [-], >= 0, of sum 1
    int m_count = 0;

    /// Finds the point nearest to the origin, and removes the points of zero weight. If the simplex is a tetrahedron
    /// that contains the origin, sets `inside` and removes nothing.
    Vec3 reduceToNearest(bool& inside);

    /// Barycentric weights of the soft vertices in the nearest point [-]: >= 0, sum 1 up to rounding.
    std::array<double, 3> softBarycentric() const;
};

}  // namespace bullet_fem
