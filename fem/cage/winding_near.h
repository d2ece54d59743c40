// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>
#include <vector>

#include "bullet_fem/fem/cage/winding_number.h"
#include "fem/cage/triangle_tree.h"

namespace bullet_fem
{

/// Data for the winding numbers of a surface: its moments, and for a closed surface its triangles.
struct SurfaceWinding
{
    SurfaceWinding(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, bool closed);

    WindingNumber m_number;
    std::optional<TriangleTree> m_closed;  ///< empty for a surface with an open edge
};

/// Winding numbers at many points near each other. For a closed surface they are integers that change where a segment
/// crosses the surface: one is computed by WindingNumber, and those nearby by counting crossings, at the cost of the
/// local triangles only. For an open surface each is computed independently.
class WindingNear
{
public:
    /// Crossings are counted between points at most `reach` [m] apart.
    WindingNear(const SurfaceWinding& winding, double reach) : m_winding(winding), m_reach(reach) {}

    /// Winding number at p [-].
    double at(const Vec3& p);

private:
    const SurfaceWinding& m_winding;
    double m_reach;
    bool m_knows = false;  // true if m_point is set
    Vec3 m_point;
    double m_atPoint = 0;
};

}  // namespace bullet_fem
