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

/// Where a ray first meets a triangle.
struct RayHit
{
    double m_along = -1;  ///< the ray's s; negative if it meets none
    Vec3 m_normal;        ///< of the triangle, not of unit length
};

/// A tree of boxes over a triangle soup. Immutable; copies the corners.
class TriangleTree
{
public:
    /// At least one triangle, finite, with indices in range. O(n log n).
    TriangleTree(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

    /// The point of the triangles that is nearest to p.
    Vec3 nearest(const Vec3& p) const;

    /// The first triangle along a ray, of either side. One that meets it at an edge counts.
    RayHit firstAlong(const Ray& ray) const;

    /// How often a straight line from one point to another passes triangles along their normals, less how often it
    /// passes them against these. A line through an edge or a corner of a closed surface passes one triangle there.
    int crossings(const Vec3& from, const Vec3& to) const;

    /// True if a triangle enters the tet deeper than `depth`; with a negative one, if it comes within -depth of it.
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
