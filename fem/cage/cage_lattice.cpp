// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/cage_lattice.h"

#include <algorithm>
#include <cmath>

#include "fem/cage/triangle_overlap.h"
#include "fem/common/message.h"
#include "fem/mesh/cell_split.h"

namespace bullet_fem
{
namespace
{

constexpr double kTouchTolerance = 1e-9;  // maximum distance of a contact, in lattice units
constexpr double kMaxCubesPerTet = 20;    // bounds memory; sufficient for cages that fill 1 / 100 of their box
constexpr double kMaxCubes = 2e7;

double cubesAlong(double extent, double cellSize)
{
    return std::max(1.0, std::ceil(extent / cellSize - kTouchTolerance));
}

double cubesIn(const Vec3& extent, double cellSize)
{
    return cubesAlong(extent.x, cellSize) * cubesAlong(extent.y, cellSize) * cubesAlong(extent.z, cellSize);
}

/// Approximately the minimum cell size with which the box has at most `most` cubes, rounded up by one in a thousand.
double minCellSize(const Vec3& extent, double most)
{
    double fits = std::max({extent.x, extent.y, extent.z}), fails = fits / (2 * kMaxCubes);
    for (int n = 0; n < 100; ++n)
    {
        const double middle = std::sqrt(fits * fails);
        (cubesIn(extent, middle) <= most ? fits : fails) = middle;
    }
    return 1.001 * fits;
}

double maxCubes(const CageSettings& settings)
{
    return std::min(kMaxCubes, kMaxCubesPerTet * settings.m_maxTets);
}

}  // namespace

CellSizeRange CageLattice::cellSizeRange(const SurfaceInspection& surface, const CageSettings& settings)
{
    const Vec3 extent = surface.m_high - surface.m_low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    return {std::min(minCellSize(extent, maxCubes(settings)), longest), longest};
}

CageLattice::CageLattice(const SurfaceInspection& surface, const CageSettings& settings)
    : m_cellSize(settings.m_cellSize)
{
    const Vec3 extent = surface.m_high - surface.m_low;
    const double most = maxCubes(settings);
    const auto [least, longest] = cellSizeRange(surface, settings);
    const double tetsPerCube = settings.m_cellsAcross > 0 ? std::ldexp(6, 3 * settings.m_mostLevels) : 5;
    m_safeCellSize = std::min(minCellSize(extent, std::floor(settings.m_maxTets / tetsPerCube)), longest);
    if (!(m_cellSize > 0 && m_cellSize <= longest) || cubesIn(extent, m_cellSize) > most)
        reject("the cage's cell size is ", m_cellSize, " m, outside [", least, ", ", longest,
               "] m for this surface (at most ", most, " cubes, at least one along the longest side); ", m_safeCellSize,
               " m is sure to fit, ", std::max(m_safeCellSize, longest / 10),
               " m is a good start; or give m_targetTets");

    for (int a = 0; a < 3; ++a)
    {
        m_cubes[a] = static_cast<int>(cubesAlong(extent[a], m_cellSize));
        m_origin[a] = (surface.m_low[a] + surface.m_high[a]) / 2 - m_cubes[a] * m_cellSize / 2;
    }
    m_touched.assign(cubeCount(), 0);
    m_entered.assign(cubeCount(), 0);
}

std::array<int, 3> CageLattice::place(int cube) const
{
    return {cube % m_cubes[0], cube / m_cubes[0] % m_cubes[1], cube / m_cubes[0] / m_cubes[1]};
}

Vec3 CageLattice::cubeMiddle(int cube) const
{
    const auto [i, j, k] = place(cube);
    return {i + 0.5, j + 0.5, k + 0.5};
}

std::vector<int> CageLattice::cubesAround(const Vec3& p, double near) const
{
    std::array<int, 3> low, high;
    for (int a = 0; a < 3; ++a)
    {
        low[a] = std::clamp(static_cast<int>(std::floor(p[a] - near)), 0, m_cubes[a] - 1);
        high[a] = std::clamp(static_cast<int>(std::floor(p[a] + near)), 0, m_cubes[a] - 1);
    }
    std::vector<int> cubes;
    for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j)
            for (int i = low[0]; i <= high[0]; ++i) cubes.push_back(cube({i, j, k}));
    return cubes;
}

int CageLattice::node(int cube, int tet, int corner) const
{
    const auto [i, j, k] = place(cube);
    const int c = kFiveTets[(i + j + k) & 1][tet][corner];
    return ((k + (c >> 2 & 1)) * (m_cubes[1] + 1) + j + (c >> 1 & 1)) * (m_cubes[0] + 1) + i + (c & 1);
}

Vec3 CageLattice::nodePlace(int node) const
{
    const int nx = m_cubes[0] + 1, ny = m_cubes[1] + 1;
    return {1.0 * (node % nx), 1.0 * (node / nx % ny), 1.0 * (node / nx / ny)};
}

std::array<Vec3, 4> CageLattice::corners(int cube, int tet) const
{
    return {nodePlace(node(cube, tet, 0)), nodePlace(node(cube, tet, 1)), nodePlace(node(cube, tet, 2)),
            nodePlace(node(cube, tet, 3))};
}

void CageLattice::markSurface(const SurfaceMesh& surface)
{
    const std::vector<Vec3>& x = surface.m_vertices;
    for (const Triangle& t : surface.m_triangles)
    {
        const TriangleCorners triangle = {toLattice(x[t[0]]), toLattice(x[t[1]]), toLattice(x[t[2]])};
        std::array<int, 3> low, high;  // range of cubes of its bounding box
        for (int a = 0; a < 3; ++a)
        {
            const auto [least, most] = std::minmax({triangle[0][a], triangle[1][a], triangle[2][a]});
            low[a] = std::clamp(static_cast<int>(std::floor(least - kTouchTolerance)), 0, m_cubes[a] - 1);
            high[a] = std::clamp(static_cast<int>(std::floor(most + kTouchTolerance)), 0, m_cubes[a] - 1);
        }
        markTriangle(triangle, low, high);
    }
}

/// Bisects the block of cubes [low, high] down to single cubes, so that the cost is proportional to the cubes in
/// contact.
void CageLattice::markTriangle(const std::array<Vec3, 3>& triangle, const std::array<int, 3>& low,
                               const std::array<int, 3>& high)
{
    if (!triangleMeetsBox(triangle, {1.0 * low[0], 1.0 * low[1], 1.0 * low[2]},
                          {high[0] + 1.0, high[1] + 1.0, high[2] + 1.0}, kTouchTolerance))
        return;
    int axis = 0;
    for (int a = 1; a < 3; ++a)
        if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
    if (high[axis] > low[axis])
    {
        std::array<int, 3> lowerHigh = high, upperLow = low;
        lowerHigh[axis] = (low[axis] + high[axis]) / 2;
        upperLow[axis] = lowerHigh[axis] + 1;
        markTriangle(triangle, low, lowerHigh);
        markTriangle(triangle, upperLow, high);
        return;
    }
    const int at = cube(low);
    for (int tet = 0; tet < 5; ++tet)
    {
        if (m_entered[at] >> tet & 1 || !triangleMeetsTet(triangle, corners(at, tet), kTouchTolerance)) continue;
        m_touched[at] |= static_cast<std::uint8_t>(1 << tet);
        if (triangleMeetsTet(triangle, corners(at, tet), -kTouchTolerance))
            m_entered[at] |= static_cast<std::uint8_t>(1 << tet);
    }
}

}  // namespace bullet_fem
