// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/tet_mesh.h"
#include "fem/cage/triangle_overlap.h"

namespace bullet_fem
{

/// A tree of boxes over a triangle soup. Immutable; copies the corners.
class TriangleTree
{
public:
    /// At least one triangle, finite, with indices in range. O(n log n).
    TriangleTree(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

    /// The point of the triangles that is nearest to p.
    Vec3 nearest(const Vec3& p) const;

    /// True if a triangle enters the tet deeper than `depth`.
    bool entersTet(const std::array<Vec3, 4>& tet, double depth) const;

private:
    struct Node
    {
        Vec3 m_low, m_high;
        int m_first = 0, m_last = 0;  // triangles
        int m_right = 0;              // the second child, the first follows its parent; 0: a leaf
        int m_skip = 0;               // the node after this one's descendants
    };

    void build(int first, int last);
    void nearestIn(int node, const Vec3& p, Vec3& best, double& bestSquared) const;

    std::vector<TriangleCorners> m_triangles;  // in the order of the leaves
    std::vector<Node> m_nodes;                 // depth first
};

}  // namespace bullet_fem
