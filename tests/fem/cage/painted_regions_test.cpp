// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/painted_regions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

Vec3 middleOfPainted(const TetMesh& mesh, int e)
{
    Vec3 sum;
    for (const int node : mesh.tets()[e]) sum += 0.25 * mesh.restPositions()[node];
    return sum;
}

SurfaceMesh pointsIn(const std::vector<int>& tets, const std::vector<int>& labels, std::vector<Embedding>& embedding)
{
    SurfaceMesh surface;
    surface.m_vertices.resize(tets.size());
    surface.m_labels = labels;
    for (const int tet : tets) embedding.push_back({tet, {.25, .25, .25, .25}});
    return surface;
}

TEST(CagePaintedRegions, AreThoseOfMostVerticesAndOfTheLowestLabelOfSeveral)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    std::vector<Embedding> embedding;
    const SurfaceMesh surface = pointsIn({0, 0, 0, 1, 1, 2, 3, 4}, {9, 5, 9, 8, -1, 7, 7, 7}, embedding);
    EXPECT_EQ(paintedRegions(mesh, surface, embedding), (std::vector<int>{9, -1, 7, 7, 7}));
}

// Two legs of 10 m, .1 m apart, joined at their feet: one is painted at its top, the other at its foot.
TEST(CagePaintedRegions, ComeThroughTheMeshAndNotAcrossAGap)
{
    const TetMesh block = makeBox({1.1, 1, 10}, {11, 2, 20});
    std::vector<Tet> tets;
    for (int e = 0; e < block.tetCount(); ++e)
    {
        const Vec3 x = middleOfPainted(block, e);
        if (x.z < 1 || x.x < .5 || x.x > .6) tets.push_back(block.tets()[e]);
    }
    std::vector<int> number(block.nodeCount(), -1);
    std::vector<Vec3> X;
    for (Tet& tet : tets)
        for (int& node : tet)
        {
            if (number[node] < 0)
            {
                number[node] = static_cast<int>(X.size());
                X.push_back(block.restPositions()[node]);
            }
            node = number[node];
        }
    const TetMesh legs(X, tets);
    const auto elementAt = [&](const Vec3& x)
    {
        int best = 0;
        for (int e = 0; e < legs.tetCount(); ++e)
            if (norm(middleOfPainted(legs, e) - x) < norm(middleOfPainted(legs, best) - x)) best = e;
        return best;
    };
    std::vector<Embedding> embedding;
    const SurfaceMesh surface = pointsIn({elementAt({.25, .5, 10}), elementAt({.85, .5, 0})}, {1, 2}, embedding);
    const std::vector<int> regions = paintedRegions(legs, surface, embedding);
    EXPECT_EQ(regions[elementAt({.45, .5, 9.5})], 1);
    EXPECT_EQ(regions[elementAt({.65, .5, 9.5})], 2);  // .2 m from the first paint, 9 m from the other
    EXPECT_EQ(regions[elementAt({.25, .5, 7})], 1);
    EXPECT_EQ(regions[elementAt({.25, .5, 3})], 2);
}

// A ball with its halves painted in two colours: inner elements follow the surface.
TEST(CagePaintedRegions, FollowTheSurfaceOfACage)
{
    SurfaceMesh ball = sphereSurface(1, {0, 0, 0}, 3);
    const CageSettings settings = withCell(.2);
    EXPECT_TRUE(makeCage(ball, settings).m_report.m_regions.empty());
    for (const Vec3& x : ball.m_vertices) ball.m_labels.push_back(x.x < 0 ? 0xFF0000 : 0x0000FF);
    const Cage cage = makeCage(ball, settings);
    const std::vector<int>& regions = cage.m_report.m_regions;
    ASSERT_EQ(static_cast<int>(regions.size()), cage.m_mesh.tetCount());
    double red = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
    {
        const double x = middleOfPainted(cage.m_mesh, e).x;
        if (regions[e] == 0xFF0000) red += cage.m_mesh.tetVolume(e);
        EXPECT_TRUE(std::fabs(x) < .25 || regions[e] == (x < 0 ? 0xFF0000 : 0x0000FF)) << x;
    }
    EXPECT_NEAR(red / cage.m_mesh.volume(), .5, .05);
}

TEST(CagePaintedRegions, NeedALabelForEveryVertex)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    std::vector<Embedding> embedding;
    SurfaceMesh surface = pointsIn({0, 1}, {}, embedding);
    EXPECT_TRUE(paintedRegions(mesh, surface, embedding).empty());
    surface.m_labels = {1};
    expectRejected([&] { paintedRegions(mesh, surface, embedding); }, {"1 labels", "has 2", "or no labels"});
    SurfaceMesh ball = sphereSurface(1, {0, 0, 0}, 1);
    ball.m_labels = {1, 2, 3};
    expectRejected([&] { makeCage(ball, withCell(.5)); }, {"3 labels", "42"});
}

}  // namespace
}  // namespace bullet_fem
