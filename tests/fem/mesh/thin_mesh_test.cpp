// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/thin_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bullet_fem/fem/mesh/generators.h"
#include "fem/scenes/lattice_box.h"

namespace bullet_fem
{
namespace
{

// A box of cubes of six elements with those cubes for which isIn(i, j, k).
template <class IsIn>
TetMesh cubesWhere(const std::array<int, 3>& cells, const IsIn& isIn)
{
    const TetMesh box = makeBox({1. * cells[0], 1. * cells[1], 1. * cells[2]}, cells, {}, CellSplit::kuhnSix);
    std::vector<Tet> tets;
    for (const Tet& tet : box.tets())
    {
        Vec3 middle;
        for (const int node : tet) middle += .25 * box.restPositions()[node];
        if (isIn(static_cast<int>(middle.x), static_cast<int>(middle.y), static_cast<int>(middle.z)))
            tets.push_back(tet);
    }
    return {box.restPositions(), tets, LooseNodes::kept};
}

TEST(ThinMesh, BarsOfFewerThanFourCellsAreThin)
{
    for (const CellSplit split : {CellSplit::alternatingFive, CellSplit::kuhnSix})
        for (const int n : {1, 2, 3, 4, 5, 8})
        {
            SCOPED_TRACE(n);
            EXPECT_EQ(isThinSomewhere(makeBox({10, 1, 1}, {10 * n, n, n}, {}, split)), n < 4);
            EXPECT_EQ(isThinSomewhere(makeBox({8, 8, 1}, {16, 16, n}, {}, split)), n < 4);
            EXPECT_EQ(isThinSomewhere(shuffledMesh(makeBox({8, 1, 1}, {8 * n, n, n}, {}, split), .15, 1)), n < 4);
        }
}

// Cells 8 times as long as thick, and 8 times as thick as long.
TEST(ThinMesh, SizesOfCellsDoNotMatter)
{
    for (const double thickness : {1. / 8, 8.})
    {
        EXPECT_TRUE(isThinSomewhere(makeBox({6, 6, 3 * thickness}, {6, 6, 3})));
        EXPECT_FALSE(isThinSomewhere(makeBox({6, 6, 4 * thickness}, {6, 6, 4})));
    }
}

// The centres of cells are nodes between the corners.
TEST(ThinMesh, ThreeCellsOfALatticeAreNotThin)
{
    for (const int n : {1, 2, 3, 4}) EXPECT_EQ(isThinSomewhere(makeLatticeBox({10 * n, n, n}, 1. / n)), n < 3) << n;
}

TEST(ThinMesh, BallsAndCylindersOfFourCellsAreNotThin)
{
    for (const int n : {2, 3, 4, 5, 6})
    {
        EXPECT_EQ(isThinSomewhere(makeSphere(1, n)), n < 4) << n;
        if (n % 2 == 0)
        {
            EXPECT_EQ(isThinSomewhere(makeCylinder(1, 3, n, 2 * n)), n < 4) << n;
        }
    }
}

// Corners and edges of a thick body have no node two edges inside near them.
TEST(ThinMesh, CornersAndEdgesAreNotThin)
{
    const auto all = [](int, int, int) { return true; };
    EXPECT_FALSE(isThinSomewhere(cubesWhere({4, 4, 4}, all)));
    // An L, and a groove with four cells below.
    EXPECT_FALSE(isThinSomewhere(cubesWhere({12, 12, 4}, [](int i, int j, int) { return i < 4 || j < 4; })));
    EXPECT_FALSE(isThinSomewhere(cubesWhere({12, 6, 8}, [](int i, int, int k) { return i < 4 || i >= 8 || k < 4; })));
}

// Fins on a block of eight cells: kThinReach.
TEST(ThinMesh, FinsAreThinIfTheyAreLongerThanThick)
{
    const auto fin = [](int cells, int length)
    {
        const auto isIn = [cells](int i, int, int k) { return i < 8 || (k > 1 && k < 2 + cells); };
        return cubesWhere({8 + length, 8, 8}, isIn);
    };
    EXPECT_FALSE(isThinSomewhere(fin(1, 1)));
    EXPECT_TRUE(isThinSomewhere(fin(1, 2)));
    EXPECT_FALSE(isThinSomewhere(fin(3, 3)));
    EXPECT_TRUE(isThinSomewhere(fin(3, 4)));
    EXPECT_FALSE(isThinSomewhere(fin(4, 8)));
}

TEST(ThinMesh, EveryPartIsJudged)
{
    // A plate two cells above a block, not connected with it; without the plate its nodes belong to no element.
    const auto isBlock = [](int, int, int k) { return k < 5; };
    const auto isEither = [](int, int, int k) { return k < 5 || k == 7; };
    EXPECT_FALSE(isThinSomewhere(cubesWhere({6, 6, 8}, isBlock)));
    EXPECT_TRUE(isThinSomewhere(cubesWhere({6, 6, 8}, isEither)));
}

TEST(ThinMesh, SheetsAndSingleElementsAreThin)
{
    EXPECT_TRUE(isThinSomewhere(makeBox({1, 1, .01}, {40, 40, 1})));
    EXPECT_TRUE(isThinSomewhere(TetMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}})));
}

// Any order of elements and nodes gives the same choice.
TEST(ThinMesh, OrderOfElementsDoesNotMatter)
{
    for (const int length : {3, 4})
    {
        const TetMesh mesh =
            cubesWhere({8 + length, 8, 8}, [](int i, int, int k) { return i < 8 || (k > 2 && k < 6); });
        std::vector<Tet> tets(mesh.tets().rbegin(), mesh.tets().rend());
        for (Tet& tet : tets) std::rotate(tet.begin(), tet.begin() + 1, tet.end() - 1);  // keeps the orientation
        EXPECT_EQ(isThinSomewhere(TetMesh(mesh.restPositions(), tets, LooseNodes::kept)), length == 4);
    }
}

}  // namespace
}  // namespace bullet_fem
