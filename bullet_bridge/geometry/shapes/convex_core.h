// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

class btConvexShape;

namespace bullet_fem
{

/// A convex Bullet shape as a core with a rounding (offset surface) around it, both in double precision and in the
/// shape's own frame. A view: it must not outlive the shape. Never allocates. Cores:
///  - sphere: a point; capsule: a segment;
///  - multi-sphere: the spheres with radii smaller by the smallest radius;
///  - cone, convex hull, other shapes: Bullet's shape without margin;
///  - box, cylinder: Bullet's extents less a rounding of edgeRounding times the smallest half extent.
class ConvexCore
{
public:
    /// Rounding of box and cylinder edges over their smallest half extent [-]. GJK alone handles penetrations up to it.
    /// A larger value is faster, and moves the edges inward by up to sqrt(3) - 1 times the rounding.
    static constexpr double edgeRounding = 0.002;

    /// Makes the core of a shape, which must outlive it.
    explicit ConvexCore(const btConvexShape& shape);

    /// The core's support point: farthest in a direction, which must not be zero.
    Vec3 support(const Vec3& direction) const;
    /// Radius of the rounding [m].
    double rounding() const { return m_rounding; }
    /// Relative error of support() over the core's size [-]: double rounding, or Bullet's float for its own curved
    /// shapes.
    double precision() const { return m_precision; }
    /// True if the core has curved faces, which a polytope can only approximate.
    bool isCurved() const { return m_isCurved; }

private:
    Vec3 hullSupport(const Vec3& direction) const;
    Vec3 multiSphereSupport(const Vec3& direction) const;

    const btConvexShape& m_shape;
    int m_kind;             ///< Bullet's shape type
    int m_axis = 1;         ///< of capsule, cylinder and cone
    Vec3 m_halfExtents;     ///< of a box; of other shapes the half length along the axis, and the radius across it [m]
    double m_rounding = 0;  ///< [m]
    double m_precision = 1e-15;
    bool m_isCurved = false;
};

}  // namespace bullet_fem
