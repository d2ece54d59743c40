// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/bisected_tets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "bullet_fem/fem/cage/cage_report.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kMax = 1000000;

std::vector<int> leavesOf(const BisectedTets& tets)
{
    std::vector<int> leaves;
    for (std::size_t t = 0; t < tets.tets().size(); ++t)
        if (tets.tets()[t].m_child == 0) leaves.push_back(static_cast<int>(t));
    return leaves;
}

/// A lattice of 3 x 4 x 2 cubes without two at its boundary.
BisectedTets lattice()
{
    BisectedTets tets({3, 4, 2});
    for (int cube = 0; cube < 24; ++cube)
        if (cube != 7 && cube != 13) tets.addCube(cube, false);
    return tets;
}

/// Bisects random leaves, up to four levels.
void halveAtRandom(BisectedTets& tets)
{
    unsigned seed = 1;
    for (int round = 0; round < 30; ++round)
    {
        std::vector<char> marks(tets.tets().size(), 0);
        for (std::size_t t = 0; t < marks.size(); ++t)
        {
            seed = 1664525u * seed + 1013904223u;
            marks[t] = (seed >> 16) % 40 == 0 && tets.tets()[t].m_generation < 12;
        }
        ASSERT_TRUE(tets.halve(marks, kMax));
        EXPECT_EQ(marks, std::vector<char>(tets.tets().size(), 0));
    }
}

// A hanging node would leave faces with only one tetrahedron inside the lattice.
TEST(BisectedTets, ShareTheirSides)
{
    BisectedTets tets = lattice();
    halveAtRandom(tets);
    std::map<std::array<int, 3>, int> users;
    const std::vector<int> leaves = leavesOf(tets);
    EXPECT_GT(leaves.size(), 20000u);
    for (const int leaf : leaves)
        for (int a = 0; a < 4; ++a)
        {
            const Tet& t = tets.tets()[leaf].m_corners;
            std::array<int, 3> side = {t[(a + 1) % 4], t[(a + 2) % 4], t[(a + 3) % 4]};
            std::sort(side.begin(), side.end());
            ++users[side];
        }
    double boundary = 0;
    for (const auto& [side, count] : users)
    {
        ASSERT_LE(count, 2);
        const Vec3 &a = tets.nodes()[side[0]], &b = tets.nodes()[side[1]], &c = tets.nodes()[side[2]];
        if (count == 1) boundary += 0.5 * norm(cross(b - a, c - a));
    }
    EXPECT_NEAR(boundary, 52 + 4 + 2, 1e-9);  // the box's, and that of two missing cubes: one open face, and two
}

TEST(BisectedTets, HaveThreeShapes)
{
    BisectedTets tets = lattice();
    halveAtRandom(tets);
    std::map<int, int> shapes;  // by the mean ratio in units of 1 / 10,000
    double volume = 0;
    for (const int leaf : leavesOf(tets))
    {
        const std::array<Vec3, 4> x = tets.corners(leaf);
        ++shapes[static_cast<int>(std::floor(1e4 * meanRatio(x) + 1e-6))];
        const double leafVolume = dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
        ASSERT_NEAR(leafVolume, tets.volume(leaf), 1e-15);
        volume += leafVolume;
    }
    EXPECT_NEAR(volume, 22, 1e-9);
    ASSERT_EQ(shapes.size(), 3u);
    EXPECT_EQ(shapes.count(7559), 1u);
    EXPECT_EQ(shapes.count(7619), 1u);
    EXPECT_EQ(shapes.count(8000), 1u);
}

TEST(BisectedTets, StopBisectionAtTheElementLimit)
{
    BisectedTets tets = lattice();
    std::vector<char> marks(tets.tets().size(), 1);
    EXPECT_FALSE(tets.halve(marks, tets.tets().size() + 10));
}

TEST(BisectedTets, KnowTheirCubes)
{
    const BisectedTets tets = lattice();
    EXPECT_EQ(tets.rootCount(), 6 * 22);
    EXPECT_EQ(tets.firstOf({0, 0, 0}), 0);
    EXPECT_EQ(tets.firstOf({1, 2, 0}), -1);
    EXPECT_EQ(tets.firstOf({2, 2, 0}), 6 * 7);
    EXPECT_EQ(tets.firstOf({2, 3, 1}), 6 * 21);
}

}  // namespace
}  // namespace bullet_fem
