// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/grading.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "fem/cage/triangle_overlap.h"

namespace bullet_fem
{
namespace
{

constexpr double kGradingTouchTolerance = 1e-9;  // in cells
constexpr double kMinDepth = 1e-6;               // in wanted cells: shallower intersections do not count
constexpr double kLongestEdge = 2;               // maximum edge of a part, in the cells that it requires
constexpr std::size_t kMaxQueuedCells = 100000;  // cells that are not yet processed
constexpr int kMaxCopies = 64;  // maximum copies of a part on its way across; more are never needed for 8 cells

std::vector<Vec3> aboutCentre(const SurfaceInspection& surface)
{
    std::vector<Vec3> x = surface.m_repaired.m_surface.m_vertices;
    const Vec3 centre = 0.5 * (surface.m_low + surface.m_high);
    for (Vec3& vertex : x) vertex -= centre;
    return x;
}

/// Number of bisections of a tet after which `cells` of its size are at most `width` cells of the lattice.
int generationFor(double cells, double width)
{
    return std::max(0, static_cast<int>(std::ceil(3 * std::log2(cells / width) - kGradingTouchTolerance)));
}

/// Halvings of a cell's edge, rounded up.
int levelOf(int generation)
{
    return (generation + 2) / 3;
}

class Wanting
{
public:
    Wanting(const CageLattice& lattice, const Grading& grading) : m_lattice(lattice), m_grading(grading) {}

    void add(const ThinPart& part)
    {
        const double width = norm(part.m_across) / m_lattice.cellSize();
        int generation = generationFor(m_grading.m_cellsAcross, width);
        if (part.m_isGap)
        {
            generation = 3 * levelOf(generation);  // so that lattice planes lie between the sides
            if (generation > m_grading.m_maxGenerations) return;
        }
        WantedCell cell;
        cell.m_generation = std::min(generation, m_grading.m_maxGenerations);
        cell.m_level = levelOf(cell.m_generation);
        if (cell.m_generation == 0) return;
        const int copies =
            part.m_isGap ? 0 : std::min(kMaxCopies, static_cast<int>(std::ceil(std::ldexp(width, cell.m_level))));
        for (int n = 0; n <= copies; ++n)
        {
            TriangleCorners x = part.m_corners;
            for (Vec3& corner : x)
                corner = m_lattice.fromCentred(corner + (copies > 0 ? 1.0 * n / copies : 0) * part.m_across);
            add(x, cell);
        }
    }

    /// Sorts the cells, each position once per level.
    std::vector<WantedCell>& cells()
    {
        const auto key = [](const WantedCell& c) { return std::tuple(c.m_level, c.m_place, -c.m_generation); };
        const auto same = [](const WantedCell& a, const WantedCell& b)
        { return a.m_level == b.m_level && a.m_place == b.m_place; };
        std::sort(m_cells.begin(), m_cells.end(),
                  [&](const WantedCell& a, const WantedCell& b) { return key(a) < key(b); });
        m_cells.erase(std::unique(m_cells.begin(), m_cells.end(), same), m_cells.end());
        return m_cells;
    }

    std::size_t size() const { return m_cells.size(); }  ///< may include duplicates

private:
    /// Adds the cells of this level in contact with a triangle.
    void add(TriangleCorners x, WantedCell cell)
    {
        for (Vec3& corner : x) corner *= std::ldexp(1.0, cell.m_level);
        std::array<int, 3> low, high;
        for (int a = 0; a < 3; ++a)
        {
            const auto [least, most] = std::minmax({x[0][a], x[1][a], x[2][a]});
            const int last = (m_lattice.cubes()[a] << cell.m_level) - 1;
            low[a] = std::clamp(static_cast<int>(std::floor(least - kGradingTouchTolerance)), 0, last);
            high[a] = std::clamp(static_cast<int>(std::floor(most + kGradingTouchTolerance)), 0, last);
        }
        if (low == high)
        {
            cell.m_place = low;
            return m_cells.push_back(cell);
        }
        std::array<int, 3>& at = cell.m_place;
        for (at[2] = low[2]; at[2] <= high[2]; ++at[2])
            for (at[1] = low[1]; at[1] <= high[1]; ++at[1])
                for (at[0] = low[0]; at[0] <= high[0]; ++at[0])
                {
                    const Vec3 corner = {1.0 * at[0], 1.0 * at[1], 1.0 * at[2]};
                    if (triangleMeetsBox(x, corner, corner + Vec3{1, 1, 1}, kGradingTouchTolerance))
                        m_cells.push_back(cell);
                }
    }

