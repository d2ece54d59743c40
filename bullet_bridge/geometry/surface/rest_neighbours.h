// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Pairs of surface nodes that are close at rest: they share a tetrahedron's edge, or are within two mean edges in the
/// rest shape and within three mean edges along the tetrahedra's edges. Such pairs are excluded from self contact.
class RestNeighbours
{
public:
    explicit RestNeighbours(const TetMesh& mesh) : RestNeighbours(mesh, mesh.surfaceNodes()) {}

    /// For the given nodes instead of those of the mesh's surface; indices in [0, n).
    RestNeighbours(const TetMesh& mesh, const std::vector<int>& nodes);

    /// True if two of these nodes are close at rest, or equal.
    bool areClose(int nodeA, int nodeB) const;

private:
    std::vector<int> m_first;  // per node, start of its list in m_close; one more entry
    std::vector<int> m_close;  // lists of nodes, each ascending
};

}  // namespace bullet_fem
