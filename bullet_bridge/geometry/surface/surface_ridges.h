// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/surface_features.h"
#include "bullet_bridge/geometry/surface/surface_tree.h"

namespace bullet_fem
{

/// The ridges of a surface, by leaves of its tree: what EdgePairSearch looks for. Built at set-up; update() never
/// allocates.
class SurfaceRidges
{
public:
    struct Ridge
    {
        int m_edge, m_a, m_b;  ///< and its ends
    };
    static constexpr int kSteps = 2;  ///< a ridge's box holds for longer than a step: impacts may be that late

    /// True of an edge that is bent outward by more than 1.7 degrees; `bend` as in SoftSurface.
    static bool isRidge(double bend) { return bend < kRidge; }

    /// Every edge belongs to that leaf that has the first of its triangles.
    SurfaceRidges(const SurfaceFeatures& features, const SurfaceTree& tree);

    /// For the tree as it was refitted; `bend` of all edges as in SoftSurface.
    void update(const SurfaceTree& tree, const std::vector<double>& bend);
    /// The same for these nodes of the tree alone, ascending and with all above each; no other has a ridge then. `bend`
    /// of the edges of triangles in their leaves.
    void update(const SurfaceTree& tree, const std::vector<double>& bend, const std::vector<int>& nodes);

    /// Those of a leaf.
    const Ridge* begin(const SurfaceTree::Leaf& leaf) const { return m_ridges.data() + m_firstEdge[leaf.m_first]; }
    const Ridge* end(const SurfaceTree::Leaf& leaf) const { return m_ridges.data() + m_end[leaf.m_first]; }

    /// Not 0 for nodes of the tree that have any in a leaf below.
    const unsigned char* has() const { return m_has.data(); }

    /// Swept over kSteps steps.
    static CoarseBox boxOf(const Ridge& ridge, const SurfaceTree& tree)
    {
        CoarseBox box = tree.vertexBox(ridge.m_a);
        box.add(tree.vertexBox(ridge.m_b));
        box.last(kSteps);
        return box;
    }

private:
    static constexpr double kRidge = -0.03;  // sine of the angle from which an edge is a ridge

    void updateNode(const SurfaceTree& tree, const std::vector<double>& bend, int node);

    std::vector<Ridge> m_edges;        // as their triangles lie in the tree
    std::vector<int> m_firstEdge;      // per place in the tree; one more
    std::vector<int> m_end;            // likewise, of the ridges of the leaf that begins there
    std::vector<Ridge> m_ridges;       // of a leaf from its first edge's place on
    std::vector<unsigned char> m_has;  // per node of the tree
};

}  // namespace bullet_fem
