// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>
#include <vector>

#include "bullet_fem/fem/cage/winding_number.h"
#include "fem/cage/triangle_tree.h"

namespace bullet_fem
{

/// What tells the winding numbers of a surface: always its moments, and the triangles of a closed one.
struct SurfaceWinding
{
    SurfaceWinding(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, bool closed);

    WindingNumber m_number;
    std::optional<TriangleTree> m_closed;  ///< none of a surface with an open edge
};

/// Winding numbers at many points that lie near each other. Of a closed surface they are whole numbers, which change
/// where a line passes the surface: so one is found by WindingNumber, and others around it by counting what lies
/// between, which costs as much as the triangles there, and not as all those that are long enough to be near. Of an
/// open surface each is found by itself.
class WindingNear
{
public:
    /// Triangles are counted from a point to another one of at most `reach` [m] away.
    WindingNear(const SurfaceWinding& winding, double reach) : m_winding(winding), m_reach(reach) {}

    /// Winding number at p [-].
    double at(const Vec3& p);

private:
    const SurfaceWinding& m_winding;
    double m_reach;
    bool m_knows = false;  // of a point
    Vec3 m_point;
    double m_atPoint = 0;
};

}  // namespace bullet_fem
