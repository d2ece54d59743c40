// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/surface_inspection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/cage/surface_edges.h"
#include "fem/common/disjoint_sets.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kSheetThickness = 1e-6;  // thickness over length below which a surface is a sheet
constexpr double kMaxOneSided = 0.9;      // |vector area| / area of an open surface: 1 flat, 1/2 hemisphere, 0 closed
// Share of all edges; one flipped patch passes, random orientation does not.
constexpr double kMaxMisoriented = 0.1;
constexpr double kMinRelativeSize = 1e-7;  // size over distance from the origin, for accuracy

void checkSoup(const SurfaceMesh& surface)
{
    const std::size_t most = std::numeric_limits<int>::max() / 3, vertices = surface.m_vertices.size();
    if (surface.m_triangles.empty()) reject("the surface has 0 triangles; at least 4 are needed to enclose a volume");
    if (surface.m_triangles.size() > most || vertices > most)
        reject("the surface has ", vertices, " vertices and ", surface.m_triangles.size(), " triangles, more than ",
               most, "; decimate it");
    for (std::size_t i = 0; i < vertices; ++i)
        if (!isFinite(surface.m_vertices[i]))
            reject("surface vertex ", i, " is (", surface.m_vertices[i].x, ", ", surface.m_vertices[i].y, ", ",
                   surface.m_vertices[i].z, "), which is not finite; give finite coordinates [m]");
    for (std::size_t t = 0; t < surface.m_triangles.size(); ++t)
        for (const int i : surface.m_triangles[t])
            if (i < 0 || i >= static_cast<int>(vertices))
                reject("surface triangle ", t, " uses vertex ", i, ", outside [0, ", static_cast<int>(vertices) - 1,
                       "]; count vertices from 0 and give a position for each");
}

void measureBounds(const SurfaceMesh& surface, SurfaceInspection& result)
{
    result.m_used.assign(surface.m_vertices.size(), 0);
    result.m_low = result.m_high = surface.m_vertices[surface.m_triangles[0][0]];
    for (const Triangle& triangle : surface.m_triangles)
        for (const int i : triangle)
        {
            result.m_used[i] = 1;
            for (int a = 0; a < 3; ++a)
            {
                result.m_low[a] = std::min(result.m_low[a], surface.m_vertices[i][a]);
                result.m_high[a] = std::max(result.m_high[a], surface.m_vertices[i][a]);
            }
        }
    const double size = norm(result.m_high - result.m_low);
    double farthest = 0;
    for (int a = 0; a < 3; ++a) farthest = std::max({farthest, std::abs(result.m_low[a]), std::abs(result.m_high[a])});
    if (!(farthest < 1e50))
        reject("the surface reaches ", farthest, " m from the origin, outside [0, 1e50); scale it to metres");
    if (size > 0 && size < kMinRelativeSize * farthest)
        reject("the surface is ", size, " m long and ", farthest, " m from the origin, less than ", kMinRelativeSize,
               " of that distance; move it nearer to the origin");
}

/// The used vertex that maximizes `measure`.
template <typename Measure>
Vec3 extremeVertex(const SurfaceMesh& surface, const std::vector<char>& used, Measure measure)
{
    Vec3 best;
    double most = -1;
    for (std::size_t i = 0; i < used.size(); ++i)
    {
        const double value = used[i] ? measure(surface.m_vertices[i]) : -1;
        if (value > most) most = value, best = surface.m_vertices[i];
    }
    return best;
}

/// Maximum distance of a used vertex from the plane through three distant ones [m].
double thickness(const SurfaceMesh& surface, const std::vector<char>& used, const Vec3& low)
{
    const Vec3 a = extremeVertex(surface, used, [&](const Vec3& x) { return norm(x - low); });
    const Vec3 b = extremeVertex(surface, used, [&](const Vec3& x) { return norm(x - a); });
    const Vec3 c = extremeVertex(surface, used, [&](const Vec3& x) { return norm(cross(b - a, x - a)); });
    const Vec3 n = cross(b - a, c - a);
    if (norm(n) == 0) return 0;
    const auto distance = [&](const Vec3& x) { return std::abs(dot(n, x - a)) / norm(n); };
    return distance(extremeVertex(surface, used, distance));
}

/// Counts edges that are not traversed equally often both ways, and those of them with more than one triangle.
void countEdges(SurfaceInspection& result)
{
    const std::vector<TriangleSide> sides =
        sortedSides(result.m_repaired.m_surface.m_triangles, result.m_repaired.m_welded);
    int misoriented = 0;
    forEachEdge(sides,
                [&](std::size_t first, std::size_t last)
                {
                    int sum = 0;
                    for (std::size_t s = first; s < last; ++s) sum += sides[s].m_way;
                    ++result.m_edges;
                    result.m_openEdges += sum != 0;
                    misoriented += sum != 0 && last - first > 1;
                });
    if (misoriented > kMaxMisoriented * result.m_edges)
        reject("the surface is not oriented: at ", misoriented, " of ", result.m_edges,
               " edges the triangles turn against each other and cannot be mended, at most ", kMaxMisoriented,
               " of them may; order the vertices of all triangles counter-clockwise seen from outside");
}

void countPieces(const SurfaceMesh& surface, SurfaceInspection& result)
{
    const std::vector<int>& welded = result.m_repaired.m_welded;
    DisjointSets joined(welded.size());
    for (const Triangle& t : surface.m_triangles)
        for (int a = 1; a < 3; ++a) joined.join(welded[t[0]], welded[t[a]]);
    std::vector<char> counted(welded.size(), 0);
    for (const Triangle& t : surface.m_triangles)
    {
        char& isCounted = counted[joined.root(welded[t[0]])];
        result.m_pieces += !isCounted;
        isCounted = 1;
    }
}

}  // namespace

SurfaceInspection inspectSurface(const SurfaceMesh& surface)
{
    checkSoup(surface);
    SurfaceInspection result;
    measureBounds(surface, result);
    result.m_repaired = repairSurface(surface);

    Vec3 vectorArea;
    for (const Triangle& t : result.m_repaired.m_surface.m_triangles)
    {
        const Vec3 area = 0.5 * cross(surface.m_vertices[t[1]] - surface.m_vertices[t[0]],
                                      surface.m_vertices[t[2]] - surface.m_vertices[t[0]]);
        vectorArea += area;
        result.m_area += norm(area);
    }
    countEdges(result);
    countPieces(surface, result);

    const double size = norm(result.m_high - result.m_low), thick = thickness(surface, result.m_used, result.m_low);
    if (!(thick > kSheetThickness * size) || !(result.m_area > 0))
        reject("the surface has no inside: it is flat, ", thick, " m thick and ", size, " m long, at least ",
               kSheetThickness, " of the length is needed; give a closed surface");
    const double oneSided = norm(vectorArea) / result.m_area;
    if (result.m_openEdges > 0 && oneSided > kMaxOneSided)
        reject("the surface has no inside: it is wide open, with ", result.m_openEdges,
               " open edges and |vector area| / area = ", oneSided, ", outside [0, ", kMaxOneSided,
               "]; close its holes");
    return result;
}

}  // namespace bullet_fem
