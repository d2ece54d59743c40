// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/generators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

/// Minimum of volume over longest edge cubed [-].
double leastQuality(const TetMesh& mesh)
{
    double least = 1;
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        double longest = 0;
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b)
                longest = std::max(
                    longest, norm(mesh.restPositions()[mesh.tets()[e][a]] - mesh.restPositions()[mesh.tets()[e][b]]));
        least = std::min(least, mesh.tetVolume(e) / (longest * longest * longest));
    }
    return least;
}

/// Sum over the elements of volume times centroid, over the volume [m].
Vec3 centreOfVolume(const TetMesh& mesh)
{
    Vec3 sum;
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (const int i : mesh.tets()[e]) sum += mesh.tetVolume(e) / 4 * mesh.restPositions()[i];
    return sum * (1 / mesh.volume());
}

struct BoxCase
{
    const char* m_name;
    CellSplit m_split;
    int m_tetsPerCell;
};

class MakeBox : public testing::TestWithParam<BoxCase>
{
};

TEST_P(MakeBox, FillsTheBoxWithMatchingFaces)
{
    const TetMesh mesh = makeBox({3, 2, 5}, {3, 4, 2}, {-1, 2, 7}, GetParam().m_split);
    EXPECT_EQ(mesh.nodeCount(), 4 * 5 * 3);
    EXPECT_EQ(mesh.tetCount(), 3 * 4 * 2 * GetParam().m_tetsPerCell);
    EXPECT_EQ(mesh.turnedCount(), 0);
    EXPECT_EQ(mesh.componentCount(), 1);
    EXPECT_NEAR(mesh.volume(), 30, 30 * 1e-13);
    // Diagonals that do not match would leave inner cell faces on the boundary.
    EXPECT_EQ(mesh.surface().size(), 2u * 2 * (3 * 4 + 4 * 2 + 3 * 2));
    const Vec3 centre = centreOfVolume(mesh);
    EXPECT_NEAR(centre.x, 0.5, 1e-12);
    EXPECT_NEAR(centre.y, 3, 1e-12);
    EXPECT_NEAR(centre.z, 9.5, 1e-12);
}

TEST_P(MakeBox, NumbersNodesWithXFastest)
{
    const TetMesh mesh = makeBox({3, 2, 5}, {3, 4, 2}, {-1, 2, 7}, GetParam().m_split);
    const int i = 2, j = 3, k = 1;
    const Vec3 X = mesh.restPositions()[(k * 5 + j) * 4 + i];
    EXPECT_DOUBLE_EQ(X.x, 1);
    EXPECT_DOUBLE_EQ(X.y, 3.5);
    EXPECT_DOUBLE_EQ(X.z, 9.5);
    EXPECT_EQ(mesh.restPositions().back().z, 12);  // exactly at the far side
}

INSTANTIATE_TEST_SUITE_P(Splits, MakeBox,
                         testing::Values(BoxCase{"alternatingFive", CellSplit::alternatingFive, 5},
                                         BoxCase{"kuhnSix", CellSplit::kuhnSix, 6}),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

TEST(MakeBoxSplit, KuhnHasTheSameDiagonalInEveryElement)
{
    const TetMesh mesh = makeBox({2, 2, 2}, {2, 2, 2}, {}, CellSplit::kuhnSix);
    for (const Tet& tet : mesh.tets())
    {
        const Vec3 d = mesh.restPositions()[tet[3]] - mesh.restPositions()[tet[0]];
        EXPECT_EQ(d.x, 1);
        EXPECT_EQ(d.y, 1);
        EXPECT_EQ(d.z, 1);
    }
}

TEST(MakeBoxSplit, FiveTetsAreFourCornersAndTheMiddle)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    std::vector<double> volumes;
    for (int e = 0; e < 5; ++e) volumes.push_back(6 * mesh.tetVolume(e));
    std::sort(volumes.begin(), volumes.end());
    for (int e = 0; e < 4; ++e) EXPECT_DOUBLE_EQ(volumes[e], 1);
    EXPECT_DOUBLE_EQ(volumes[4], 2);
}

