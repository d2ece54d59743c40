// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

class btConvexShape;

namespace bullet_fem
{

/// A convex Bullet shape as a core with a rounding around it, both in double precision and in the shape's own frame.
/// A view: it lives no longer than the shape, and allocates nothing.
///   sphere: a point; capsule: a segment; multi-sphere: the spheres less the smallest radius; cone, hull, others:
///   Bullet's shape without margin; box and cylinder: Bullet's extents less a rounding of edgeRounding times the
///   smallest of them.
class ConvexCore
{
public:
    /// Rounding of box and cylinder edges, relative to their smallest half extent [-]. What penetrates less than this
    /// is found by GJK alone; larger is faster, and blunts the edges by up to sqrt(3) - 1 times as much.
    static constexpr double edgeRounding = 0.002;

    explicit ConvexCore(const btConvexShape& shape);

    /// The core's farthest point in a direction (not zero).
    Vec3 support(const Vec3& direction) const;
    /// Radius of the rounding [m].
    double rounding() const { return m_rounding; }
    /// Error of support(), relative to the core's size [-]: double rounding, or Bullet's float for curved shapes of its
    /// own.
    double precision() const { return m_precision; }
    /// True if the core has curved faces, which no polytope can reach but only approach.
    bool isCurved() const { return m_isCurved; }

private:
    Vec3 hullSupport(const Vec3& direction) const;
    Vec3 multiSphereSupport(const Vec3& direction) const;

    const btConvexShape& m_shape;
    int m_kind;             ///< Bullet's shape type
    int m_axis = 1;         ///< of capsule, cylinder and cone
    Vec3 m_halfExtents;     ///< of the box; of the others along the axis, and the radius across it [m]
    double m_rounding = 0;  ///< [m]
    double m_precision = 1e-15;
    bool m_isCurved = false;
};

}  // namespace bullet_fem
