// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// The unique edges of a surface, the edges of its triangles, and the triangles around its vertices.
struct SurfaceFeatures
{
    /// Vertices of the triangles are in [0, vertexCount).
    SurfaceFeatures(const std::vector<Triangle>& triangles, int vertexCount);

    std::vector<std::array<int, 2>> m_edges;          ///< vertex indices, the smaller one first
    std::vector<std::array<int, 3>> m_triangleEdges;  ///< per triangle, indices of its edges; edge k is from corner k
                                                      ///< to corner (k + 1) % 3
    std::vector<int> m_firstAround;  ///< per vertex, start of its triangles in m_around; one more entry
    std::vector<int> m_around;       ///< triangles at each vertex, ascending
};

}  // namespace bullet_fem
