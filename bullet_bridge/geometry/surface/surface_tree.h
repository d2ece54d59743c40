// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "bullet_bridge/geometry/surface/box_pair.h"
#include "bullet_bridge/geometry/surface/coarse_box.h"
#include "bullet_bridge/geometry/surface/swept_box.h"
#include "bullet_bridge/geometry/surface/triangle_proximity.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

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
    const CoarseBox& coarseBounds() const { return m_boxes.front(); }

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
            if (!m_boxes[at].meets(box, most)) continue;
            for (int k = 0; k < node.m_count; ++k) visit(m_order[node.m_next + k]);
            if (node.isLeaf()) continue;
            stack[size++] = node.m_next;
            stack[size++] = at + 1;
        }
    }

    /// Calls visit(node) for all nodes of the tree that a box may come within its reach of, parents first, by ascending
    /// number.
    struct Nearby
    {
        CoarseBox m_box;
        double m_reach;  ///< [m]
    };
    template <class Visit>
    void visitNearNodes(const std::vector<Nearby>& boxes, Visit visit) const
    {
        int stack[kDepth], size = 0;
        stack[size++] = 0;
        while (size > 0)
        {
            const int at = stack[--size];
            const auto isNear = [&](const Nearby& nearby)
            { return m_boxes[at].meets(nearby.m_box, coarse(nearby.m_reach)); };
            if (std::none_of(boxes.begin(), boxes.end(), isNear)) continue;
            visit(at);
            if (m_nodes[at].isLeaf()) continue;
            stack[size++] = m_nodes[at].m_next;
            stack[size++] = at + 1;
        }
    }

    /// A few triangles that lie beside each other: range of triangleAt().
    struct Leaf
    {
        int m_first, m_end;
    };
    int triangleAt(int place) const { return m_order[place]; }

    int nodeCount() const { return static_cast<int>(m_nodes.size()); }  ///< of the tree
    const CoarseBox& box(int node) const { return m_boxes[node]; }
    bool isLeaf(int node) const { return m_nodes[node].isLeaf(); }
    Leaf leaf(int node) const { return {m_nodes[node].m_next, m_nodes[node].m_next + m_nodes[node].m_count}; }
    /// Of one that is no leaf; they come after it.
    std::array<int, 2> children(int node) const { return {node + 1, m_nodes[node].m_next}; }

    /// Calls visit(node) for all leaves that `box` may come within `reach` [m] of and that have what is looked for: per
    /// node, not 0 if a leaf below it has.
    template <class Visit>
    void visitNearLeaves(const CoarseBox& box, double reach, const unsigned char* has, Visit visit) const
    {
        const float most = coarse(reach);
        int stack[kDepth], size = 0;
        stack[size++] = 0;
        while (size > 0)
        {
            const int at = stack[--size];
            if (!has[at] || !m_boxes[at].meets(box, most)) continue;
            if (m_nodes[at].isLeaf())
            {
                visit(at);
                continue;
            }
            stack[size++] = m_nodes[at].m_next;
            stack[size++] = at + 1;
        }
    }

    /// The triangle that is nearest to p at the start and not `skip`ped; -1 if none is nearer than `most` [m], which
    /// may be infinite. `nearest` is its point. The same for any `guess`, a triangle that may be near; -1: none.
    template <class Skip>
    int nearestTriangle(const Vec3& p, double most, Skip skip, TrianglePoint& nearest, int guess = -1) const
    {
        double least = most * most;
        if (guess >= 0 && !skip(guess)) least = std::min(least, notNearer(p, guess));
        double farther = surelyFarther(p, least);
        int found = -1;
        Ahead stack[kDepth];
        int size = 0;
        stack[size++] = {0, m_bounds.m_start.squaredDistance(p)};
        while (size > 0)
        {
            const Ahead ahead = stack[--size];
            if (!(ahead.m_squaredDistance < least)) continue;
            const Node& node = m_nodes[ahead.m_node];
            const DoubleLanes parts = m_parts[ahead.m_node].squaredDistances(p);
            for (int k = 0; k < node.m_count; ++k)
            {
                if (parts[k] > farther || skip(m_order[node.m_next + k])) continue;
                const TrianglePoint candidate = nearestOnTriangle(cornersOf(m_placed[node.m_next + k]), p);
                const Vec3 r = p - candidate.m_point;
                if (!(dot(r, r) < least)) continue;
                least = dot(r, r);
                farther = surelyFarther(p, least);
                nearest = candidate;
                found = m_order[node.m_next + k];
            }
            if (node.isLeaf()) continue;
            const Ahead left = {ahead.m_node + 1, parts[0]}, right = {node.m_next, parts[1]};
            const bool leftFirst = left.m_squaredDistance <= right.m_squaredDistance;
            stack[size++] = leftFirst ? right : left;
            stack[size++] = leftFirst ? left : right;
        }
        return found;
    }

    /// Of the last refit.
    const std::vector<Vec3>& positions() const { return m_x; }
    /// Corners of a triangle [m].
    Corners corners(int triangle) const { return cornersOf(m_triangles[triangle]); }
    /// The coarse box of a vertex alone.
    const CoarseBox& vertexBox(int vertex) const { return m_vertexBoxes[vertex]; }

    static constexpr int kLeafTriangles = 2;  ///< at most

private:
    static constexpr int kDepth = 64;  // of the stacks: twice the depth of a tree over 2^31 triangles
    struct Node
    {
        int m_next = 0;   // leaf: place of its first triangle; others: right child, the left one is the next node
        int m_count = 0;  // of a leaf's triangles
        bool isLeaf() const { return m_count > 0; }
    };

    struct Ahead  // what a search has not visited yet
    {
        int m_node;
        double m_squaredDistance;
    };

    // A squared distance from p to a box at which rounding cannot make any point in it as near as `least`.
    static double surelyFarther(const Vec3& p, double least)
    {
        const double distance = std::sqrt(least), size = std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z);
        const double farther = distance + 1e-12 * (distance + size);
        return farther * farther;
    }

    // A squared distance from p that is more than that of a triangle, and than rounding can take for it.
    double notNearer(const Vec3& p, int triangle) const
    {
        const Vec3 r = p - nearestOnTriangle(corners(triangle), p).m_point;
        return surelyFarther(p, dot(r, r)) + std::numeric_limits<double>::min();
    }

    int build(int first, int count, std::vector<Vec3>& middles);
    void refitLeaf(int at);
    void refitInner(int at);
    Corners cornersOf(const Triangle& t) const { return {m_x[t[0]], m_x[t[1]], m_x[t[2]]}; }

    std::vector<Triangle> m_triangles;
    std::vector<int> m_order;              // triangles by their place in the tree
    std::vector<Triangle> m_placed;        // in this order
    std::vector<int> m_vertices;           // of the triangles
    std::vector<Vec3> m_x;                 // of the vertices
    std::vector<CoarseBox> m_vertexBoxes;  // likewise
    SweptBox m_bounds;
    // Of the nodes; searches wait for memory more than they calculate, and not all need all of it.
    std::vector<Node> m_nodes;
    std::vector<CoarseBox> m_boxes;
    std::vector<BoxPair> m_parts;  // of children, or of triangles, at the start
};

}  // namespace bullet_fem
