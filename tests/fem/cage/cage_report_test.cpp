// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/cage_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "bullet_fem/fem/cage/cage.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

TEST(MeanRatio, MatchesHandValues)
{
    const std::array<Vec3, 4> regular = {Vec3{0, 0, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};
    EXPECT_NEAR(std::abs(meanRatio(regular)), 1, 1e-15);
    const std::array<Vec3, 4> corner = {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_NEAR(meanRatio(corner), 12 * std::cbrt(0.25) / 9, 1e-15);  // 3 V = 1/2, edges 3 of 1 and 3 of sqrt 2
    EXPECT_NEAR(meanRatio({corner[0], corner[2], corner[1], corner[3]}), -12 * std::cbrt(0.25) / 9, 1e-15);
    EXPECT_EQ(meanRatio({corner[0], corner[1], corner[2], Vec3{2, 2, 0}}), 0);
    EXPECT_EQ(meanRatio({corner[0], corner[0], corner[0], corner[0]}), 0);
}

TEST(CageReport, MatchesAnAlignedBox)
{
    const CageReport report = makeCage(boxSurface({-1, 0, 2}, {1, 1.5, 3}), withCell(0.25)).m_report;
    EXPECT_EQ(report.m_tets, 8 * 6 * 4 * 5);
    EXPECT_EQ(report.m_nodes, 9 * 7 * 5);
    EXPECT_EQ(report.m_cellSize, 0.25);
    EXPECT_EQ(report.m_qualityHistogram[8], 8 * 6 * 4 * 4);  // the corner tets of the cubes
    EXPECT_EQ(report.m_qualityHistogram[9], 8 * 6 * 4);      // the middle ones
    EXPECT_GE(report.m_leastQuality, report.m_qualityBound);
    EXPECT_NEAR(report.m_leastQuality, report.m_qualityBound, 1e-4);
    EXPECT_NEAR(report.m_surfaceVolume, 3, 3e-14);
    EXPECT_NEAR(report.m_volumeRatio, 1, 1e-12);
    EXPECT_TRUE(report.m_volumeIsExact);
    EXPECT_EQ(report.m_pieces, 1);
    EXPECT_EQ(report.m_openShare, 0);
    EXPECT_EQ(report.m_duplicates + report.m_degenerate + report.m_turned, 0);
    EXPECT_NE(describe(report).find("960 tets, 315 nodes, cells of 0.25 m"), std::string::npos) << describe(report);
}

TEST(CageReport, CountsHolesAndComponents)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 3);
    const CageReport report =
        makeCage(joined(without(ball, 100, 104), sphereSurface(1, {4, 0, 0}, 2)), withCell(0.2)).m_report;
    EXPECT_EQ(report.m_pieces, 2);
    EXPECT_EQ(report.m_openEdges, 6);
    EXPECT_NEAR(report.m_openShare, 6.0 / (1920 - 3 + 480), 1e-12);  // the four triangles shared three edges
    EXPECT_FALSE(report.m_volumeIsExact);
    EXPECT_NE(describe(report).find("2 pieces, 6 open edges (0.25"), std::string::npos) << describe(report);
}

TEST(CageReport, TurnsTrianglesThatDisagree)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 3);
    const Cage expected = makeCage(ball, withCell(0.2));
    SurfaceMesh shuffled = ball;
    for (std::size_t t = 0; t < shuffled.m_triangles.size(); t += 3)
        std::swap(shuffled.m_triangles[t][0], shuffled.m_triangles[t][1]);
    const Cage cage = makeCage(shuffled, withCell(0.2));
    EXPECT_EQ(cage.m_report.m_turned, 427);  // a third of 1280
    EXPECT_FALSE(cage.m_report.m_insideOut);
    EXPECT_EQ(cage.m_report.m_openEdges, 0);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, signedVolume(ball), 1e-13);
    EXPECT_EQ(cage.m_mesh.tets(), expected.m_mesh.tets());
}

// The majority's orientation is kept, even if it points inwards: a cavity stays a cavity.
TEST(CageReport, OrientsTheMinorityToTheMajority)
{
    SurfaceMesh cavity = flipped(sphereSurface(0.6, {}, 2));
    std::swap(cavity.m_triangles[5][0], cavity.m_triangles[5][1]);
    const SurfaceMesh outer = sphereSurface(1, {}, 3);
    const CageReport report = makeCage(joined(outer, cavity), withCell(0.2)).m_report;
    EXPECT_EQ(report.m_turned, 1);
    EXPECT_FALSE(report.m_selfIntersecting);
    EXPECT_NEAR(report.m_surfaceVolume, signedVolume(outer) - signedVolume(sphereSurface(0.6, {}, 2)), 1e-13);
}

TEST(CageReport, LeavesDuplicatesOutAndCountsTrianglesWithoutArea)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 2);
    SurfaceMesh doubled = joined(ball, ball);  // each triangle twice, with vertices of its own
    doubled.m_triangles.push_back({7, 7, 9});
    const Cage cage = makeCage(doubled, withCell(0.25));
    EXPECT_EQ(cage.m_report.m_duplicates, 320);
    EXPECT_EQ(cage.m_report.m_degenerate, 1);
    EXPECT_FALSE(cage.m_report.m_selfIntersecting);
    EXPECT_EQ(cage.m_report.m_openEdges, 0);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, signedVolume(ball), 1e-13);
    for (std::size_t i = 0; i < ball.m_vertices.size(); ++i)  // the second copies are connected as the first ones
        EXPECT_EQ(cage.m_embedding[i].m_weights, cage.m_embedding[i + ball.m_vertices.size()].m_weights);
}

TEST(CageReport, ElementCountIsNearTheTarget)
{
    const SurfaceMesh surfaces[] = {boxSurface({0, 0, 0}, {3, 1, 1}), sphereSurface(1, {5, 0, 0}, 3),
                                    torusSurface(1, 0.2, 24), boxSurface({0, 0, 0}, {1, 1, 0.01}),
                                    without(boxSurface({0, 0, 0}, {1, 1, 1}), 0, 4)};
    CageSettings settings;
    settings.m_fillSamples = 8;
    for (const SurfaceMesh& surface : surfaces)
        for (const int target : {300, 2000})
        {
            settings.m_targetTets = target;
            EXPECT_NEAR(makeCage(surface, settings).m_report.m_tets, target, 0.2 * target);
        }
    settings.m_targetTets = 5;
    EXPECT_EQ(makeCage(sphereSurface(1, {}, 2), settings).m_report.m_tets, 5);
}

TEST(CageReport, FoundCellSizeGivesTheSameCage)
{
    const SurfaceMesh surface = sphereSurface(1, {5, 0, 0}, 2);
    CageSettings settings;
    settings.m_targetTets = 400;
    const Cage cage = makeCage(surface, settings);
    EXPECT_EQ(makeCage(surface, settings).m_filled, cage.m_filled);
    EXPECT_EQ(makeCage(surface, withCell(cage.m_report.m_cellSize)).m_filled, cage.m_filled);
}

}  // namespace
}  // namespace bullet_fem
