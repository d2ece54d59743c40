// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Which features of a body's surface are close to each other already at rest: they share a tetrahedron's edge, or are
/// within two mean edges of each other in the rest shape and connected through at most three of the material. They
/// cannot touch each other, however the body is bent.
class RestNeighbours
{
public:
    explicit RestNeighbours(const TetMesh& mesh) : RestNeighbours(mesh, mesh.surfaceNodes()) {}

    /// For other nodes than those of the mesh's surface, each in [0, n).
    RestNeighbours(const TetMesh& mesh, const std::vector<int>& nodes);

    /// For these nodes; true for a node and itself.
    bool areClose(int nodeA, int nodeB) const;

private:
    std::vector<int> m_first;  // per node: where its list starts; one entry more
    std::vector<int> m_close;  // lists of nodes, ascending
};

}  // namespace bullet_fem
