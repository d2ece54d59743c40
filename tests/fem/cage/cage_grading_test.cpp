// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/mesh/thin_mesh.h"
#include "fem/cage/triangle_overlap.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

CageSettings graded(double cellSize, double cellsAcross = 2, int maxLevels = 3)
{
    CageSettings settings = withCell(cellSize);
    settings.m_cellsAcross = cellsAcross;
    settings.m_mostLevels = maxLevels;
    settings.m_fillSamples = 16;
    return settings;
}

/// Rotates the surface about an oblique axis.
SurfaceMesh tilted(SurfaceMesh surface)
{
    const double c = std::cos(0.3), s = std::sin(0.3);
    for (Vec3& x : surface.m_vertices)
    {
        x = {c * x.x - s * x.z, x.y, s * x.x + c * x.z};
        x = {x.x, c * x.y - s * x.z, s * x.y + c * x.z};
    }
    return surface;
}

SurfaceMesh moved(SurfaceMesh surface, const Vec3& by)
{
    for (Vec3& x : surface.m_vertices) x += by;
    return surface;
}

/// A block of 1 m with a rod, 0.1 m thick and 0.8 m long, out of a side.
SurfaceMesh blockWithRod()
{
    return joined(boxSurface({0, 0, 0}, {1, 1, 1}), boxSurface({0.9, 0.45, 0.45}, {1.8, 0.55, 0.55}));
}

/// Two plates of 1 m, 0.1 m thick and 0.1 m apart.
SurfaceMesh twoPlates()
{
    return joined(boxSurface({0, 0, 0}, {1, 1, 0.1}), boxSurface({0, 0, 0.2}, {1, 1, 0.3}));
}

/// Edge of the cube whose volume is six times the element's [m].
double cellOf(const TetMesh& mesh, int e)
{
    return std::cbrt(6 * mesh.tetVolume(e));
}

std::array<Vec3, 4> cornersOf(const TetMesh& mesh, int e)
{
    const Tet& t = mesh.tets()[e];
    const std::vector<Vec3>& X = mesh.restPositions();
    return {X[t[0]], X[t[1]], X[t[2]], X[t[3]]};
}

/// Hanging nodes: those at the midpoint of an edge.
int hangingNodes(const Cage& cage)
{
    const std::vector<Vec3>& X = cage.m_mesh.restPositions();
    const double grid = 0.25 * cage.m_report.m_cellSize / 64;
    const auto place = [&](const Vec3& x)
    {
        const Vec3 u = (x - X[0]) * (1 / grid);
        return std::array<long long, 3>{std::llround(u.x), std::llround(u.y), std::llround(u.z)};
    };
    std::set<std::array<long long, 3>> nodes;
    for (const Vec3& x : X) nodes.insert(place(x));
    EXPECT_EQ(nodes.size(), X.size());
    int hanging = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
    {
        const std::array<Vec3, 4> x = cornersOf(cage.m_mesh, e);
        for (int a = 0; a < 4; ++a)
            for (int b = a + 1; b < 4; ++b) hanging += static_cast<int>(nodes.count(place(0.5 * (x[a] + x[b]))));
    }
    return hanging;
}

