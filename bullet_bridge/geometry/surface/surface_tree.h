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

/// A bounding volume tree over the triangles of a surface, built once from the rest shape by median splits along the
/// longest side, and refitted every step. Queries never allocate.
class SurfaceTree
{
public:
    SurfaceTree(const std::vector<Vec3>& restPositions, const std::vector<Triangle>& triangles);

    /// Refits to positions x [m] with displacements `change` [m], one per vertex.
    void refit(const std::vector<Vec3>& x, const std::vector<Vec3>& change);

    /// Bounds of all triangles; empty if there are none.
    const SweptBox& bounds() const { return m_bounds; }
    const CoarseBox& coarseBounds() const { return m_boxes.front(); }

    /// Calls visit(triangle) for all triangles that may come within `reach` [m] of `box`, in a fixed order.
    template <class Visit>
    void visitNear(const CoarseBox& box, double reach, Visit visit) const
    {
        const auto visitTriangles = [&](int at)
        {
            const Node& node = m_nodes[at];
            for (int k = 0; k < node.m_count; ++k) visit(m_order[node.m_next + k]);
        };
        visitNodes([&, most = coarse(reach)](int at) { return m_boxes[at].meets(box, most); }, visitTriangles);
    }

    /// Calls visit(node) for all nodes of the tree that may come within reach of one of the boxes, parents first, in
    /// ascending order.
    struct Nearby
    {
        CoarseBox m_box;
        double m_reach;  ///< [m]
    };
    template <class Visit>
    void visitNearNodes(const std::vector<Nearby>& boxes, Visit visit) const
    {
        const auto isNear = [&](int at)
        {
            return std::any_of(boxes.begin(), boxes.end(),
                               [&](const Nearby& nearby)
                               { return m_boxes[at].meets(nearby.m_box, coarse(nearby.m_reach)); });
        };
        visitNodes(isNear, visit);
    }

    /// A leaf's triangles: a range of arguments of triangleAt().
    struct Leaf
    {
        int m_first, m_end;
    };
    int triangleAt(int place) const { return m_order[place]; }

    int nodeCount() const { return static_cast<int>(m_nodes.size()); }  ///< number of the tree's nodes
    const CoarseBox& box(int node) const { return m_boxes[node]; }
    bool isLeaf(int node) const { return m_nodes[node].isLeaf(); }
    Leaf leaf(int node) const { return {m_nodes[node].m_next, m_nodes[node].m_next + m_nodes[node].m_count}; }
    /// The children of an inner node; their indices are larger than its own.
    std::array<int, 2> children(int node) const { return {node + 1, m_nodes[node].m_next}; }

    /// Calls visit(node) for all leaves that may come within `reach` [m] of `box` and have the wanted property. `has`:
    /// per node, not 0 if some leaf below it has that property.
    template <class Visit>
    void visitNearLeaves(const CoarseBox& box, double reach, const unsigned char* has, Visit visit) const
    {
        const auto visitLeaf = [&](int at)
        {
            if (m_nodes[at].isLeaf()) visit(at);
        };
        visitNodes([&, most = coarse(reach)](int at) { return has[at] && m_boxes[at].meets(box, most); }, visitLeaf);
    }

    /// The triangle nearest to p at the start without those for which skip(triangle) is true; -1 if none is closer than
    /// `most` [m], which may be infinite. `nearest` is its nearest point. `guess`, a triangle near p as initial guess
    /// (-1: none), affects the speed but not the result.
    template <class Skip>
    int nearestTriangle(const Vec3& p, double most, Skip skip, TrianglePoint& nearest, int guess = -1) const
    {
        // Smallest squared distance of a box from p from which on, despite rounding, no point in it is as close as
        // `least`.
        const auto surelyFarther = [&p](double least)
        {
            const double distance = std::sqrt(least), size = std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z);
            const double farther = distance + 1e-12 * (distance + size);
            return farther * farther;
        };
        double least = most * most;
        if (guess >= 0 && !skip(guess))
        {
            const Vec3 r = p - nearestOnTriangle(corners(guess), p).m_point;
            least = std::min(least, surelyFarther(dot(r, r)) + std::numeric_limits<double>::min());
        }
        double farther = surelyFarther(least);
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
                farther = surelyFarther(least);
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

    /// Positions at the last refit [m].
    const std::vector<Vec3>& positions() const { return m_x; }
    /// Corners of a triangle [m].
    Corners corners(int triangle) const { return cornersOf(m_triangles[triangle]); }
    /// The coarse box of one vertex.
    const CoarseBox& vertexBox(int vertex) const { return m_vertexBoxes[vertex]; }

    static constexpr int kLeafTriangles = 2;  ///< largest number of triangles in a leaf

private:
    static constexpr int kDepth = 64;  // of the stacks: twice the depth of a tree over 2^31 triangles
    struct Node
    {
        int m_next = 0;   // leaf: place of its first triangle; inner node: right child (the left one is the next node)
        int m_count = 0;  // number of a leaf's triangles
        bool isLeaf() const { return m_count > 0; }
    };

    struct Ahead  // a node that the search has yet to visit
    {
        int m_node;
        double m_squaredDistance;
    };

    // Visits nodes for which isNear(node) is true, those below others after them.
    template <class IsNear, class Visit>
    void visitNodes(IsNear isNear, Visit visit) const
    {
        int stack[kDepth], size = 0;
        stack[size++] = 0;
        while (size > 0)
        {
            const int at = stack[--size];
            if (!isNear(at)) continue;
            visit(at);
            if (m_nodes[at].isLeaf()) continue;
            stack[size++] = m_nodes[at].m_next;
            stack[size++] = at + 1;
        }
    }

    int build(int first, int count, std::vector<Vec3>& middles);
    Corners cornersOf(const Triangle& t) const { return {m_x[t[0]], m_x[t[1]], m_x[t[2]]}; }

    std::vector<Triangle> m_triangles;
    std::vector<int> m_order;              // triangles in the order of the tree
    std::vector<Triangle> m_placed;        // corners in that order
    std::vector<int> m_vertices;           // vertices of the triangles
    std::vector<Vec3> m_x;                 // positions of the vertices
    std::vector<CoarseBox> m_vertexBoxes;  // boxes of the vertices
    SweptBox m_bounds;
    // Per node, in separate arrays: queries are bound by memory access, and not all of them need all data.
    std::vector<Node> m_nodes;
    std::vector<CoarseBox> m_boxes;
    std::vector<BoxPair> m_parts;  // boxes of the two children, or of a leaf's triangles, at the start
};

}  // namespace bullet_fem