    const CageLattice& m_lattice;
    const Grading m_grading;
    std::vector<WantedCell> m_cells;
};

/// A wanted cell and a tet that may have to be bisected for it.
struct Wish
{
    const WantedCell* m_cell;
    int m_tet;
};

bool meets(const WantedCell& cell, const std::array<Vec3, 4>& tet)
{
    const double edge = std::ldexp(1.0, -cell.m_level), in = kMinDepth * edge;
    const Vec3 low = Vec3{1.0 * cell.m_place[0], 1.0 * cell.m_place[1], 1.0 * cell.m_place[2]} * edge;
    return TetRegion(tet).mayMeet(low + Vec3{in, in, in}, low + Vec3{edge - in, edge - in, edge - in});
}

/// Replaces the tet of a wish by its descendant leaves that are too large.
void follow(const Wish& wish, const BisectedTets& tets, std::vector<Wish>& wishes)
{
    const BisectedTet& tet = tets.tets()[wish.m_tet];
    if (tet.m_generation >= wish.m_cell->m_generation || !meets(*wish.m_cell, tets.corners(wish.m_tet))) return;
    if (tet.m_child == 0) return wishes.push_back(wish);
    follow({wish.m_cell, tet.m_child}, tets, wishes);
    follow({wish.m_cell, tet.m_child + 1}, tets, wishes);
}

}  // namespace

GradedSurface::GradedSurface(const SurfaceInspection& surface, const SurfaceWinding& winding,
                             const CageSettings& settings, double cellSize)
    : m_tree(aboutCentre(surface), surface.m_repaired.m_surface.m_triangles)
{
    ThinSearch search{m_tree, winding};
    search.m_reach = settings.m_cellsAcross * cellSize;
    search.m_coarsest = cellSize / 2;
    search.m_edgePerWidth = kLongestEdge / settings.m_cellsAcross;
    // Much smaller cells over this area would exceed m_maxTets.
    search.m_finest = std::max(kLongestEdge * std::ldexp(cellSize, -settings.m_mostLevels),
                               3 * std::sqrt(surface.m_area / settings.m_maxTets));
    m_parts = findThinParts(aboutCentre(surface), surface.m_repaired.m_surface.m_triangles, search);
}

bool findWantedCells(const CageLattice& lattice, const std::vector<ThinPart>& parts, const Grading& grading,
                     WantedCells& wanted)
{
    Wanting wanting(lattice, grading);
    for (const ThinPart& part : parts)
    {
        wanting.add(part);
        if (wanting.size() > 2 * wanted.m_max + kMaxQueuedCells && wanting.cells().size() > wanted.m_max) return false;
    }
    wanted.m_cells = std::move(wanting.cells());
    return true;
}

bool grade(const std::vector<WantedCell>& wanted, std::size_t most, BisectedTets& tets)
{
    std::vector<Wish> wishes, rest;
    for (const WantedCell& cell : wanted)
    {
        const std::array<int, 3>& at = cell.m_place;
        const int first = tets.firstOf({at[0] >> cell.m_level, at[1] >> cell.m_level, at[2] >> cell.m_level});
        for (int n = 0; n < 6 && first >= 0; ++n) wishes.push_back({&cell, first + n});
    }
    std::vector<char> marks;
    for (;;)
    {
        rest.clear();
        for (const Wish& wish : wishes) follow(wish, tets, rest);
        wishes.swap(rest);
        if (wishes.empty()) return true;
        marks.assign(tets.tets().size(), 0);
        for (const Wish& wish : wishes) marks[wish.m_tet] = 1;
        if (!tets.halve(marks, most)) return false;
    }
}

}  // namespace bullet_fem
