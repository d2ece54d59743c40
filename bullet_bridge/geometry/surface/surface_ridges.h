// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/surface_topology.h"
#include "bullet_bridge/geometry/surface/surface_tree.h"
#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{

/// The ridges (convex edges) of a surface by leaves of its tree, as input of EdgePairSearch. Built at set-up; update()
/// never allocates.
class SurfaceRidges
{
public:
    /// A convex edge.
    struct Ridge
    {
        int m_edge, m_a, m_b;  ///< edge and its vertices
    };
    static constexpr int kSteps = 2;  ///< steps that a ridge's box is swept over: impacts are searched that far ahead

    /// True if an edge is convex by more than 1.7 degrees; `bend` as in SoftSurface.
    static bool isRidge(double bend) { return bend < -kRidgeSine; }

    /// Assigns each edge to the leaf of the first of its triangles.
    SurfaceRidges(const SurfaceTopology& topology, const SurfaceTree& tree);

    /// Updates all ridges after the tree was refitted. `bend`: that of all edges, as in SoftSurface.
    void update(const SurfaceTree& tree, const std::vector<double>& bend);
    /// Updates the given nodes of the tree only; all others then have no ridges. `nodes` is ascending and has the
    /// ancestors of each node. `bend`: valid for the edges of triangles in their leaves.
    void update(const SurfaceTree& tree, const std::vector<double>& bend, const std::vector<int>& nodes);

    /// The ridges of a leaf.
    const Ridge* begin(const SurfaceTree::Leaf& leaf) const { return m_ridges.data() + m_firstEdge[leaf.m_first]; }
    const Ridge* end(const SurfaceTree::Leaf& leaf) const { return m_ridges.data() + m_end[leaf.m_first]; }

    /// Per node of the tree: not 0 if a leaf below it has a ridge.
    const unsigned char* has() const { return m_has.data(); }

    /// The bounding box of a ridge, swept over kSteps steps.
    static CoarseBox boxOf(const Ridge& ridge, const SurfaceTree& tree)
    {
        CoarseBox box = tree.vertexBox(ridge.m_a);
        box.add(tree.vertexBox(ridge.m_b));
        box.last(kSteps);
        return box;
    }

private:
    void updateNode(const SurfaceTree& tree, const std::vector<double>& bend, int node);

    std::vector<Ridge> m_edges;        // all edges, in the order of the tree's triangles
    std::vector<int> m_firstEdge;      // per place in the tree, its first edge; one more entry
    std::vector<int> m_end;            // per place of a leaf's first triangle, the end of the leaf's ridges in m_ridges
    std::vector<Ridge> m_ridges;       // those of a leaf start at its first edge's index
    std::vector<unsigned char> m_has;  // per node of the tree
};

}  // namespace bullet_fem
