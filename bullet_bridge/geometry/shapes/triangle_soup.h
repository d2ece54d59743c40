// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <vector>

#include "bullet_bridge/geometry/shapes/shape_distance.h"
#include "bullet_bridge/geometry/surface/triangle_proximity.h"

class btTriangleCallback;
class btVector3;

namespace bullet_fem
{

/// A triangle of a concave shape.
struct SoupTriangle
{
    Corners m_corners;  ///< world [m]
    Vec3 m_normal;      ///< unit, by the order of corners, which does not tell the outside
    int m_part = 0;     ///< Bullet's numbers of its part and of the triangle
    int m_index = 0;
};

/// Calls the visitor for the triangles of a sheet (see ShapeLeaf) that overlap a box, both in the sheet's frame. The
/// box must be finite. Never allocates.
void forEachTriangle(const btCollisionShape& sheet, const btVector3& low, const btVector3& high,
                     btTriangleCallback& visitor);

/// The first intersection of a segment with the soup.
struct SoupCrossing
{
    int m_triangle = -1;  ///< -1: none
    double m_along = 0;   ///< position on the segment [-], in [0, 1]
    Vec3 m_normal;        ///< unit normal of the triangle's plane, to the side of the segment's start
};

/// The triangles of a concave leaf near a soft body, in a uniform grid. Bullet's meshes need be neither closed nor
/// consistently oriented, so they are treated as soups of two-sided triangles. Slivers, whose normals are lost in
/// single precision, and triangles that are not finite are omitted. Scratch grows with the number of triangles, never
/// shrinks. Not thread-safe.
class TriangleSoup
{
public:
    /// Collects the leaf's triangles that overlap a world box [m]; none if the leaf is not concave.
    void collect(const ShapeLeaf& leaf, const Vec3& low, const Vec3& high);

    /// The triangles of the last collect(), in world coordinates.
    const std::vector<SoupTriangle>& triangles() const { return m_triangles; }

    /// Calls visit(index) once for each triangle whose bounds overlap a box. The order depends only on the triangles
    /// and the box. Calls may be nested.
    template <class Visit>
    void forEachIn(const Vec3& low, const Vec3& high, Visit visit) const;

    /// Calls visit(index) for the triangles that contain a point of the soup.
    template <class Visit>
    void forEachAround(const Vec3& q, Visit visit) const;

    /// The first triangle that the segment crosses, or that is closer than `clearance` [m] to its end.
    SoupCrossing firstCrossing(const Vec3& from, const Vec3& to, double clearance = 0) const;

    /// True if no other triangle at q comes closer to p. q is a point of the soup at `distance` [m] from p.
    bool isNearestAround(const Vec3& q, const Vec3& p, double distance) const;

    /// Distance below which points count as equal [m]: the precision of Bullet's coordinates.
    double tolerance() const { return m_tolerance; }

private:
    struct Cells
    {
        std::array<int, 3> m_low, m_high;  // inclusive
    };

    void buildGrid();
    void chooseCells();
    Cells cellsOf(const Vec3& low, const Vec3& high) const;
    int cellIndex(int i, int j, int k) const { return i + m_counts[0] * (j + m_counts[1] * k); }

    std::vector<SoupTriangle> m_triangles;
    std::vector<Cells> m_cells;                     // per triangle
    std::vector<std::array<Vec3, 2>> m_bounds;      // per triangle
    std::vector<int> m_cellStart, m_cellTriangles;  // the triangles of cell c are those from m_cellStart[c] to
                                                    // m_cellStart[c + 1]
    Vec3 m_low, m_high;                             // bounds of the triangles within the collected box
    std::array<int, 3> m_counts = {1, 1, 1};        // number of cells along the axes
    double m_cell = 1;                              // size of a cell [m]
    double m_tolerance = 0;
};

/// Nearest point of a triangle; m_onFace is true if the projection is inside, up to rounding.
struct SoupPoint
{
    Vec3 m_point;
    bool m_onFace = false;
};
SoupPoint nearestOn(const SoupTriangle& triangle, const Vec3& p);

template <class Visit>
void TriangleSoup::forEachIn(const Vec3& low, const Vec3& high, Visit visit) const
{
    if (m_triangles.empty()) return;
    for (int c = 0; c < 3; ++c)
        if (!(low[c] <= m_high[c] && high[c] >= m_low[c])) return;
    const Cells box = cellsOf(low, high);
    for (int k = box.m_low[2]; k <= box.m_high[2]; ++k)
        for (int j = box.m_low[1]; j <= box.m_high[1]; ++j)
            for (int i = box.m_low[0]; i <= box.m_high[0]; ++i)
                for (int n = m_cellStart[cellIndex(i, j, k)]; n < m_cellStart[cellIndex(i, j, k) + 1]; ++n)
                {
                    const int t = m_cellTriangles[n];
                    const Vec3 &tLow = m_bounds[t][0], &tHigh = m_bounds[t][1];
                    bool overlap = true;
                    for (int c = 0; c < 3; ++c) overlap = overlap && low[c] <= tHigh[c] && high[c] >= tLow[c];
                    if (!overlap) continue;
                    // Visits it only in the first cell that triangle and box share.
                    const Cells& own = m_cells[t];
                    if (i == std::max(own.m_low[0], box.m_low[0]) && j == std::max(own.m_low[1], box.m_low[1]) &&
                        k == std::max(own.m_low[2], box.m_low[2]))
                        visit(t);
                }
}

template <class Visit>
void TriangleSoup::forEachAround(const Vec3& q, Visit visit) const
{
    const Vec3 pad = {m_tolerance, m_tolerance, m_tolerance};
    forEachIn(q - pad, q + pad,
              [&](int t)
              {
                  if (norm(nearestOnTriangle(m_triangles[t].m_corners, q).m_point - q) <= m_tolerance) visit(t);
              });
}

}  // namespace bullet_fem
