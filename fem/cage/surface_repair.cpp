// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/surface_repair.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "fem/cage/surface_edges.h"

namespace bullet_fem
{
namespace
{

// Maximum share of a patch's triangles to reverse; the others are trusted to face outward.
constexpr double kMaxTurnedShare = 0.25;

bool hasArea(const SurfaceMesh& surface, const Triangle& t)
{
    const std::vector<Vec3>& x = surface.m_vertices;
    return norm(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]])) > 0;
}

/// A triangle's welded vertices, rotated so that the lowest is first.
Triangle canonical(const Triangle& t, const std::vector<int>& welded)
{
    Triangle w = {welded[t[0]], welded[t[1]], welded[t[2]]};
    std::rotate(w.begin(), std::min_element(w.begin(), w.end()), w.end());
    return w;
}

std::vector<Triangle> withoutDuplicates(const std::vector<Triangle>& triangles, const std::vector<int>& welded)
{
    std::vector<std::pair<Triangle, int>> sorted;
    sorted.reserve(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        sorted.emplace_back(canonical(triangles[t], welded), static_cast<int>(t));
    std::sort(sorted.begin(), sorted.end());
    std::vector<int> kept;
    for (std::size_t n = 0; n < sorted.size(); ++n)
        if (n == 0 || sorted[n].first != sorted[n - 1].first) kept.push_back(sorted[n].second);
    std::sort(kept.begin(), kept.end());
    std::vector<Triangle> result;
    for (const int t : kept) result.push_back(triangles[t]);
    return result;
}

/// Two triangles at an edge without others.
struct Neighbours
{
    int m_triangle, m_other;
    bool m_agree;
};

/// Each pair in both orders, sorted by triangle.
std::vector<Neighbours> neighboursOf(const std::vector<TriangleSide>& sides)
{
    std::vector<Neighbours> result;
    forEachEdge(sides,
                [&](std::size_t first, std::size_t last)
                {
                    const TriangleSide &s = sides[first], &t = sides[last - 1];
                    if (last - first != 2 || s.m_triangle == t.m_triangle) return;
                    result.push_back({s.m_triangle, t.m_triangle, s.m_way != t.m_way});
                    result.push_back({t.m_triangle, s.m_triangle, s.m_way != t.m_way});
                });
    std::sort(result.begin(), result.end(),
              [](const Neighbours& m, const Neighbours& n)
              { return std::tie(m.m_triangle, m.m_other) < std::tie(n.m_triangle, n.m_other); });
    return result;
}

class Orienter
{
public:
    Orienter(const SurfaceMesh& surface, const std::vector<TriangleSide>& sides)
        : m_surface(surface), m_neighbours(neighboursOf(sides)), m_seen(surface.m_triangles.size(), 0), m_turned(m_seen)
    {
    }

    /// Per triangle: 1 if it is to be reversed.
    const std::vector<char>& run()
    {
        const bool allAgree =
            std::all_of(m_neighbours.begin(), m_neighbours.end(), [](const Neighbours& n) { return n.m_agree; });
        for (std::size_t t = 0; t < m_seen.size() && !allAgree; ++t)
            if (!m_seen[t]) orientPatch(static_cast<int>(t));
        return m_turned;
    }

private:
    void orientPatch(int first)
    {
        std::vector<int> patch = {first};
        m_seen[first] = 1;
        for (std::size_t n = 0; n < patch.size(); ++n)
        {
            const auto begin = std::lower_bound(m_neighbours.begin(), m_neighbours.end(), patch[n],
                                                [](const Neighbours& m, int t) { return m.m_triangle < t; });
            for (auto at = begin; at != m_neighbours.end() && at->m_triangle == patch[n]; ++at)
            {
                if (m_seen[at->m_other]) continue;
                m_seen[at->m_other] = 1;
                m_turned[at->m_other] = at->m_agree ? m_turned[patch[n]] : !m_turned[patch[n]];
                patch.push_back(at->m_other);
            }
        }
        chooseSide(patch);
    }

    /// Chooses the outward orientation of a patch.
    void chooseSide(const std::vector<int>& patch)
    {
        const auto turned = std::count_if(patch.begin(), patch.end(), [&](int t) { return m_turned[t]; });
        const double share = static_cast<double>(turned) / static_cast<double>(patch.size());
        const bool clear = std::min(share, 1 - share) <= kMaxTurnedShare;
        if (clear ? share > 0.5 : volumeOf(patch) < 0)
            for (const int t : patch) m_turned[t] = !m_turned[t];
    }

    double volumeOf(const std::vector<int>& patch) const
    {
        SurfaceMesh part;
        for (const int t : patch)
        {
            const Triangle& corners = m_surface.m_triangles[t];
            const int n = static_cast<int>(part.m_vertices.size());
            for (const int i : corners) part.m_vertices.push_back(m_surface.m_vertices[i]);
            part.m_triangles.push_back(m_turned[t] ? Triangle{n, n + 2, n + 1} : Triangle{n, n + 1, n + 2});
        }
        return signedVolume(part);
    }

    const SurfaceMesh& m_surface;
    const std::vector<Neighbours> m_neighbours;
    std::vector<char> m_seen, m_turned;
};

}  // namespace

RepairedSurface repairSurface(const SurfaceMesh& surface)
{
    RepairedSurface result;
    result.m_welded = weldCoincident(surface.m_vertices);
    result.m_surface.m_vertices = surface.m_vertices;
    std::vector<Triangle>& triangles = result.m_surface.m_triangles;
    triangles = withoutDuplicates(surface.m_triangles, result.m_welded);
    result.m_duplicates = static_cast<int>(surface.m_triangles.size() - triangles.size());
    for (const Triangle& t : triangles) result.m_degenerate += !hasArea(surface, t);

    Orienter orienter(result.m_surface, sortedSides(triangles, result.m_welded));
    const std::vector<char> turned = orienter.run();
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (turned[t])
        {
            std::swap(triangles[t][1], triangles[t][2]);
            ++result.m_turned;
        }
    return result;
}

}  // namespace bullet_fem
