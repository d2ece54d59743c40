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
    Vec3 m_normal;      ///< unit, by the winding, which says nothing about the side
    int m_part = 0;     ///< Bullet's numbers of it
    int m_index = 0;
};

/// Hands the visitor the triangles of a sheet (see ShapeLeaf) that overlap a box, both in the sheet's frame. The box
/// must be finite. Never allocates.
void forEachTriangle(const btCollisionShape& sheet, const btVector3& low, const btVector3& high,
                     btTriangleCallback& visitor);

/// Where a straight path meets the soup first.
struct SoupCrossing
{
    int m_triangle = -1;  ///< -1: nowhere
    double m_along = 0;   ///< share of the path [-], in [0, 1]
    Vec3 m_normal;        ///< unit, of the plane that is crossed, to the side where the path begins
};

/// The triangles of a concave leaf near a soft body, in a grid. A mesh is taken for a soup of two-sided sheets:
/// Bullet's meshes need be neither closed nor wound alike. Slivers, whose normal is lost in single precision, and
/// triangles that are not finite are left out. Scratch that grows with the number of triangles and never shrinks; not
/// for several threads.
class TriangleSoup
{
public:
    /// Takes the leaf's triangles that overlap a world box; none if the leaf is not concave.
    void collect(const ShapeLeaf& leaf, const Vec3& low, const Vec3& high);

    const std::vector<SoupTriangle>& triangles() const { return m_triangles; }

    /// Calls visit(index) once for every triangle whose bounds overlap a box, in an order that depends on the triangles
    /// and the box alone. Visits may nest.
    template <class Visit>
    void forEachIn(const Vec3& low, const Vec3& high, Visit visit) const;

    /// Calls visit(index) for the triangles that a point of the soup lies on.
    template <class Visit>
    void forEachAround(const Vec3& q, Visit visit) const;

    /// The first triangle between two points, or that the path comes nearer to than `clearance` [m] at its end.
    SoupCrossing firstCrossing(const Vec3& from, const Vec3& to, double clearance = 0) const;

    /// True if no other triangle at q, a point of the soup at a distance from p, comes nearer to p.
    bool isNearestAround(const Vec3& q, const Vec3& p, double distance) const;

    /// Length below which points are taken for one [m]: the precision of Bullet's coordinates.
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
    std::vector<Cells> m_cells;                     // of the triangles
    std::vector<std::array<Vec3, 2>> m_bounds;      // of the triangles
    std::vector<int> m_cellStart, m_cellTriangles;  // the triangles of cell c: m_cellStart[c] ... m_cellStart[c + 1]
    Vec3 m_low, m_high;                             // of the triangles, within the box that was asked for
    std::array<int, 3> m_counts = {1, 1, 1};        // cells along the axes
    double m_cell = 1;                              // size of a cell [m]
    double m_tolerance = 0;
};

/// Nearest point of a triangle; projections that miss it by rounding count as within.
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
                    // Once: in the first cell that the triangle and the box share.
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
