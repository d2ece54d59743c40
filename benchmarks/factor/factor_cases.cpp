// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/factor/factor_cases.h"

#include <cmath>
#include <functional>
#include <utility>

#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

using IsPinned = std::function<bool(const Vec3&)>;

Material materialOf(double youngModulus, double poissonRatio)
{
    Material material;
    material.m_youngModulus = youngModulus;
    material.m_poissonRatio = poissonRatio;
    material.m_density = 1000;
    material.m_stiffnessDamping = 0.01;
    return material;
}

FactorCase caseOf(std::string name, TetMesh mesh, const IsPinned& pinned = nullptr,
                  const Material& material = materialOf(1e6, 0.3), const std::vector<double>& filled = {})
{
    FactorCase result;
    result.m_name = std::move(name);
    result.m_shape = std::make_shared<const RestShape>(std::move(mesh), material, filled);
    result.m_input.m_mass = result.m_shape->m_lumpedMass;
    const TetMesh& checked = result.m_shape->m_mesh;
    for (int i = 0; i < checked.nodeCount(); ++i)
        result.m_input.m_fixed.push_back(checked.isLoose(i) || (pinned && pinned(checked.restPositions()[i])));
    return result;
}

FactorCase cageCase(std::string name, const SurfaceMesh& surface, const CageSettings& settings)
{
    Cage cage = makeCage(surface, settings);
    return caseOf(std::move(name), std::move(cage.m_mesh), nullptr, materialOf(1e6, 0.3), cage.m_filled);
}

/// A torus around z with around^2 triangles.
SurfaceMesh torus(double ring, double tube, int around)
{
    const double pi = std::acos(-1.0);
    SurfaceMesh surface;
    const int across = around / 2;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
        {
            const double u = 2 * pi * i / around, v = 2 * pi * j / across, r = ring + tube * std::cos(v);
            surface.m_vertices.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
            const int a = i * across + j, b = (i + 1) % around * across + j,
                      c = (i + 1) % around * across + (j + 1) % across, d = i * across + (j + 1) % across;
            surface.m_triangles.push_back({a, b, c});
            surface.m_triangles.push_back({a, c, d});
        }
    return surface;
}

/// Both meshes as two components of one mesh, plus `loose` nodes without elements.
TetMesh together(const TetMesh& a, const TetMesh& b, int loose = 0)
{
    std::vector<Vec3> X = a.restPositions();
    X.insert(X.end(), b.restPositions().begin(), b.restPositions().end());
    std::vector<Tet> tets = a.tets();
    for (Tet tet : b.tets())
    {
        for (int& node : tet) node += a.nodeCount();
        tets.push_back(tet);
    }
    for (int k = 0; k < loose; ++k) X.push_back({double(k), -5, 0});
    return TetMesh(std::move(X), std::move(tets), loose > 0 ? LooseNodes::kept : LooseNodes::refused);
}

/// Moves every second layer of nodes along z close to the one below, which gives elements of a hundredth of their
/// width.
TetMesh slivers(const TetMesh& box, double cell)
{
    std::vector<Vec3> X = box.restPositions();
    for (Vec3& x : X)
    {
        const int layer = static_cast<int>(std::lround(x.z / cell));
        if (layer % 2 == 1) x.z = (layer - 1) * cell + 0.01 * cell;
    }
    return TetMesh(std::move(X), box.tets());
}

TetMesh kuhnBox(const Vec3& size, const std::array<int, 3>& cells)
{
    return makeBox(size, cells, {}, CellSplit::kuhnSix);
}

bool atRoot(const Vec3& X)
{
    return X.x < 1e-9;
}

bool atBottom(const Vec3& X)
{
    return X.z < 1e-9;
}

CageSettings cells(double size, double across = 0, double snap = 0)
{
    CageSettings settings;
    settings.m_cellSize = size;
    settings.m_cellsAcross = across;
    settings.m_snap = snap;
    return settings;
}

}  // namespace

