// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/element_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/scenes/lattice_box.h"

namespace bullet_fem
{
namespace
{

Vec3 middleOfElement(const TetMesh& mesh, int e)
{
    Vec3 sum;
    for (const int node : mesh.tets()[e]) sum += 0.25 * mesh.restPositions()[node];
    return sum;
}

// Each element is in exactly one patch, ascending; patches are connected and of an allowed size.
void expectPatches(const TetMesh& mesh, const ElementPatches& patches)
{
    std::vector<int> seen(mesh.tetCount(), 0);
    for (int p = 0; p < patches.count(); ++p)
    {
        const auto begin = patches.m_element.begin() + patches.m_start[p], end = begin + patches.size(p);
        ASSERT_GE(patches.size(p), 1);
        ASSERT_LE(patches.size(p), ElementPatches::kMax);
        EXPECT_TRUE(std::is_sorted(begin, end));
        std::vector<int> reached = {*begin};
        for (std::size_t k = 0; k < reached.size(); ++k)
            for (auto e = begin; e != end; ++e)
            {
                int shared = 0;
                for (const int node : mesh.tets()[*e])
                    shared += static_cast<int>(
                        std::count(mesh.tets()[reached[k]].begin(), mesh.tets()[reached[k]].end(), node));
                if (shared == 3 && std::count(reached.begin(), reached.end(), *e) == 0) reached.push_back(*e);
            }
        EXPECT_EQ(static_cast<int>(reached.size()), patches.size(p)) << "patch " << p << " is not connected";
        for (auto e = begin; e != end; ++e)
        {
            ++seen[*e];
            EXPECT_EQ(patches.m_patch[*e], p);
        }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), mesh.tetCount());
}

// Cubes, and cells eight times as long as thick.
TEST(MeshElementPatches, AreTheCellsOfBothSplits)
{
    for (const CellSplit split : {CellSplit::alternatingFive, CellSplit::kuhnSix})
        for (const double length : {1., 8.})
        {
            const std::array<int, 3> cells = {5, 4, 3};
            const TetMesh mesh = makeBox({5 * length, 4 * length, 3}, cells, {}, split);
            const ElementPatches patches(mesh);
            expectPatches(mesh, patches);
            ASSERT_EQ(patches.count(), 5 * 4 * 3);
            const Vec3 cell = {length, length, 1};
            for (int e = 0; e < mesh.tetCount(); ++e)
            {
                const Vec3 a = middleOfElement(mesh, e),
                           b = middleOfElement(mesh, patches.m_element[patches.m_start[patches.m_patch[e]]]);
                for (int c = 0; c < 3; ++c) EXPECT_EQ(std::floor(a[c] / cell[c]), std::floor(b[c] / cell[c]));
            }
        }
}

// In the order of generation, and in any other.
TEST(MeshElementPatches, AreTheOctahedraOfALattice)
{
    const TetMesh lattice = makeLatticeBox({4, 3, 3}, 1);
    for (const TetMesh& mesh : {lattice, shuffledMesh(lattice, 0, 3)})
    {
        const ElementPatches patches(mesh);
        expectPatches(mesh, patches);
        int octahedra = 0;
        for (int p = 0; p < patches.count(); ++p)
        {
            std::set<int> nodes;
            for (int k = patches.m_start[p]; k < patches.m_start[p + 1]; ++k)
                nodes.insert(mesh.tets()[patches.m_element[k]].begin(), mesh.tets()[patches.m_element[k]].end());
            octahedra += patches.size(p) == 4 && nodes.size() == 6;
        }
        // One for each inner face of the cubes, but for some at the box's edges.
        EXPECT_GE(octahedra, 0.9 * (3 * 3 * 3 + 4 * 2 * 3 + 4 * 3 * 2));
    }
}

TEST(MeshElementPatches, AreNeighboursInAnyOtherMesh)
{
    for (const TetMesh& mesh : {shuffledMesh(makeBox({1, 1, 1}, {6, 6, 6}, {}, CellSplit::kuhnSix), 0.15, 1),
                                makeSphere(1, 6), makeCylinder(1, 2, 6, 5), makeBox({1, 1, 1}, {1, 1, 1}),
                                TetMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}})})
    {
        const ElementPatches patches(mesh);
        expectPatches(mesh, patches);
        int few = 0;
        for (int p = 0; p < patches.count(); ++p) few += patches.size(p) < 4;
        EXPECT_LE(few, 1 + patches.count() / 20) << "of " << patches.count() << " patches";
        EXPECT_LE(patches.count(), 1 + mesh.tetCount() / 4);
    }
}

TEST(MeshElementPatches, AreMadeIfTheMaterialRequestsThem)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {2, 2, 2});
    const auto count = [&](double nu, MeanDilatation choice)
    {
        Material material;
        material.m_poissonRatio = nu;
        material.m_meanDilatation = choice;
        return RestShape(mesh, material).m_patches.count();
    };
    EXPECT_EQ(count(0.4, MeanDilatation::automatic), 0);
    EXPECT_EQ(count(static_cast<double>(0.4f), MeanDilatation::automatic), 0);  // rounded as by Bullet
    EXPECT_EQ(count(0.41, MeanDilatation::automatic), 8);
    EXPECT_EQ(count(0.1, MeanDilatation::on), 8);
    EXPECT_EQ(count(0.499, MeanDilatation::off), 0);
}

}  // namespace
}  // namespace bullet_fem
