// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/surface_inspection.h"
#include "fem/cage/triangle_tree.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// A piece of a triangle where another side of the surface faces it: across the solid, or across a gap.
struct ThinPart
{
    TriangleCorners m_corners;  ///< [m]
    Vec3 m_across;              ///< from the piece to the other side, along the piece's normal [m]
    bool m_isGap = false;
};

/// What thin parts are looked for with. Tree, winding number and the parts found have the same origin.
struct ThinSearch
{
    const TriangleTree& m_tree;
    const SurfaceWinding& m_winding;
    double m_reach = 0;         ///< farthest the other side may be [m]
    double m_coarsest = 0;      ///< longest edge of a piece at first [m]; narrow features of large triangles need it
    double m_finest = 0;        ///< pieces with shorter edges are not cut further [m]
    double m_edgePerWidth = 1;  ///< longest edge of a piece over the width measured there [-]
};

/// The parts in the order of the triangles. The other side is where the normal through the middle of a piece first
/// meets a triangle that is turned against it by more than 120 degrees, so that corners and edges above 60 degrees are
/// not thin; what lies between must be in the solid, and what lies beyond either end not, or the other way round for a
/// gap. Of triangles that are smaller than m_finest one is measured for each block of that size and each of 26
/// directions, and the others take its word. The same parts on every call.
std::vector<ThinPart> findThinParts(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                    const ThinSearch& search);

}  // namespace bullet_fem
