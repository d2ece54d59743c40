// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <vector>

#include "bullet_bridge/soft_pairs/triangle_proximity.h"
#include "bullet_fem/fem/tet_mesh.h"

namespace bullet_fem
{

/// Bounds of points and of how far they move within a step.
struct SweptBox
{
    Vec3 m_low, m_high;              ///< at the start [m]
    Vec3 m_changeLow, m_changeHigh;  ///< [m]

    /// A point that moves by `change`.
    static SweptBox of(const Vec3& point, const Vec3& change) { return {point, point, change, change}; }
    void add(const SweptBox& b);
    /// False only if no two points of this and the other come within `reach` [m], moving relative to each other in a
    /// straight line: what both have in common does not matter.
    bool meets(const SweptBox& b, double reach) const;
    double squaredDistance(const Vec3& p) const;  ///< from p to the bounds at the start [m2]
};

/// A tree of bounds over the triangles of a surface, built once from the rest shape (median splits along the longest
/// side) and refitted every step. Lookups never allocate.
class SurfaceTree
{
public:
    SurfaceTree(const std::vector<Vec3>& restPositions, const std::vector<Triangle>& triangles);

    /// For nodes at x [m] that move by `change` [m].
    void refit(const std::vector<Vec3>& x, const std::vector<Vec3>& change);

    /// All of it; empty if there are no triangles.
    const SweptBox& bounds() const { return m_nodes.front().m_box; }

    /// Calls visit(triangle) for all triangles that `box` may come within `reach` [m] of; always in the same order.
    template <class Visit>
    void visitNear(const SweptBox& box, double reach, Visit visit) const
    {
        int stack[kDepth], size = 0;
        stack[size++] = 0;
        while (size > 0)
        {
            const int at = stack[--size];
            const Node& node = m_nodes[at];
            if (!node.m_box.meets(box, reach)) continue;
            for (int k = 0; k < node.m_count; ++k) visit(m_order[node.m_first + k]);
            if (node.m_count > 0) continue;
            stack[size++] = node.m_right;
            stack[size++] = at + 1;
        }
    }

    /// The triangle that is nearest to p at the start and not `skip`ped; -1 if none is nearer than `most` [m], which
    /// may be infinite. `nearest` is its point.
    template <class Skip>
    int nearestTriangle(const Vec3& p, double most, Skip skip, TrianglePoint& nearest) const
    {
        double least = most * most;
        int found = -1;
        int stack[kDepth], size = 0;
        stack[size++] = 0;
        while (size > 0)
        {
            const int at = stack[--size];
            const Node& node = m_nodes[at];
            if (!(node.m_box.squaredDistance(p) < least)) continue;
            for (int k = 0; k < node.m_count; ++k)
            {
                const int t = m_order[node.m_first + k];
                if (skip(t)) continue;
                const TrianglePoint candidate = nearestOnTriangle(m_corners[t], p);
                const Vec3 r = p - candidate.m_point;
                if (!(dot(r, r) < least)) continue;
                least = dot(r, r);
                nearest = candidate;
                found = t;
            }
            if (node.m_count > 0) continue;
            const bool leftFirst =
                m_nodes[at + 1].m_box.squaredDistance(p) <= m_nodes[node.m_right].m_box.squaredDistance(p);
            stack[size++] = leftFirst ? node.m_right : at + 1;
            stack[size++] = leftFirst ? at + 1 : node.m_right;
        }
        return found;
    }

    /// Corners of a triangle at the start [m].
    const Corners& corners(int triangle) const { return m_corners[triangle]; }

private:
    static constexpr int kDepth = 64;  // of the stacks: twice the depth of a tree over 2^31 triangles
    struct Node
    {
        SweptBox m_box;
        int m_right = 0;  // inner node: its left child is the next node
        int m_first = 0, m_count = 0;
    };

    int build(int first, int count, std::vector<Vec3>& middles);

    std::vector<Triangle> m_triangles;
    std::vector<Corners> m_corners;
    std::vector<int> m_order;
    std::vector<Node> m_nodes;  // children after their parents
};

}  // namespace bullet_fem