/// Invariants of each graded cage, for any surface.
void expectGradedPromises(const Cage& cage, const SurfaceMesh& surface, const CageSettings& settings)
{
    const CageReport& report = cage.m_report;
    EXPECT_EQ(cage.m_mesh.turnedCount(), 0);
    EXPECT_EQ(hangingNodes(cage), 0);
    EXPECT_EQ(report.m_qualityBound, 0.7559);
    EXPECT_GE(report.m_leastQuality, report.m_qualityBound);
    EXPECT_FALSE(piercesBoundary(cage, surface, 1e-7 * report.m_cellSize));
    double filled = 0, minWeight = 1, farthest = 0, smallest = 1e300, largest = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
    {
        filled += cage.m_massScale * cage.m_filled[e] * cage.m_mesh.tetVolume(e);
        smallest = std::min(smallest, cellOf(cage.m_mesh, e));
        largest = std::max(largest, cellOf(cage.m_mesh, e));
    }
    for (std::size_t i = 0; i < surface.m_vertices.size(); ++i)
    {
        Vec3 p;
        const Embedding& at = cage.m_embedding[i];
        for (int a = 0; a < 4; ++a)
        {
            p += cage.m_mesh.restPositions()[cage.m_mesh.tets()[at.m_tet][a]] * at.m_weights[a];
            minWeight = std::min(minWeight, at.m_weights[a]);
        }
        farthest = std::max(farthest, norm(p - surface.m_vertices[i]));
    }
    EXPECT_NEAR(filled, report.m_surfaceVolume, 1e-11 * report.m_surfaceVolume);
    EXPECT_NEAR(smallest, report.m_smallestCell, 1e-9 * smallest);
    EXPECT_NEAR(largest, report.m_largestCell, 1e-9 * largest);
    EXPECT_LE(report.m_levels, settings.m_mostLevels);
    EXPECT_EQ(std::accumulate(report.m_levelTets.begin(), report.m_levelTets.end(), 0), report.m_tets);
    EXPECT_GE(minWeight, -1e-6);
    EXPECT_LT(farthest, 1e-11 * settings.m_cellSize);  // up to some 10,000 cells from the origin
}

struct GradedCase
{
    const char* m_name;
    SurfaceMesh m_surface;
    double m_cell;
    int m_levels;  // levels in use, of three
};

class GradedCage : public testing::TestWithParam<GradedCase>
{
};

TEST_P(GradedCage, KeepsItsPromises)
{
    const auto& [name, surface, cell, levels] = GetParam();
    const Cage cage = makeCage(surface, graded(cell));
    expectGradedPromises(cage, surface, graded(cell));
    EXPECT_EQ(cage.m_report.m_levels, levels);
}

INSTANTIATE_TEST_SUITE_P(
    Surfaces, GradedCage,
    testing::Values(GradedCase{"ball", sphereSurface(1, {}, 3), 0.3, 0},
                    GradedCase{"torus", torusSurface(1, 0.15, 48), 0.4, 2}, GradedCase{"rod", blockWithRod(), 0.25, 3},
                    GradedCase{"tiltedRod", tilted(blockWithRod()), 0.25, 3},
                    GradedCase{"tiltedPlates", tilted(twoPlates()), 0.3, 3},
                    GradedCase{"shell", joined(sphereSurface(1, {}, 3), flipped(sphereSurface(0.8, {}, 3))), 0.3, 2},
                    GradedCase{"open", without(boxSurface({0, 0, 0}, {1, 1, 0.2}), 4, 6), 0.3, 2},
                    GradedCase{"insideOut", flipped(boxSurface({0, 0, 0}, {1, 1, 0.2})), 0.3, 2},
                    GradedCase{"farAway", moved(torusSurface(1, 0.15, 24), {1000, 2000, 500}), 0.4, 2}),
    [](const auto& suite) { return suite.param.m_name; });

TEST(GradedCage, AlignedBoxGivesTheBox)
{
    const SurfaceMesh surface = boxSurface({-1, 0, 2}, {1, 1.5, 3});
    const Cage cage = makeCage(surface, graded(0.25));
    expectGradedPromises(cage, surface, graded(0.25));
    EXPECT_EQ(cage.m_mesh.tetCount(), 8 * 6 * 4 * 6);
    EXPECT_NEAR(cage.m_report.m_volumeRatio, 1, 1e-12);
    EXPECT_EQ(cage.m_report.m_levels, 0);
}

// Four and eight cells across: the whole box counts as thin.
TEST(GradedCage, HalvesPartsThinnerThanRequested)
{
    const SurfaceMesh surface = boxSurface({0, 0, 0}, {2, 2, 1});
    const Cage four = makeCage(surface, graded(0.25, 4)), eight = makeCage(surface, graded(0.25, 8));
    EXPECT_EQ(four.m_mesh.tetCount(), 8 * 8 * 4 * 6);
    EXPECT_EQ(eight.m_mesh.tetCount(), 16 * 16 * 8 * 6);
    EXPECT_NEAR(eight.m_report.m_smallestCell, 0.125, 1e-12);
    EXPECT_EQ(eight.m_report.m_levelTets[1], 16 * 16 * 8 * 6);
}

