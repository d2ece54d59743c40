// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/surface_inspection.h"
#include "fem/cage/triangle_tree.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// A fragment of a triangle with an opposite side of the surface: across the solid, or across a gap.
struct ThinPart
{
    TriangleCorners m_corners;  ///< [m]
    Vec3 m_across;              ///< from the fragment to the opposite side, along the fragment's normal [m]
    bool m_isGap = false;
};

/// Inputs of the search. Tree, winding number and the resulting parts have one origin.
struct ThinSearch
{
    const TriangleTree& m_tree;
    const SurfaceWinding& m_winding;
    double m_reach = 0;         ///< maximum distance of the opposite side [m]
    double m_coarsest = 0;      ///< initial maximum edge of a fragment [m], for narrow features of large triangles
    double m_finest = 0;        ///< fragments with shorter edges are not divided [m]
    double m_edgePerWidth = 1;  ///< maximum edge of a fragment over the width measured there [-]
};

/// Finds the thin parts, in the order of the triangles. The opposite side is the first triangle along the normal
/// through the middle of a fragment, if its plane is within 60 degrees of the fragment's, so that corners and edges
/// above 60 degrees are not thin. The segment between must be in the solid and the points beyond both ends outside, or
/// vice versa for a gap. Among triangles smaller than m_finest, one is measured for each block of that size and each of
/// 26 directions, and the others reuse its result. Deterministic.
std::vector<ThinPart> findThinParts(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                    const ThinSearch& search);

}  // namespace bullet_fem