TEST(MakeBeam, RoundsItsCellsAndStartsAtTheOrigin)
{
    const TetMesh mesh = makeBeam(1, 0.1, 0.05, 0.026, CellSplit::kuhnSix);  // 38.5, 3.8, 1.9 cells
    EXPECT_EQ(mesh.tetCount(), 38 * 4 * 2 * 6);
    EXPECT_NEAR(mesh.volume(), 0.005, 0.005 * 1e-12);
    EXPECT_EQ(mesh.restPositions().front().x, 0);
    EXPECT_EQ(mesh.restPositions().back().x, 1);
    EXPECT_EQ(makeBeam(1, 0.1, 0.1, 0.5).tetCount(), 2 * 5);  // at least one cell across
}

class RoundMesh : public testing::TestWithParam<int>
{
};

// The faceted volume of a ball is short of the exact one by O(1/n^2): measured 0.88 / n^2 at n = 2, 1.0 / n^2 at 40.
TEST_P(RoundMesh, SphereConvergesFromBelow)
{
    const int n = GetParam();
    const TetMesh mesh = makeSphere(0.5, n);
    const double exact = 4.0 / 3 * kPi * 0.125;
    EXPECT_LT(mesh.volume(), exact);
    EXPECT_GT(mesh.volume(), exact * (1 - 1.1 / n / n));
    EXPECT_GT(leastQuality(mesh), 0.025);
    EXPECT_EQ(mesh.turnedCount(), 0);
    EXPECT_EQ(mesh.componentCount(), 1);
    EXPECT_EQ(mesh.surface().size(), 12u * n * n);
    for (const int i : mesh.surfaceNodes()) EXPECT_NEAR(norm(mesh.restPositions()[i]), 0.5, 1e-15);
    EXPECT_LT(norm(centreOfVolume(mesh)), 1e-15);
}

// With an odd number of cells the middle diagonals point to one side.
TEST(MakeSphere, HasAnyNumbersOfCells)
{
    const double exact = 4.0 / 3 * kPi * 0.125;
    for (const std::array<int, 3>& cells :
         {std::array<int, 3>{3, 3, 3}, {2, 3, 4}, {6, 6, 5}, {5, 7, 6}, {9, 9, 9}, {2, 2, 3}})
    {
        const auto& [nx, ny, nz] = cells;
        const TetMesh mesh = makeSphere(0.5, cells);
        const int fewest = std::min({nx, ny, nz});
        EXPECT_EQ(mesh.tetCount(), 6 * nx * ny * nz);
        EXPECT_LT(mesh.volume(), exact);
        EXPECT_GT(mesh.volume(), exact * (1 - 1.1 / fewest / fewest));
        EXPECT_GT(leastQuality(mesh), 0.02);
        EXPECT_EQ(mesh.turnedCount(), 0);
        EXPECT_EQ(mesh.surface().size(), 4u * (nx * ny + ny * nz + nz * nx));
        for (const int i : mesh.surfaceNodes()) EXPECT_NEAR(norm(mesh.restPositions()[i]), 0.5, 1e-15);
        EXPECT_LT(norm(centreOfVolume(mesh)), 0.03 * 0.5);
    }
}

TEST_P(RoundMesh, CylinderConvergesFromBelow)
{
    const int n = GetParam();
    const TetMesh mesh = makeCylinder(0.5, 2, n, n + 1);
    const double exact = kPi * 0.25 * 2;
    // Its cross section is a regular polygon of 4 n sides.
    EXPECT_NEAR(mesh.volume(), 2 * 4 * n * 0.125 * std::sin(2 * kPi / (4 * n)), exact * 1e-12);
    EXPECT_LT(mesh.volume(), exact);
    EXPECT_EQ(mesh.turnedCount(), 0);
    EXPECT_EQ(mesh.surface().size(), 2u * (2 * n * n + 4 * n * (n + 1)));
    EXPECT_LT(norm(centreOfVolume(mesh)), 1e-14);
    const auto zBelow = [](const Vec3& a, const Vec3& b) { return a.z < b.z; };
    EXPECT_EQ(std::min_element(mesh.restPositions().begin(), mesh.restPositions().end(), zBelow)->z, -1);
    EXPECT_EQ(std::max_element(mesh.restPositions().begin(), mesh.restPositions().end(), zBelow)->z, 1);
    EXPECT_GT(leastQuality(makeCylinder(0.5, 1, n, n)), 0.025);  // cells about as high as wide
}

