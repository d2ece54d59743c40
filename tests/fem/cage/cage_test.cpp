// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/cage.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fem/scenes/test_constants.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

double filledVolume(const Cage& cage)
{
    double sum = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
        sum += cage.m_massScale * cage.m_filled[e] * cage.m_mesh.tetVolume(e);
    return sum;
}

/// Invariants of each cage, for any surface.
void expectPromises(const Cage& cage, const SurfaceMesh& surface, const CageSettings& settings)
{
    EXPECT_EQ(cage.m_mesh.turnedCount(), 0);
    ASSERT_EQ(cage.m_filled.size(), static_cast<std::size_t>(cage.m_mesh.tetCount()));
    EXPECT_GE(*std::min_element(cage.m_filled.begin(), cage.m_filled.end()), settings.m_fillFloor);
    EXPECT_LE(*std::max_element(cage.m_filled.begin(), cage.m_filled.end()), 1);
    EXPECT_NEAR(filledVolume(cage), cage.m_report.m_surfaceVolume,
                1e-11 * cage.m_report.m_surfaceVolume);  // sums of some 1e4 terms

    ASSERT_EQ(cage.m_embedding.size(), surface.m_vertices.size());
    double worst = 0, minWeight = 1;
    for (std::size_t i = 0; i < surface.m_vertices.size(); ++i)
    {
        Vec3 p;
        for (int a = 0; a < 4; ++a)
        {
            const Embedding& at = cage.m_embedding[i];
            p += cage.m_mesh.restPositions()[cage.m_mesh.tets()[at.m_tet][a]] * at.m_weights[a];
            minWeight = std::min(minWeight, at.m_weights[a]);
        }
        worst = std::max(worst, norm(p - surface.m_vertices[i]));
    }
    EXPECT_LT(worst, 1e-12 * settings.m_cellSize);  // surfaces here lie within a few hundred cells of the origin
    EXPECT_GE(minWeight, -1e-9);
}

TEST(SignedVolume, MatchesHandValuesAlsoFarFromTheOrigin)
{
    EXPECT_NEAR(signedVolume(boxSurface({1, 2, 3}, {3, 5, 7})), 24, 24e-14);
    EXPECT_NEAR(signedVolume(flipped(boxSurface({1, 2, 3}, {3, 5, 7}))), -24, 24e-14);
    EXPECT_NEAR(signedVolume(boxSurface({1e6, 1e6, 1e6}, {1e6 + 1, 1e6 + 1, 1e6 + 1})), 1, 1e-9);
    EXPECT_EQ(signedVolume(SurfaceMesh()), 0);
}

TEST(Cage, AlignedBoxGivesTheBox)
{
    const SurfaceMesh surface = boxSurface({-1, 0, 2}, {1, 1.5, 3});
    const CageSettings settings = withCell(0.25);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_EQ(cage.m_mesh.tetCount(), 8 * 6 * 4 * 5);
    EXPECT_EQ(cage.m_mesh.nodeCount(), 9 * 7 * 5);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, 3, 3e-14);
    EXPECT_NEAR(cage.m_massScale, 1, 1e-12);
    EXPECT_EQ(*std::min_element(cage.m_filled.begin(), cage.m_filled.end()), 1);  // no element is cut
    EXPECT_FALSE(cage.m_report.m_insideOut);
    EXPECT_FALSE(cage.m_report.m_selfIntersecting);
    EXPECT_EQ(cage.m_report.m_openEdges, 0);
}