TEST(GradedCage, IsFineOnlyAtThinParts)
{
    const SurfaceMesh surface = tilted(blockWithRod());
    const Cage cage = makeCage(surface, graded(0.25));
    const int fine = makeCage(surface, withCell(cage.m_report.m_smallestCell)).m_mesh.tetCount();
    EXPECT_LT(10 * cage.m_mesh.tetCount(), fine);
    const SurfaceMesh rod = tilted(boxSurface({1.05, 0.45, 0.45}, {1.8, 0.55, 0.55}));
    const SurfaceMesh core = tilted(boxSurface({0, 0, 0}, {0.35, 1, 1}));
    int inRod = 0, inCore = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
    {
        const std::array<Vec3, 4> x = cornersOf(cage.m_mesh, e);
        const auto enters = [&](const SurfaceMesh& s, const Triangle& t) {
            return triangleMeetsTet({s.m_vertices[t[0]], s.m_vertices[t[1]], s.m_vertices[t[2]]}, x, -1e-9);
        };
        for (const Triangle& t : rod.m_triangles)
            if (enters(rod, t))
            {
                ++inRod;
                EXPECT_LE(cellOf(cage.m_mesh, e), 0.1 / 2 + 1e-12);
            }
        for (const Triangle& t : core.m_triangles)
            if (enters(core, t))
            {
                ++inCore;
                EXPECT_NEAR(cellOf(cage.m_mesh, e), 0.25, 1e-12);
            }
    }
    EXPECT_GT(inRod, 300);
    EXPECT_GT(inCore, 100);
}

TEST(GradedCage, MeasuresFilledFractions)
{
    CageSettings settings = graded(0.4);
    settings.m_fillFloor = 1e-3;
    settings.m_fillSamples = 128;
    const Cage cage = makeCage(torusSurface(1, 0.15, 48), settings);
    EXPECT_NEAR(cage.m_massScale, 1, 0.01);
    EXPECT_LT(*std::min_element(cage.m_filled.begin(), cage.m_filled.end()), 0.1);
    EXPECT_EQ(*std::max_element(cage.m_filled.begin(), cage.m_filled.end()), 1);
}

// The rod is one cell across without grading, then two, then six.
TEST(GradedCage, IsThinAtThinParts)
{
    EXPECT_FALSE(isThinSomewhere(makeCage(boxSurface({0, 0, 0}, {1, 1, 1}), withCell(0.2)).m_mesh));
    EXPECT_TRUE(isThinSomewhere(makeCage(blockWithRod(), withCell(0.2)).m_mesh));
    EXPECT_TRUE(isThinSomewhere(makeCage(blockWithRod(), graded(0.2, 2)).m_mesh));
    EXPECT_FALSE(isThinSomewhere(makeCage(blockWithRod(), graded(0.1, 6)).m_mesh));
}

// For overlapping and for open surfaces the volume comes from samples.
TEST(GradedCage, CountsOverlapsOnceAndClosesHoles)
{
    const SurfaceMesh block = boxSurface({0, 0, 0}, {1, 1, 1});
    CageSettings settings = graded(0.1);
    settings.m_fillSamples = 64;
    const Cage both = makeCage(tilted(joined(block, boxSurface({0.5, 0.5, 0.9}, {0.6, 0.6, 2}))), settings);
    EXPECT_TRUE(both.m_report.m_selfIntersecting);
    EXPECT_GT(both.m_report.m_levels, 0);
    EXPECT_NEAR(both.m_report.m_surfaceVolume, 1.01, 0.005);
    const Cage open = makeCage(without(boxSurface({0, 0, 0}, {1, 1, 0.15}), 4, 6), settings);
    EXPECT_EQ(open.m_report.m_openEdges, 4);
    EXPECT_GT(open.m_report.m_levels, 0);
    EXPECT_NEAR(open.m_report.m_surfaceVolume, 0.15, 0.004);  // the plate cuts all elements equally
}

