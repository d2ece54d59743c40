// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

constexpr double kMaxCells = 1e6;  // along an edge; beyond the limit of makeBox, whose error message then applies

double cellsAlong(double edge, double cell)
{
    return std::clamp(std::round(edge / cell), 1.0, kMaxCells);
}

// Cell size [m] for a block of about `tets` elements, five per cell. Found by bisection, because thin blocks keep one
// cell across for all larger cell sizes.
double cellFor(const Vec3& size, double tets)
{
    const auto count = [&](double cell)
    { return 5 * cellsAlong(size.x, cell) * cellsAlong(size.y, cell) * cellsAlong(size.z, cell); };
    double low = 1e-12 * (size.x + size.y + size.z), high = 2 * (size.x + size.y + size.z);
    for (int k = 0; k < 100; ++k)
    {
        const double middle = std::sqrt(low * high);
        (count(middle) < tets ? high : low) = middle;
    }
    return tets * tets < count(low) * count(high) ? high : low;  // the nearer count by ratio
}

// The elements of a block whose centre is in no hole.
TetMesh withoutHoles(const TetMesh& block, const SceneMesh& mesh)
{
    const std::vector<Vec3>& X = block.restPositions();
    const auto isHole = [&](const Tet& tet)
    {
        const Vec3 middle = (0.25 / mesh.m_scale) * (X[tet[0]] + X[tet[1]] + X[tet[2]] + X[tet[3]]);
        return std::any_of(mesh.m_holes.begin(), mesh.m_holes.end(),
                           [&](const SceneBox& hole) { return hole.contains(middle); });
    };
    std::vector<int> number(X.size(), -1);
    std::vector<Vec3> kept;
    std::vector<Tet> tets;
    for (Tet tet : block.tets())
    {
        if (isHole(tet)) continue;
        for (int& node : tet)
        {
            if (number[node] < 0)
            {
                number[node] = static_cast<int>(kept.size());
                kept.push_back(X[node]);
            }
            node = number[node];
        }
        tets.push_back(tet);
    }
    return TetMesh(std::move(kept), std::move(tets));  // throws if no elements remain
}

}  // namespace

TetMesh blockOf(const SceneMesh& mesh)
{
    const Vec3 size = mesh.m_scale * mesh.m_size;
    const double cell = mesh.m_cellSize > 0 ? mesh.m_cellSize : cellFor(size, mesh.m_tets);
    std::array<int, 3> cells;
    for (int i = 0; i < 3; ++i) cells[i] = static_cast<int>(cellsAlong(size[i], cell));
    const TetMesh block = makeBox(size, cells, -0.5 * size);
    return mesh.m_holes.empty() ? block : withoutHoles(block, mesh);
}

// Six elements per cell of the cube that is mapped to the ball.
TetMesh ballOf(const SceneMesh& mesh)
{
    const double radius = mesh.m_scale * mesh.m_radius;
    const double cells = mesh.m_cellSize > 0 ? 2 * radius / mesh.m_cellSize : std::cbrt(mesh.m_tets / 6.0);
    return makeSphere(radius, static_cast<int>(std::clamp(std::round(cells), 2.0, kMaxCells)));
}

// Six elements per cell of the square that is mapped to the disc. The generator's z axis becomes y.
TetMesh cylinderOf(const SceneMesh& mesh)
{
    const double radius = mesh.m_scale * mesh.m_radius, height = mesh.m_scale * mesh.m_height;
    // For cubic cells: 6 (2 r / cell)^2 (h / cell) = tets.
    const double cell =
        mesh.m_cellSize > 0 ? mesh.m_cellSize : std::cbrt(24 * radius * radius * height / double(mesh.m_tets));
    const auto halfAcross = static_cast<int>(cellsAlong(radius, cell));
    const TetMesh upright = makeCylinder(radius, height, 2 * halfAcross, static_cast<int>(cellsAlong(height, cell)));
    std::vector<Vec3> X = upright.restPositions();
    for (Vec3& x : X) x = {x.x, x.z, -x.y};
    return TetMesh(std::move(X), upright.tets());
}

CageSettings cageOf(const SceneMesh& mesh)
{
    CageSettings settings;
    settings.m_cellSize = mesh.m_cellSize;
    settings.m_targetTets = mesh.m_cellSize > 0 ? 0 : mesh.m_tets;
    settings.m_cellsAcross = mesh.m_cellsAcross;
    settings.m_mostLevels = mesh.m_mostLevels;
    settings.m_maxTets = 5000000;
    settings.m_surfaceCollides = mesh.m_surfaceCollides;
    return settings;
}

}  // namespace bullet_fem
