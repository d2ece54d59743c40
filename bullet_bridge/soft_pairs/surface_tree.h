// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_bridge/soft_pairs/coarse_box.h"
#include "bullet_bridge/soft_pairs/swept_box.h"
#include "bullet_bridge/soft_pairs/triangle_proximity.h"
#include "bullet_fem/fem/tet_mesh.h"

namespace bullet_fem
{

/// A tree of bounds over the triangles of a surface, built once from the rest shape (median splits along the longest
/// side) and refitted every step. Lookups never allocate.
class SurfaceTree
{
public:
    SurfaceTree(const std::vector<Vec3>& restPositions, const std::vector<Triangle>& triangles);

    /// For nodes at x [m] that move by `change` [m].
    void refit(const std::vector<Vec3>& x, const std::vector<Vec3>& change);

    /// All of it; empty if there are no triangles.
    const SweptBox& bounds() const { return m_bounds; }
    const CoarseBox& coarseBounds() const { return m_nodes.front().m_box; }

    /// Calls visit(triangle) for all triangles that `box` may come within `reach` [m] of; always in the same order.
    template <class Visit>
    void visitNear(const CoarseBox& box, double reach, Visit visit) const
    {
        const float most = coarse(reach);
        int stack[kDepth], size = 0;
        stack[size++] = 0;
        while (size > 0)
        {
            const int at = stack[--size];
            const Node& node = m_nodes[at];
            if (!node.m_box.meets(box, most)) continue;
            for (int k = 0; k < node.m_count; ++k) visit(m_order[node.m_first + k]);
            if (node.m_count > 0) continue;
            stack[size++] = node.m_right;
            stack[size++] = at + 1;
        }
    }

    /// A few triangles that lie beside each other: range of triangleAt().
    struct Leaf
    {
        int m_first, m_end;
        int m_node;  ///< of the tree
    };
    int triangleAt(int place) const { return m_order[place]; }

    /// Of the tree; children come after their parent.
    int nodeCount() const { return static_cast<int>(m_nodes.size()); }
    bool isLeaf(int node) const { return m_nodes[node].isLeaf(); }
    std::array<int, 2> children(int node) const { return {node + 1, m_nodes[node].m_right}; }
    Leaf leaf(int node) const { return {m_nodes[node].m_first, m_nodes[node].m_first + m_nodes[node].m_count, node}; }
    const CoarseBox& box(int node) const { return m_nodes[node].m_box; }

    /// Calls visit(a, b) for all leaves a of this and b of the other tree that may come within `reach` [m] of each
    /// other. The other may be the same: each pair both ways, and every leaf with itself.
    template <class Visit>
    void visitNearLeaves(const SurfaceTree& other, double reach, Visit visit) const
    {
        const float most = coarse(reach);
        visitLeafPairs(
            other, [&](int a, int b) { return box(a).meets(other.box(b), most); }, visit);
    }

    /// Likewise, of the leaves for which mayMeet(node, other node) is true, and is for all nodes above them.
    template <class MayMeet, class Visit>
    void visitLeafPairs(const SurfaceTree& other, MayMeet mayMeet, Visit visit) const
    {
        int stack[2 * kDepth][2], size = 0;
        const auto push = [&](int a, int b)
        {
            stack[size][0] = a;
            stack[size++][1] = b;
        };
        push(0, 0);
        while (size > 0)
        {
            const auto [at, otherAt] = stack[--size];
            const Node &a = m_nodes[at], &b = other.m_nodes[otherAt];
            if (!mayMeet(at, otherAt)) continue;
            if (a.isLeaf() && b.isLeaf())
            {
                visit(leaf(at), other.leaf(otherAt));
            }
            else if (b.isLeaf() || (!a.isLeaf() && a.m_box.extent() > b.m_box.extent()))
            {
                push(a.m_right, otherAt);
                push(at + 1, otherAt);
            }
            else
            {
                push(at, b.m_right);
                push(at, otherAt + 1);
            }
        }
    }

    /// The triangle that is nearest to p at the start and not `skip`ped; -1 if none is nearer than `most` [m], which
    /// may be infinite. `nearest` is its point.
    template <class Skip>
    int nearestTriangle(const Vec3& p, double most, Skip skip, TrianglePoint& nearest) const
    {
        double least = most * most;
        int found = -1;
        Ahead stack[kDepth];
        int size = 0;
        stack[size++] = {0, m_starts[0].squaredDistance(p)};
        while (size > 0)
        {
            const Ahead ahead = stack[--size];
            if (!(ahead.m_squaredDistance < least)) continue;
            const Node& node = m_nodes[ahead.m_node];
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
            const Ahead left = {ahead.m_node + 1, m_starts[ahead.m_node + 1].squaredDistance(p)};
            const Ahead right = {node.m_right, m_starts[node.m_right].squaredDistance(p)};
            const bool leftFirst = left.m_squaredDistance <= right.m_squaredDistance;
            stack[size++] = leftFirst ? right : left;
            stack[size++] = leftFirst ? left : right;
        }
        return found;
    }

    /// The coarse box of a vertex alone.
    const CoarseBox& vertexBox(int vertex) const { return m_vertexBoxes[vertex]; }

    /// Corners of a triangle at the start [m].
    const Corners& corners(int triangle) const { return m_corners[triangle]; }

private:
    static constexpr int kDepth = 64;  // of the stacks: twice the depth of a tree over 2^31 triangles
    struct Node
    {
        CoarseBox m_box;
        int m_right = 0;  // inner node: its left child is the next node
        int m_first = 0, m_count = 0;
        bool isLeaf() const { return m_count > 0; }
    };

    struct Ahead  // what a search has not visited yet
    {
        int m_node;
        double m_squaredDistance;
    };

    int build(int first, int count, std::vector<Vec3>& middles);

    std::vector<Triangle> m_triangles;
    std::vector<Corners> m_corners;
    std::vector<int> m_order;
    std::vector<int> m_vertices;           // of the triangles
    std::vector<CoarseBox> m_vertexBoxes;  // of these
    SweptBox m_bounds;
    std::vector<Node> m_nodes;           // children after their parents
    std::vector<VectorBounds> m_starts;  // one a node
};

}  // namespace bullet_fem