INSTANTIATE_TEST_SUITE_P(Cells, RoundMesh, testing::Values(2, 4, 6, 8, 12, 20),
                         [](const auto& suite) { return std::to_string(suite.param); });

TEST(GeneratorInput, RejectsInvalidBoxes)
{
    expectRejected([] { makeBox({0, 1, 1}, {1, 1, 1}); }, {"along x is 0 m", "(0, inf)", "positive"});
    expectRejected([] { makeBox({1, -2, 1}, {1, 1, 1}); }, {"along y is -2 m"});
    expectRejected([] { makeBox({1, 1, kNaN}, {1, 1, 1}); }, {"along z is nan"});
    expectRejected([] { makeBox({1, 1, 1}, {0, 1, 1}); }, {"along x is 0", "[1, 1000]"});
    expectRejected([] { makeBox({1, 1, 1}, {1, 1001, 1}); }, {"along y is 1001", "[1, 1000]"});
    expectRejected([] { makeBox({1, 1, 1}, {1, 1, -3}); }, {"along z is -3", "[1, 1000]"});
    expectRejected([] { makeBox({1, 1, 1}, {1, 1, 1}, {0, kNaN, 0}); }, {"origin", "nan", "finite corner"});
    expectRejected(
        [] {
            makeBox({1, 1, 1}, {1000, 1000, 1000});
        },
        {"1000 x 1000 x 1000", "5000000000 elements", "[1, 5000000]", "larger cells"});
}

TEST(GeneratorInput, RejectsInvalidBeams)
{
    expectRejected([] { makeBeam(0, 1, 1, 1); }, {"beam length is 0 m", "(0, inf)"});
    expectRejected([] { makeBeam(1, kNaN, 1, 1); }, {"beam width is nan m"});
    expectRejected([] { makeBeam(1, 1, -1, 1); }, {"beam height is -1 m"});
    expectRejected([] { makeBeam(1, 1, 1, 0); }, {"cell size is 0 m"});
    expectRejected([] { makeBeam(2, 1, 1, 1e-300); }, {"cell size is 1e-300 m", "[0.002, inf)", "larger cells"});
}

TEST(GeneratorInput, RejectsInvalidSpheres)
{
    expectRejected([] { makeSphere(0, 2); }, {"radius is 0 m"});
    expectRejected([] { makeSphere(std::numeric_limits<double>::infinity(), 2); }, {"radius is inf m"});
    expectRejected([] { makeSphere(1, 0); }, {"sphere is 0", "[2, 1000]"});
    expectRejected([] { makeSphere(1, {2, 3, 1}); }, {"sphere is 1", "[2, 1000]"});
    expectRejected([] { makeSphere(1, 1002); }, {"sphere is 1002", "[2, 1000]"});
    expectRejected([] { makeSphere(1, 1000); }, {"6000000000 elements", "[1, 5000000]"});
}

TEST(GeneratorInput, RejectsInvalidCylinders)
{
    expectRejected([] { makeCylinder(-1, 1, 2, 1); }, {"radius is -1 m"});
    expectRejected([] { makeCylinder(1, kNaN, 2, 1); }, {"height is nan m"});
    expectRejected([] { makeCylinder(1, 1, 3, 1); }, {"cylinder is 3", "even", "[2, 1000]"});
    expectRejected([] { makeCylinder(1, 1, 2, 0); }, {"cylinder is 0", "[1, 1000]"});
    expectRejected([] { makeCylinder(1, 1, 2, 1001); }, {"cylinder is 1001", "[1, 1000]"});
}

}  // namespace
}  // namespace bullet_fem