// The notch's faces coincide with faces of lattice cubes: the cubes beyond are in contact, but empty.
TEST(Cage, AlignedAngleLeavesItsNotchEmpty)
{
    SurfaceMesh surface;  // (0,0) (2,0) (2,1) (1,1) (1,2) (0,2), from z = 0 to 1
    for (const double z : {0, 1})
        surface.m_vertices.insert(surface.m_vertices.end(),
                                  {{0, 0, z}, {2, 0, z}, {2, 1, z}, {1, 1, z}, {1, 2, z}, {0, 2, z}});
    for (const Triangle& t : {Triangle{0, 1, 3}, Triangle{1, 2, 3}, Triangle{0, 3, 5}, Triangle{3, 4, 5}})
        surface.m_triangles.insert(surface.m_triangles.end(), {{t[0], t[2], t[1]}, {t[0] + 6, t[1] + 6, t[2] + 6}});
    for (int i = 0; i < 6; ++i)
    {
        const int j = (i + 1) % 6;
        surface.m_triangles.insert(surface.m_triangles.end(), {{i, j, j + 6}, {i, j + 6, i + 6}});
    }
    const CageSettings settings = withCell(0.25);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_EQ(cage.m_report.m_openEdges, 0);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, 3, 3e-14);
    EXPECT_EQ(cage.m_mesh.tetCount(), 3 * 4 * 4 * 4 * 5);
    EXPECT_NEAR(cage.m_massScale, 1, 1e-12);
}

TEST(Cage, IsCentredOnTheBoundingBox)
{
    const SurfaceMesh surface = boxSurface({10, 20, 30}, {11, 21, 31});
    const CageSettings settings = withCell(0.3);  // four cubes, 0.1 m of overhang on either side
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_EQ(cage.m_mesh.tetCount(), 4 * 4 * 4 * 5);
    EXPECT_NEAR(cage.m_mesh.restPositions().front().x, 9.9, 1e-12);
    EXPECT_NEAR(cage.m_mesh.restPositions().back().z, 31.1, 1e-12);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, 1, 1e-12);
}

// Filled fractions of a half space in closed form: the box's top cuts the upper layer of cubes at 3/5 of its height.
TEST(Cage, MeasuresFilledFractions)
{
    const SurfaceMesh surface = boxSurface({0, 0, 0}, {4, 4, 1.2});
    CageSettings settings = withCell(1);
    settings.m_fillSamples = 4096;
    settings.m_fillFloor = 0.05;
    const Cage cage = makeCage(surface, settings);  // two layers, z from -0.4 to 1.6
    expectPromises(cage, surface, settings);
    ASSERT_EQ(cage.m_mesh.tetCount(), 4 * 4 * 2 * 5);
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
    {
        // The share of a cube's tets within 0.6 of the layer's inner side: 1 - 0.4^3 of a corner tet with its base
        // there, 0.6^3 of one with its tip there, and for the middle tet the rest of 0.6.
        const double corner = 1 - 0.4 * 0.4 * 0.4, tip = 0.6 * 0.6 * 0.6, middle = 3 * (0.6 - (corner + tip) / 3);
        const double filled = cage.m_filled[e];
        // 4096 low-discrepancy samples: half the deviation of random ones, 0.008.
        EXPECT_LT(std::min({std::abs(filled - corner), std::abs(filled - tip), std::abs(filled - middle)}), 0.004) << e;
    }
    EXPECT_NEAR(cage.m_massScale, 1, 0.002);
}

struct CellsAcross
{
    int m_cells;
    double m_volumeTolerance;  // of the mass scale: the fill floor's share falls with the cell size
};

class CageOfSphere : public testing::TestWithParam<CellsAcross>
{
};

TEST_P(CageOfSphere, HoldsItsVolume)
{
    const SurfaceMesh surface = sphereSurface(0.5, {1, 2, 3}, 4);
    CageSettings settings = withCell(1.0 / GetParam().m_cells);
    settings.m_fillFloor = 0.05;  // so that samples dominate the floor
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, signedVolume(surface), 1e-14);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, kPi / 6, 0.004 * kPi / 6);
    EXPECT_NEAR(cage.m_massScale, 1, GetParam().m_volumeTolerance);
    EXPECT_GT(cage.m_mesh.volume(), cage.m_report.m_surfaceVolume);
    EXPECT_EQ(cage.m_mesh.componentCount(), 1);
}

