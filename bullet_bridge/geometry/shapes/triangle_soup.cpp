// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/triangle_soup.h"

#include <cmath>

#include "BulletCollision/CollisionShapes/btConcaveShape.h"
#include "BulletCollision/CollisionShapes/btTriangleCallback.h"
#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{

namespace
{

constexpr double kPrecision = 2e-7;   // of Bullet's coordinates, relative to their magnitude [-]
constexpr double kSliver = 1e-6;      // smallest ratio of twice the area and the longest edge squared [-]
constexpr double kOnFace = 1e-6;      // tolerance of barycentric coordinates inside a triangle [-]
constexpr double kSamePlace = 10;     // distance of crossings at one place, over the tolerance
constexpr double kNotNearer = 1e-12;  // relative rounding error of distances [-]
constexpr int kCellsPerTriangle = 4;

struct Box
{
    Vec3 m_low, m_high;
};

/// The bounding box of a world box in a leaf's frame, enlarged by the rounding of Bullet's single precision.
Box localBox(const Pose& pose, const Box& world)
{
    const Vec3 center = pose.toLocal(0.5 * (world.m_low + world.m_high)), half = 0.5 * (world.m_high - world.m_low);
    Vec3 reach;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) reach[i] += std::abs(pose.m_rotation(j, i)) * half[j];
    const double rounding = kPrecision * (norm(center) + norm(reach));
    reach += {rounding, rounding, rounding};
    return {center - reach, center + reach};
}

/// True if the shape reports triangles in the box only. A program's own shape may report all of its triangles.
bool looksAtBox(const btCollisionShape& sheet)
{
    const int type = sheet.getShapeType();
    return type != CUSTOM_CONCAVE_SHAPE_TYPE && type != FAST_CONCAVE_MESH_PROXYTYPE;
}

bool overlaps(const Box& box, const btVector3* corners)
{
    for (int c = 0; c < 3; ++c)
    {
        const double a = corners[0][c], b = corners[1][c], d = corners[2][c];
        if (std::min({a, b, d}) > box.m_high[c] || std::max({a, b, d}) < box.m_low[c]) return false;
    }
    return true;
}

/// Collects the triangles in the box.
class Collector : public btTriangleCallback
{
public:
    Collector(const ShapeLeaf& leaf, const Box& box, std::vector<SoupTriangle>& triangles)
        : m_pose(leaf.m_pose), m_box(box), m_looksAtBox(looksAtBox(*leaf.m_shape)), m_triangles(triangles)
    {
    }

    void processTriangle(btVector3* corners, int part, int index) override
    {
        if (!m_looksAtBox && !overlaps(m_box, corners)) return;
        SoupTriangle t;
        for (int a = 0; a < 3; ++a) t.m_corners[a] = m_pose.toWorld(vec3(corners[a]));
        const Vec3 e0 = t.m_corners[1] - t.m_corners[0], e1 = t.m_corners[2] - t.m_corners[1],
                   e2 = t.m_corners[0] - t.m_corners[2];
        const Vec3 area = cross(e0, e1);
        const double longest = std::max({dot(e0, e0), dot(e1, e1), dot(e2, e2)});
        if (!(norm(area) > kSliver * longest) || !isFinite(area) || !isFinite(t.m_corners[0])) return;
        t.m_normal = area * (1 / norm(area));
        t.m_part = part;
        t.m_index = index;
        m_triangles.push_back(t);
    }

private:
    const Pose& m_pose;
    const Box& m_box;
    const bool m_looksAtBox;
    std::vector<SoupTriangle>& m_triangles;
};

/// Replaces btGImpactMeshShapePart::processAllTriangles, which allocates: traverses the part's own box tree.
void processGImpactPart(const btGImpactMeshShapePart& part, const btAABB& box, btTriangleCallback& visitor)
{
    const btGImpactBoxSet& tree = *part.getBoxSet();
    part.lockChildShapes();
    for (int node = 0; node < tree.getNodeCount();)
    {
        btAABB bounds;
        tree.getNodeBound(node, bounds);
        const bool overlaps = bounds.has_collision(box), isLeaf = tree.isLeafNode(node);
        if (overlaps && isLeaf)
        {
            btPrimitiveTriangle triangle;
            part.getPrimitiveTriangle(tree.getNodeData(node), triangle);
            visitor.processTriangle(triangle.m_vertices, part.getPart(), tree.getNodeData(node));
        }
        node += overlaps || isLeaf ? 1 : tree.getEscapeNodeIndex(node);
    }
    part.unlockChildShapes();
}

}  // namespace

