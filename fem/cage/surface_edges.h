// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "bullet_fem/fem/cage/surface_mesh.h"

namespace bullet_fem
{

/// One side of a triangle between two distinct positions.
struct TriangleSide
{
    int m_low = 0, m_high = 0;  ///< welded vertices, m_low < m_high
    int m_triangle = 0;
    int m_way = 1;  ///< +1 if the triangle traverses it from m_low to m_high, else -1
};

/// For every vertex the lowest vertex at exactly its position: also closes files without shared vertices.
std::vector<int> weldCoincident(const std::vector<Vec3>& x);

/// All sides, sorted by edge, then by triangle.
std::vector<TriangleSide> sortedSides(const std::vector<Triangle>& triangles, const std::vector<int>& welded);

/// Calls visit(first, last) with the range of sides of every edge.
template <typename Visit>
void forEachEdge(const std::vector<TriangleSide>& sides, Visit visit)
{
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last)
    {
        while (last < sides.size() && sides[last].m_low == sides[first].m_low &&
               sides[last].m_high == sides[first].m_high)
            ++last;
        visit(first, last);
    }
}

}  // namespace bullet_fem
