// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/cage_stages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_fem/fem/cage/cage_report.h"
#include "fem/cage/triangle_tree.h"

namespace bullet_fem
{
namespace
{

constexpr double kEntryDepth = 1e-9;     // minimum depth of an entered surface, in cells
constexpr double kQualityMargin = 1e-6;  // above the rounding of moving positions back from the centre
constexpr int kSnapRounds = 8;
constexpr double kMovePerRound = 0.25;
constexpr int kHalvings = 3;        // halvings of an impossible move
constexpr double kMinMove = 0.001;  // share of the way; smaller moves are not tried

/// For every node the elements, or boundary triangles, that use it.
template <std::size_t N>
std::vector<std::vector<int>> usersOf(int nodeCount, const std::vector<std::array<int, N>>& cells)
{
    std::vector<std::vector<int>> users(nodeCount);
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (const int node : cells[c]) users[node].push_back(static_cast<int>(c));
    return users;
}

std::vector<Vec3> moved(std::vector<Vec3> points, const Vec3& by)
{
    for (Vec3& x : points) x += by;
    return points;
}

class Snapper
{
public:
    Snapper(const TetMesh& cage, const SnapTarget& target)
        : m_cage(cage),
          m_target(target),
          m_centre(0.5 * (target.m_surface.m_low + target.m_surface.m_high)),
          m_tree(moved(target.m_surface.m_repaired.m_surface.m_vertices, -m_centre),
                 target.m_surface.m_repaired.m_surface.m_triangles),
          m_depth(kEntryDepth * target.m_cellSize),
          m_rounding(kEntryDepth * std::pow(target.m_cellSize, 3)),
          m_x(moved(cage.restPositions(), -m_centre)),
          m_tetsOf(usersOf(cage.nodeCount(), cage.tets())),
          m_trianglesOf(usersOf(cage.nodeCount(), cage.surface())),
          m_share(cage.nodeCount(), 0)
    {
    }

    TetMesh run()
    {
        for (const int node : m_cage.surfaceNodes())
        {
            m_start.push_back(m_x[node]);
            m_way.push_back((m_tree.nearest(m_x[node]) - m_x[node]) * m_target.m_share);
        }
        for (int round = 0; round < kSnapRounds; ++round)
            for (std::size_t n = 0; n < m_start.size(); ++n) advance(n, std::min(1.0, kMovePerRound * (round + 1)));

        std::vector<Vec3> X = m_cage.restPositions();
        for (std::size_t n = 0; n < m_start.size(); ++n)
            if (m_share[n] > 0) X[m_cage.surfaceNodes()[n]] = m_x[m_cage.surfaceNodes()[n]] + m_centre;
        return TetMesh(std::move(X), m_cage.tets());
    }

private:
    /// Moves boundary node n along its way, to the share `wanted` at most.
    void advance(std::size_t n, double wanted)
    {
        const int node = m_cage.surfaceNodes()[n];
        double step = wanted - m_share[n];
        for (int k = 0; k <= kHalvings && step > kMinMove; ++k, step /= 2)
        {
            const Vec3 to = m_start[n] + (m_share[n] + step) * m_way[n];
            if (!staysGood(node, to) || !staysOutside(node, to)) continue;
            m_x[node] = to;
            m_share[n] += step;
            return;
        }
    }

    bool staysGood(int node, const Vec3& to) const
    {
        return std::all_of(m_tetsOf[node].begin(), m_tetsOf[node].end(),
                           [&](int e)
                           {
                               std::array<Vec3, 4> x;
                               for (int a = 0; a < 4; ++a)
                                   x[a] = m_cage.tets()[e][a] == node ? to : m_x[m_cage.tets()[e][a]];
                               return meanRatio(x) >= kSnappedQuality + kQualityMargin;
                           });
    }

    /// A boundary triangle whose corner moves straight sweeps a tet, which must be on its inner side and free of the
    /// surface.
    bool staysOutside(int node, const Vec3& to) const
    {
        if (m_target.m_surface.m_openEdges > 0 && std::abs(m_target.m_winding.m_number.at(to)) >= 0.5) return false;
        return std::all_of(m_trianglesOf[node].begin(), m_trianglesOf[node].end(),
                           [&](int t)
                           {
                               std::array<Vec3, 4> swept;
                               for (int a = 0; a < 3; ++a) swept[a] = m_x[m_cage.surface()[t][a]];
                               swept[3] = to;
                               const double outward =
                                   dot(cross(swept[1] - swept[0], swept[2] - swept[0]), to - swept[0]);
                               if (outward > m_rounding) return false;
                               return !m_tree.entersTet(swept, m_depth);
                           });
    }

    const TetMesh& m_cage;
    const SnapTarget& m_target;
    const Vec3 m_centre;
    const TriangleTree m_tree;
    const double m_depth, m_rounding;  // [m], [m3]
    std::vector<Vec3> m_x;             // relative to the centre
    const std::vector<std::vector<int>> m_tetsOf, m_trianglesOf;
    std::vector<Vec3> m_start, m_way;  // per boundary node
    std::vector<double> m_share;       // completed share of the way
};

}  // namespace

TetMesh snapped(const TetMesh& cage, const SnapTarget& target)
{
    return Snapper(cage, target).run();
}

}  // namespace bullet_fem
