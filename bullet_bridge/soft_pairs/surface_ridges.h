// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/soft_pairs/surface_features.h"
#include "bullet_bridge/soft_pairs/surface_tree.h"

namespace bullet_fem
{

/// The ridges of a surface, by leaves of its tree: what EdgePairSearch looks for. Built at set-up; update() never
/// allocates.
class SurfaceRidges
{
public:
    struct Ridge
    {
        CoarseBox m_box;  ///< swept over kSteps steps
        int m_edge;
        int m_a, m_b;  ///< its ends
    };
    static constexpr int kSteps = 2;  ///< a ridge's box holds for longer than a step: impacts may be that late

    /// Every edge belongs to that leaf that has the first of its triangles.
    SurfaceRidges(const SurfaceFeatures& features, const SurfaceTree& tree);

    /// For the tree as it was refitted; `bend` of all edges as in SoftSurface.
    void update(const SurfaceTree& tree, const std::vector<double>& bend);

    /// Those of a leaf.
    const Ridge* begin(const SurfaceTree::Leaf& leaf) const { return m_ridges.data() + m_first[leaf.m_first]; }
    const Ridge* end(const SurfaceTree::Leaf& leaf) const { return m_ridges.data() + m_first[leaf.m_end]; }

    /// Around the ridges in all leaves below a node of the tree; empty if there are none.
    const CoarseBox& box(int node) const { return m_boxes[node]; }

private:
    struct Edge
    {
        int m_edge, m_a, m_b;  // ends
    };

    void findBoxes(const SurfaceTree& tree);

    std::vector<Edge> m_edges;     // as their triangles lie in the tree
    std::vector<int> m_firstEdge;  // per place in the tree; one more
    std::vector<int> m_first;      // likewise, of the ridges
    std::vector<Ridge> m_ridges;
    std::vector<CoarseBox> m_boxes;  // per node of the tree
};

}  // namespace bullet_fem