INSTANTIATE_TEST_SUITE_P(Cells, CageOfSphere,
                         testing::Values(CellsAcross{1, 0.05}, CellsAcross{3, 0.03}, CellsAcross{8, 0.02},
                                         CellsAcross{17, 0.01}),
                         [](const auto& suite) { return std::to_string(suite.param.m_cells); });

TEST(Cage, LeavesTheHoleOfATorusFree)
{
    const SurfaceMesh surface = torusSurface(1, 0.3, 64);
    const CageSettings settings = withCell(0.1);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, signedVolume(surface), 1e-13);
    for (const Vec3& X : cage.m_mesh.restPositions()) EXPECT_GT(std::hypot(X.x, X.y), 0.7 - 0.1 * std::sqrt(3.0));
}

TEST(Cage, KeepsACavityEmpty)
{
    const SurfaceMesh surface = joined(sphereSurface(1, {}, 3), flipped(sphereSurface(0.6, {}, 3)));
    const CageSettings settings = withCell(0.1);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_FALSE(cage.m_report.m_selfIntersecting);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, signedVolume(surface), 1e-13);
    for (const Vec3& X : cage.m_mesh.restPositions()) EXPECT_GT(norm(X), 0.4);
}

TEST(Cage, AcceptsAnInvertedSurface)
{
    const SurfaceMesh outward = sphereSurface(1, {}, 3), inward = flipped(outward);
    const CageSettings settings = withCell(0.2);
    const Cage expected = makeCage(outward, settings), cage = makeCage(inward, settings);
    expectPromises(cage, inward, settings);
    EXPECT_TRUE(cage.m_report.m_insideOut);
    EXPECT_FALSE(cage.m_report.m_selfIntersecting);
    EXPECT_EQ(cage.m_mesh.tets(), expected.m_mesh.tets());
    EXPECT_EQ(cage.m_filled, expected.m_filled);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, expected.m_report.m_surfaceVolume, 1e-14);
}

TEST(Cage, CountsOverlapsOnce)
{
    // Unit spheres 1 apart: the lens has volume pi (4 + d) (2 - d)^2 / 12 with d = 1.
    const SurfaceMesh surface = joined(sphereSurface(1, {}, 4), sphereSurface(1, {1, 0, 0}, 4));
    const CageSettings settings = withCell(0.1);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_TRUE(cage.m_report.m_selfIntersecting);
    EXPECT_EQ(cage.m_report.m_openEdges, 0);
    const double both = 8.0 / 3 * kPi - 5.0 / 12 * kPi;
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, both, 0.005 * both);  // facets lose 0.2 %, sampling less
}

TEST(Cage, CountsComponentsOfBothOrientations)
{
    const SurfaceMesh surface = joined(sphereSurface(1, {}, 3), flipped(sphereSurface(0.5, {3, 0, 0}, 3)));
    const CageSettings settings = withCell(0.1);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_TRUE(cage.m_report.m_selfIntersecting);
    EXPECT_FALSE(cage.m_report.m_insideOut);
    EXPECT_EQ(cage.m_mesh.componentCount(), 2);
    const double both = 4.0 / 3 * kPi * 1.125;
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, both, 0.015 * both);  // facets lose 0.8 %
}

TEST(Cage, ClosesSmallHoles)
{
    const SurfaceMesh closed = sphereSurface(1, {}, 3);
    const SurfaceMesh surface = without(closed, 100, 104);  // one triangle of the level before
    const CageSettings settings = withCell(0.1);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_EQ(cage.m_report.m_openEdges, 6);
    EXPECT_FALSE(cage.m_report.m_insideOut);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, signedVolume(closed), 0.005 * signedVolume(closed));
}

TEST(Cage, ClosesAnOpenBox)
{
    const SurfaceMesh surface = without(boxSurface({0, 0, 0}, {1, 1, 1}), 0, 2);
    const CageSettings settings = withCell(0.1);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_EQ(cage.m_report.m_openEdges, 4);
    // A flat hole is closed by its plane: from there the missing face covers half of the solid angle.
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, 1, 1e-10);  // a sum of 320,000 samples
    EXPECT_EQ(cage.m_mesh.tetCount(), 10 * 10 * 10 * 5);
}

