// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/tet_mesh.h"

namespace bullet_fem
{

/// The edges of a surface, each once, where they are in its triangles, and the triangles around its nodes.
struct SurfaceFeatures
{
    explicit SurfaceFeatures(const TetMesh& mesh);

    std::vector<std::array<int, 2>> m_edges;          ///< nodes, lower one first
    std::vector<std::array<int, 3>> m_triangleEdges;  ///< per surface triangle, indices of its edges
    std::vector<int> m_firstAround;                   ///< per node: where its triangles start in m_around; one more
    std::vector<int> m_around;                        ///< surface triangles at the nodes, ascending
};

}  // namespace bullet_fem