TEST(GradedCage, StopsAtTheLevelLimit)
{
    const SurfaceMesh surface = boxSurface({0, 0, 0}, {1, 1, 0.001});
    for (const int levels : {1, 2, 3})
    {
        const Cage cage = makeCage(surface, graded(0.2, 2, levels));
        const int along = 5 << levels;
        EXPECT_EQ(cage.m_mesh.tetCount(), 6 * along * along * 2) << levels;  // both sides of z = 0
        EXPECT_EQ(cage.m_report.m_levels, levels);
    }
}

// Along the lattice two cells separate two faces; in an oblique direction up to four are needed.
TEST(GradedCage, SeparatesSheetsIfItResolvesTheGap)
{
    EXPECT_EQ(makeCage(twoPlates(), withCell(0.3)).m_mesh.componentCount(), 1);
    EXPECT_EQ(makeCage(twoPlates(), graded(0.3, 2, 3)).m_mesh.componentCount(), 2);
    EXPECT_EQ(makeCage(tilted(twoPlates()), withCell(0.3)).m_mesh.componentCount(), 1);
    EXPECT_EQ(makeCage(tilted(twoPlates()), graded(0.15, 3.5, 3)).m_mesh.componentCount(), 2);
    const Cage glued = makeCage(twoPlates(), graded(0.3, 2, 2));
    EXPECT_EQ(glued.m_mesh.componentCount(), 1);  // cells of 0.075 m: the gap is 4/3 cells across
}

// No elements are halved for a gap that cannot be resolved.
TEST(GradedCage, LeavesNarrowGapsAlone)
{
    const SurfaceMesh low = boxSurface({0, 0, 0}, {1, 1, 1});
    const auto apart = [&](double gap) { return joined(low, boxSurface({0, 0, 1 + gap}, {1, 1, 2 + gap})); };
    EXPECT_EQ(makeCage(apart(0.01), graded(0.25)).m_report.m_levels, 0);
    const Cage parted = makeCage(apart(0.1), graded(0.25));
    EXPECT_EQ(parted.m_report.m_levels, 3);
    EXPECT_EQ(parted.m_mesh.componentCount(), 2);
}

// Boxes and plates have whole layers, and parts of equal thickness are halved all at once.
TEST(GradedCage, ComesNearAWantedNumber)
{
    // The fin is thinner than any level: its target size falls with the levels.
    const SurfaceMesh fin = joined(boxSurface({0, 0, 0}, {1, 1, 1}), boxSurface({0.9, 0, 0.5}, {2, 1, 0.502}));
    const SurfaceMesh surfaces[] = {blockWithRod(), tilted(twoPlates()), torusSurface(1, 0.2, 24),
                                    without(boxSurface({0, 0, 0}, {1, 1, 0.3}), 0, 2), tilted(fin)};
    for (const SurfaceMesh& surface : surfaces)
        for (const int target : {600, 3000})
        {
            CageSettings settings = graded(0);
            settings.m_targetTets = target;
            settings.m_fillSamples = 8;
            const Cage cage = makeCage(surface, settings);
            EXPECT_NEAR(cage.m_report.m_tets, target, 0.3 * target);
            EXPECT_LE(cage.m_report.m_cellsAcross, 2);
            settings.m_cellSize = cage.m_report.m_cellSize;
            expectGradedPromises(cage, surface, settings);
        }
}