TEST(Cage, WeldsCoincidentVertices)
{
    const SurfaceMesh shared = sphereSurface(1, {}, 2);
    SurfaceMesh soup;
    for (const Triangle& t : shared.m_triangles)
    {
        const int n = static_cast<int>(soup.m_vertices.size());
        for (const int i : t) soup.m_vertices.push_back(shared.m_vertices[i]);
        soup.m_triangles.push_back({n, n + 1, n + 2});
    }
    const CageSettings settings = withCell(0.25);
    const Cage cage = makeCage(soup, settings);
    expectPromises(cage, soup, settings);
    EXPECT_EQ(cage.m_report.m_openEdges, 0);
    EXPECT_EQ(cage.m_mesh.tets(), makeCage(shared, settings).m_mesh.tets());
}

TEST(Cage, HoldsAPlateThinnerThanACell)
{
    const SurfaceMesh surface = boxSurface({0, 0, 0}, {1, 1, 0.001});
    const CageSettings settings = withCell(0.2);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, 0.001, 1e-15);
    EXPECT_EQ(cage.m_mesh.tetCount(), 5 * 5 * 5);  // the plate enters every element of its layer
    EXPECT_EQ(cage.m_mesh.componentCount(), 1);
}

TEST(Cage, HoldsAFinWithoutThickness)
{
    // Both sides of a square fin on a box, in a plane of the lattice: it enters no element.
    SurfaceMesh fin;
    fin.m_vertices = {{1, 0, 0.5}, {2, 0, 0.5}, {2, 1, 0.5}, {1, 1, 0.5}};
    fin.m_triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
    const SurfaceMesh surface = joined(boxSurface({0, 0, 0}, {1, 1, 1}), fin);
    const CageSettings settings = withCell(0.25);
    const Cage cage = makeCage(surface, settings);
    expectPromises(cage, surface, settings);
    EXPECT_NEAR(cage.m_report.m_surfaceVolume, 1, 1e-14);
    EXPECT_EQ(cage.m_mesh.tetCount(), 4 * 4 * 4 * 5 + 2);  // one element for each of the far vertices
}

TEST(Cage, EmbedsUnusedVertices)
{
    SurfaceMesh surface = sphereSurface(1, {}, 2);
    surface.m_vertices.push_back({50, -20, 30});
    const Cage cage = makeCage(surface, withCell(0.5));
    const Embedding& at = cage.m_embedding.back();
    Vec3 p;
    for (int a = 0; a < 4; ++a) p += cage.m_mesh.restPositions()[cage.m_mesh.tets()[at.m_tet][a]] * at.m_weights[a];
    EXPECT_LT(norm(p - surface.m_vertices.back()), 1e-11);
    EXPECT_EQ(cage.m_mesh.tets(), makeCage(sphereSurface(1, {}, 2), withCell(0.5)).m_mesh.tets());
}

TEST(Cage, IsTheSameOnEveryCallAndAtEveryScale)
{
    const SurfaceMesh surface = torusSurface(1, 0.4, 48);
    SurfaceMesh larger = surface;
    for (Vec3& x : larger.m_vertices) x *= 1024;
    const Cage a = makeCage(surface, withCell(0.25)), b = makeCage(surface, withCell(0.25));
    const Cage c = makeCage(larger, withCell(256));  // powers of two keep the rounding
    EXPECT_EQ(a.m_filled, b.m_filled);
    EXPECT_EQ(a.m_mesh.tets(), b.m_mesh.tets());
    EXPECT_EQ(a.m_filled, c.m_filled);
    EXPECT_EQ(a.m_massScale, b.m_massScale);
}

}  // namespace
}  // namespace bullet_fem