FactorSystem::FactorSystem(const FactorCase& factorCase) : m_A0(assembleA0(*factorCase.m_shape, factorCase.m_input))
{
    std::vector<int> position(m_A0.nodeCount(), -1);
    for (int i = 0; i < m_A0.nodeCount(); ++i)
        if (!factorCase.m_input.m_fixed[i])
        {
            position[i] = static_cast<int>(m_freeNodes.size());
            m_freeNodes.push_back(i);
        }
    m_pattern = blockPattern(m_A0, m_freeNodes, position);
    m_lowerEntries = 9.0 * double(m_pattern.m_rowIndex.size()) - 3.0 * m_pattern.m_size;
}

FactorCase beamCase(int cellsPerMetre)
{
    const int n = cellsPerMetre;
    return caseOf("beam " + std::to_string(24 * n * n * n), kuhnBox({4, 1, 1}, {4 * n, n, n}), atRoot);
}

FactorCase cubeCase(int cells)
{
    return caseOf("cube " + std::to_string(6 * cells * cells * cells), kuhnBox({1, 1, 1}, {cells, cells, cells}));
}

std::vector<FactorCaseMaker> thirtyFactorCases()
{
    return {
        [] { return beamCase(2); },
        [] { return beamCase(4); },
        [] { return beamCase(6); },
        [] {
            return caseOf("beam, alternating", makeBox({4, 1, 1}, {24, 6, 6}), atRoot);
        },
        [] {
            return caseOf("beam, nu .49", kuhnBox({4, 1, 1}, {16, 4, 4}), atRoot, materialOf(1e6, 0.49));
        },
        [] {
            return caseOf("bar 60 x 3 x 3", kuhnBox({6, .3, .3}, {60, 3, 3}));
        },
        [] {
            return caseOf("wire 200 x 1 x 1", makeBox({20, .1, .1}, {200, 1, 1}));
        },
        [] {
            return caseOf("plate 24 x 24 x 2", makeBox({1, 1, .05}, {24, 24, 2}));
        },
        [] { return cubeCase(1); },
        [] { return cubeCase(4); },
        [] { return cubeCase(7); },
        [] { return cubeCase(10); },
        [] { return cubeCase(13); },
        [] {
            return caseOf("cube, alternating", makeBox({1, 1, 1}, {12, 12, 12}));
        },
        [] {
            return caseOf("cube, E 1e9", kuhnBox({1, 1, 1}, {8, 8, 8}), nullptr, materialOf(1e9, 0.3));
        },
        [] {
            return caseOf("cube, nu .49", kuhnBox({1, 1, 1}, {8, 8, 8}), nullptr, materialOf(1e6, 0.49));
        },
        [] { return caseOf("ball 8", makeSphere(0.5, 8)); },
        [] { return caseOf("ball 14", makeSphere(0.5, 14)); },
        [] {
            return caseOf("ball 5 x 6 x 7", makeSphere(0.5, {5, 6, 7}));
        },
        [] { return caseOf("cylinder", makeCylinder(0.3, 1, 8, 16)); },
        [] { return cageCase("cage of a torus", torus(0.5, 0.15, 48), cells(0.06)); },
        [] { return cageCase("cage of a torus, graded", torus(0.5, 0.15, 48), cells(0.12, 3)); },
        [] { return cageCase("cage of a thin ring, graded", torus(0.5, 0.04, 64), cells(0.08, 2)); },
        [] { return cageCase("cage of a torus, snapped", torus(0.5, 0.15, 48), cells(0.08, 0, 1)); },
        [] {
            return caseOf("cube on a pinned side", kuhnBox({1, 1, 1}, {9, 9, 9}), atBottom);
        },
        [] {
            return caseOf("plate, pinned edge", makeBox({1, 1, .1}, {20, 20, 2}), atRoot);
        },
        [] { return caseOf("two balls", together(makeSphere(0.5, 8), makeSphere(0.3, 6))); },
        []
        {
            return caseOf("box, bar and loose nodes",
                          together(makeBox({1, 1, 1}, {6, 6, 6}), makeBox({4, .2, .2}, {40, 2, 2}), 5));
        },
        [] {
            return caseOf("slivers 1:100", slivers(makeBox({1, 1, 1}, {8, 8, 8}), 0.125));
        },
        [] {
            return caseOf("flat box 1:20", makeBox({1, 1, .05}, {10, 10, 10}));
        },
    };
}

}  // namespace bullet_fem
