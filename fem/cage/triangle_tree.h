// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "fem/cage/triangle_overlap.h"

namespace bullet_fem
{

/// The points m_from + s m_way with s in [m_first, m_last).
struct Ray
{
    Vec3 m_from, m_way;
    double m_first = 0, m_last = 1;
};

/// The first intersection of a ray with a triangle.
struct RayHit
{
    double m_along = -1;  ///< the ray's s; negative if there is no intersection
    Vec3 m_normal;        ///< normal of the triangle, not normalised
};

/// A bounding volume hierarchy over a triangle soup. Immutable; copies the corners.
class TriangleTree
{
public:
    /// Builds the tree in O(n log n). Requires at least one triangle, finite vertices and indices in range.
    TriangleTree(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

    /// The point of the triangles nearest to p.
    Vec3 nearest(const Vec3& p) const;

    /// The first triangle along a ray, facing either way. Intersections at an edge count.
    RayHit firstAlong(const Ray& ray) const;

    /// The number of crossings of a segment through triangles along their normals, minus those against them. A segment
    /// through an edge or a corner of a closed surface crosses one triangle there.
    int crossings(const Vec3& from, const Vec3& to) const;

    /// True if a triangle enters the tet deeper than `depth`; with a negative depth, if it comes within -depth of it.
    bool entersTet(const std::array<Vec3, 4>& tet, double depth) const;

private:
    struct Node
    {
        Vec3 m_low, m_high;
        int m_first = 0, m_last = 0;  // range in m_triangles
        int m_right = 0;              // the second child, the first follows its parent; 0: a leaf
        int m_skip = 0;               // index after this node's descendants
    };

    void build(int first, int last);
    void nearestIn(int node, const Vec3& p, Vec3& best, double& bestSquared) const;

    std::vector<TriangleCorners> m_triangles;  // in the order of the leaves
    std::vector<Node> m_nodes;                 // in depth-first order
};

}  // namespace bullet_fem
