// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

using TriangleCorners = std::array<Vec3, 3>;

/// True if the triangle comes within `slack` of the solid; with a negative slack, if it enters it deeper than -slack.
/// Separating axis test, exact to rounding; degenerate triangles count as segments or points.
bool triangleMeetsBox(const TriangleCorners& triangle, const Vec3& low, const Vec3& high, double slack);
bool triangleMeetsTet(const TriangleCorners& triangle, const std::array<Vec3, 4>& tet, double slack);

/// Half spaces and bounding box of a tet, for a conservative intersection test.
class TetRegion
{
public:
    /// Prepares a tet of either orientation, enlarged by `slack` on every side.
    explicit TetRegion(const std::array<Vec3, 4>& tet, double slack = 0);

    /// Returns false only for boxes that do not intersect the tet.
    bool mayMeet(const Vec3& low, const Vec3& high) const;

private:
    Vec3 m_low, m_high;
    std::array<Vec3, 4> m_normals;
    std::array<double, 4> m_offsets = {};
};

}  // namespace bullet_fem
