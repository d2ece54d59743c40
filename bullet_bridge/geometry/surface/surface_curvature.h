// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/surface_topology.h"

namespace bullet_fem
{

/// Curvature of a surface at its vertices, from the change of vertex normals along edges. The change across creases
/// counts only where there is no other; otherwise the rim of a tyre would have a radius of one element.
struct SurfaceCurvature
{
    /// The surface with vertices at x [m].
    SurfaceCurvature(const SurfaceTopology& topology, const std::vector<Vec3>& x);

    std::vector<double> m_largest;  ///< largest normal curvature along the edges at a vertex [1/m]; 0: flat or concave
    std::vector<unsigned char> m_hasFewFacets;  ///< 1: round with few facets around the vertex; rolls from corner to
                                                ///< corner
};

}  // namespace bullet_fem
