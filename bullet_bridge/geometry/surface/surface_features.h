// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// The edges of a surface, each once, where they are in its triangles, and the triangles around its vertices.
struct SurfaceFeatures
{
    /// Of triangles with vertices in [0, vertexCount).
    SurfaceFeatures(const std::vector<Triangle>& triangles, int vertexCount);

    std::vector<std::array<int, 2>> m_edges;          ///< vertices, lower one first
    std::vector<std::array<int, 3>> m_triangleEdges;  ///< per surface triangle, indices of its edges
    std::vector<int> m_firstAround;                   ///< per vertex: where its triangles start in m_around; one more
    std::vector<int> m_around;                        ///< surface triangles at the vertices, ascending
};

}  // namespace bullet_fem