TEST(GradedCage, IsTheSameOnEveryCallAndAtEveryScale)
{
    const SurfaceMesh surface = tilted(blockWithRod());
    SurfaceMesh larger = surface;
    for (Vec3& x : larger.m_vertices) x *= 1024;  // a power of two keeps the rounding
    CageSettings settings = graded(0);
    settings.m_targetTets = 1000;
    const Cage a = makeCage(surface, settings), b = makeCage(surface, settings);
    const Cage c = makeCage(larger, graded(256)), d = makeCage(surface, graded(0.25));
    EXPECT_EQ(a.m_mesh.tets(), b.m_mesh.tets());
    EXPECT_EQ(a.m_filled, b.m_filled);
    EXPECT_EQ(c.m_mesh.tets(), d.m_mesh.tets());
    EXPECT_EQ(c.m_filled, d.m_filled);
    for (int i = 0; i < a.m_mesh.nodeCount(); ++i)
        ASSERT_EQ(norm(a.m_mesh.restPositions()[i] - b.m_mesh.restPositions()[i]), 0);
}

TEST(GradedCage, IsSnapped)
{
    for (const SurfaceMesh& surface : {tilted(blockWithRod()), torusSurface(1, 0.15, 48)})
    {
        CageSettings settings = graded(0.25, 2, 2);
        const Cage lattice = makeCage(surface, settings);
        settings.m_snap = 1;
        const Cage cage = makeCage(surface, settings);
        EXPECT_EQ(cage.m_mesh.tets(), lattice.m_mesh.tets());
        EXPECT_GE(cage.m_report.m_leastQuality, 0.3);
        EXPECT_EQ(cage.m_report.m_qualityBound, 0.3);
        EXPECT_FALSE(piercesBoundary(cage, surface, 1e-7 * cage.m_report.m_smallestCell));
        EXPECT_LT(cage.m_report.m_volumeRatio - 1, 0.6 * (lattice.m_report.m_volumeRatio - 1));
        EXPECT_GE(cage.m_report.m_volumeRatio, 1 - 1e-9);
    }
}

TEST(GradedCage, IsUniformUnlessGradingIsRequested)
{
    const SurfaceMesh surface = blockWithRod();
    CageSettings settings = withCell(0.25);
    const Cage cage = makeCage(surface, settings);
    settings.m_mostLevels = 6;
    const Cage same = makeCage(surface, settings);
    EXPECT_EQ(cage.m_mesh.tets(), same.m_mesh.tets());
    EXPECT_EQ(cage.m_report.m_levels, 0);
    EXPECT_EQ(cage.m_report.m_qualityBound, 0.8399);
    EXPECT_EQ(cage.m_mesh.tetCount(), 436);  // the count from before grading existed
    EXPECT_EQ(cage.m_report.m_smallestCell, 0.25);
    EXPECT_EQ(cage.m_report.m_largestCell, 0.25);
    EXPECT_EQ(cage.m_report.m_cellsAcross, 0);
    EXPECT_EQ(cage.m_report.m_levelTets[0], cage.m_report.m_tets);
    EXPECT_EQ(describe(cage.m_report).find("graded"), std::string::npos);
    EXPECT_NE(describe(makeCage(surface, graded(0.25)).m_report).find("graded, cells of 0.0"), std::string::npos);
}

TEST(GradedCage, RejectsSettings)
{
    const SurfaceMesh rod = blockWithRod();
    for (const double across : {-1.0, 0.4, 8.1, std::numeric_limits<double>::quiet_NaN()})
        expectRejected([&] { makeCage(rod, graded(0.25, across)); },
                       {"across thin parts", "[0.5, 8]", "m_cellsAcross"});
    for (const int levels : {0, 7, -3})
        expectRejected([&] { makeCage(rod, graded(0.25, 2, levels)); }, {"most levels", "[1, 6]", "m_mostLevels"});
    CageSettings few = graded(0.25);
    few.m_maxTets = 1000;
    expectRejected([&] { makeCage(rod, few); },
                   {"graded by up to 3 levels", "at least 1001", "[1, 1000]", "fewer m_mostLevels", "raise m_maxTets"});
    few = graded(0.25, 8, 6);
    few.m_maxTets = 3000;  // far more tets are bisected before the filled ones are selected
    expectRejected([&] { makeCage(rod, few); }, {"graded by up to 6 levels", "[1, 3000]"});
}

}  // namespace
}  // namespace bullet_fem