void forEachTriangle(const btCollisionShape& sheet, const btVector3& low, const btVector3& high,
                     btTriangleCallback& visitor)
{
    if (sheet.getShapeType() != GIMPACT_SHAPE_PROXYTYPE)
        return static_cast<const btConcaveShape&>(sheet).processAllTriangles(&visitor, low, high);
    btAABB box;
    box.m_min = low;
    box.m_max = high;
    processGImpactPart(static_cast<const btGImpactMeshShapePart&>(sheet), box, visitor);
}

void TriangleSoup::collect(const ShapeLeaf& leaf, const Vec3& low, const Vec3& high)
{
    m_triangles.clear();
    if (!isSheet(*leaf.m_shape) || !isFinite(low) || !isFinite(high)) return;
    const Box local = localBox(leaf.m_pose, {low, high});
    const btVector3 localLow = bulletVector(local.m_low), localHigh = bulletVector(local.m_high);
    Collector collector(leaf, local, m_triangles);
    forEachTriangle(*leaf.m_shape, localLow, localHigh, collector);
    m_low = low;
    m_high = high;
    buildGrid();
}

// Sorts the triangles into grid cells by a counting sort.
void TriangleSoup::buildGrid()
{
    m_bounds.clear();
    double largest = 0;
    Vec3 soupLow = m_high, soupHigh = m_low;
    for (const SoupTriangle& t : m_triangles)
    {
        Vec3 low = t.m_corners[0], high = low;
        for (const Vec3& corner : t.m_corners)
            for (int c = 0; c < 3; ++c)
            {
                low[c] = std::min(low[c], corner[c]);
                high[c] = std::max(high[c], corner[c]);
                largest = std::max(largest, std::abs(corner[c]));
            }
        for (int c = 0; c < 3; ++c)
        {
            soupLow[c] = std::min(soupLow[c], std::max(low[c], m_low[c]));
            soupHigh[c] = std::max(soupHigh[c], std::min(high[c], m_high[c]));
        }
        m_bounds.push_back({low, high});
    }
    m_tolerance = kPrecision * largest;
    m_low = soupLow - Vec3{m_tolerance, m_tolerance, m_tolerance};
    m_high = soupHigh + Vec3{m_tolerance, m_tolerance, m_tolerance};
    // otherwise the bounds of a flat triangle have no width and may miss its corners
    for (std::array<Vec3, 2>& b : m_bounds)
    {
        b[0] -= {m_tolerance, m_tolerance, m_tolerance};
        b[1] += {m_tolerance, m_tolerance, m_tolerance};
    }
    if (m_triangles.empty()) return;

    chooseCells();
    m_cells.clear();
    for (const auto& bounds : m_bounds) m_cells.push_back(cellsOf(bounds[0], bounds[1]));
    m_cellStart.assign(m_counts[0] * m_counts[1] * m_counts[2] + 1, 0);
    const auto forCells = [this](const Cells& cells, auto visit)
    {
        for (int k = cells.m_low[2]; k <= cells.m_high[2]; ++k)
            for (int j = cells.m_low[1]; j <= cells.m_high[1]; ++j)
                for (int i = cells.m_low[0]; i <= cells.m_high[0]; ++i) visit(cellIndex(i, j, k));
    };
    for (const Cells& cells : m_cells) forCells(cells, [this](int cell) { ++m_cellStart[cell]; });
    for (std::size_t c = 1; c < m_cellStart.size(); ++c) m_cellStart[c] += m_cellStart[c - 1];
    m_cellTriangles.resize(m_cellStart.back());
    for (int t = static_cast<int>(m_bounds.size()) - 1; t >= 0; --t)
        forCells(m_cells[t], [this, t](int cell) { m_cellTriangles[--m_cellStart[cell]] = t; });
}

