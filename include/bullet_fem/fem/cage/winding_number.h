// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Generalised winding number of a triangle soup: the solid angle it covers over 4 pi, signed. Far groups of triangles
/// count by the first two moments of their vector area [Barill et al. 2018], near ones exactly. Immutable; the same
/// bits on every call. Copies what it needs of the surface.
class BULLETFEM_API WindingNumber
{
public:
    /// The surface must be finite with indices in range. O(n log n).
    WindingNumber(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

    /// Winding number at p [-], within 0.1 (measured up to 160,000 triangles: 0.07, mean square 0.015), so that it
    /// rounds to the integer for closed surfaces: 1 inside outward triangles.
    double at(const Vec3& p) const;

private:
    struct Corners
    {
        Vec3 m_a, m_b, m_c;
    };
    struct Node
    {
        Vec3 m_centre;                // of area
        Vec3 m_vectorArea;            // N = sum of a n
        Mat3 m_moment;                // C = sum of a n (c - centre)^T
        double m_farSquared = 0;      // distance squared beyond which the moments stand for the triangles
        int m_first = 0, m_last = 0;  // triangles
        int m_skip = 0;               // the node after this one's descendants
        bool m_leaf = false;
    };

    void build(int first, int last);
    Node summarise(int first, int last) const;

    std::vector<Corners> m_triangles;  // in the order of the leaves
    std::vector<Node> m_nodes;         // depth first
};

}  // namespace bullet_fem