// Chooses cells of the size of an average triangle, at most about four per triangle.
void TriangleSoup::chooseCells()
{
    double sum = 0;
    for (const auto& bounds : m_bounds)
    {
        double extent = 0;
        for (int c = 0; c < 3; ++c)
            extent = std::max(extent, std::min(bounds[1][c], m_high[c]) - std::max(bounds[0][c], m_low[c]));
        sum += extent;
    }
    const double most = kCellsPerTriangle * static_cast<double>(m_triangles.size()) + 64;
    m_cell = std::max(sum / static_cast<double>(m_triangles.size()), m_tolerance);
    const auto count = [this](int c) { return std::max(1.0, std::ceil((m_high[c] - m_low[c]) / m_cell)); };
    if (!(m_cell > 0)) m_cell = 1;
    while (count(0) * count(1) * count(2) > most) m_cell *= 1.25;
    for (int c = 0; c < 3; ++c) m_counts[c] = static_cast<int>(count(c));
}

TriangleSoup::Cells TriangleSoup::cellsOf(const Vec3& low, const Vec3& high) const
{
    Cells cells;
    for (int c = 0; c < 3; ++c)
    {
        const double last = m_counts[c] - 1;
        cells.m_low[c] = static_cast<int>(std::min(last, std::max(0.0, std::floor((low[c] - m_low[c]) / m_cell))));
        cells.m_high[c] = static_cast<int>(std::min(last, std::max(0.0, std::floor((high[c] - m_low[c]) / m_cell))));
    }
    return cells;
}

SoupCrossing TriangleSoup::firstCrossing(const Vec3& from, const Vec3& to, double clearance) const
{
    SoupCrossing first;
    first.m_along = 2;
    double steepest = 0;
    const double sameShare = kSamePlace * m_tolerance / std::max(norm(to - from), m_tolerance);
    Vec3 low, high;
    for (int c = 0; c < 3; ++c)
    {
        low[c] = std::min(from[c], to[c]) - clearance;
        high[c] = std::max(from[c], to[c]) + clearance;
    }
    forEachIn(low, high,
              [&](int t)
              {
                  const SoupTriangle& triangle = m_triangles[t];
                  const double height = dot(triangle.m_normal, from - triangle.m_corners[0]);
                  const Vec3 normal = height > 0 ? triangle.m_normal : -triangle.m_normal;
                  const double a = std::abs(height), b = dot(normal, to - triangle.m_corners[0]);
                  if (a == 0 || !(b < clearance || b == 0)) return;
                  const double along = b > 0 ? 1 : a / (a - b), steep = a - b;
                  if (along > first.m_along + sameShare) return;
                  const bool isLess = steep < steepest || (steep == steepest && t > first.m_triangle);
                  if (along >= first.m_along - sameShare && isLess) return;
                  std::array<double, 3> w;
                  if (!projectOnPlane(triangle.m_corners, from + along * (to - from), w)) return;
                  if (std::min({w[0], w[1], w[2]}) < -kOnFace) return;
                  first = {t, along, normal};
                  steepest = steep;
              });
    return first;
}

bool TriangleSoup::isNearestAround(const Vec3& q, const Vec3& p, double distance) const
{
    bool nearest = true;
    forEachAround(q,
                  [&](int t)
                  {
                      if (!nearest) return;
                      const double other = norm(nearestOnTriangle(m_triangles[t].m_corners, p).m_point - p);
                      nearest = other >= distance - kNotNearer * (distance + m_tolerance);
                  });
    return nearest;
}

SoupPoint nearestOn(const SoupTriangle& triangle, const Vec3& p)
{
    std::array<double, 3> w;
    if (projectOnPlane(triangle.m_corners, p, w) && std::min({w[0], w[1], w[2]}) >= -kOnFace)
        return {p - dot(triangle.m_normal, p - triangle.m_corners[0]) * triangle.m_normal, true};
    return {nearestOnTriangle(triangle.m_corners, p).m_point, false};
}

}  // namespace bullet_fem
