// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/cage/winding_number.h"
#include "fem/cage/triangle_tree.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

CageSettings snapping(double cellSize, double share = 1)
{
    CageSettings settings = withCell(cellSize);
    settings.m_snap = share;
    return settings;
}

/// The minimum barycentric weight of a boundary triangle's centre in the lattice element that contains it best.
double deepestOutside(const Cage& cage, const Cage& lattice)
{
    const std::vector<Vec3>& X = lattice.m_mesh.restPositions();
    double deepest = 0;
    const std::vector<Vec3>& x = cage.m_mesh.restPositions();
    for (const Triangle& f : cage.m_mesh.surface())
    {
        const Vec3 middle = (x[f[0]] + x[f[1]] + x[f[2]]) * (1.0 / 3);
        double best = -1e300;
        for (const Tet& t : lattice.m_mesh.tets())
        {
            const Vec3 p = middle - X[t[0]], a = X[t[1]] - X[t[0]], b = X[t[2]] - X[t[0]], c = X[t[3]] - X[t[0]];
            const double v = dot(cross(a, b), c);
            const std::array<double, 3> w = {dot(cross(p, b), c) / v, dot(cross(a, p), c) / v, dot(cross(a, b), p) / v};
            best = std::max(best, std::min({w[0], w[1], w[2], 1 - w[0] - w[1] - w[2]}));
        }
        deepest = std::min(deepest, best);
    }
    return deepest;
}

/// Invariants of snapping, for any surface.
void expectSnapPromises(const Cage& cage, const Cage& lattice, const SurfaceMesh& surface)
{
    const CageReport& report = cage.m_report;
    EXPECT_EQ(cage.m_mesh.tets(), lattice.m_mesh.tets());
    EXPECT_EQ(cage.m_mesh.turnedCount(), 0);
    EXPECT_EQ(report.m_qualityBound, 0.3);
    EXPECT_GE(report.m_leastQuality, report.m_qualityBound);
    EXPECT_EQ(report.m_latticeVolumeRatio, lattice.m_report.m_volumeRatio);
    EXPECT_LE(report.m_volumeRatio, lattice.m_report.m_volumeRatio);
    EXPECT_GE(report.m_volumeRatio, 1 - 1e-9);
    EXPECT_GE(deepestOutside(cage, lattice), -1e-8);  // it only shrinks
    EXPECT_FALSE(piercesBoundary(cage, surface, 1e-7 * report.m_cellSize));
    double filled = 0, minWeight = 1, farthest = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
        filled += cage.m_massScale * cage.m_filled[e] * cage.m_mesh.tetVolume(e);
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
    EXPECT_GE(minWeight, -1e-6);
    EXPECT_LT(farthest, 1e-11 * report.m_cellSize);  // up to some 10,000 cells from the origin
}

/// Two crossed plates in an oblique orientation.
SurfaceMesh tiltedCross()
{
    SurfaceMesh cross = joined(boxSurface({0, 0, 0}, {1, 1, 0.15}), boxSurface({0.2, 0.3, -0.8}, {0.35, 0.6, 0.9}));
    const double c = std::cos(0.2), s = std::sin(0.2);
    for (Vec3& x : cross.m_vertices)
    {
        x = {c * x.x - s * x.y, s * x.x + c * x.y, x.z};
        x = {x.x, c * x.y - s * x.z, s * x.y + c * x.z};
    }
    return cross;
}

struct SnapCase
{
    const char* m_name;
    SurfaceMesh m_surface;
    double m_cell;
    double m_maxRatio;  // cage volume over solid volume; a tenth above the measured one
};

class SnappedCage : public testing::TestWithParam<SnapCase>
{
};

TEST_P(SnappedCage, KeepsItsPromises)
{
    const auto& [name, surface, cell, maxRatio] = GetParam();
    const Cage lattice = makeCage(surface, withCell(cell));
    const Cage cage = makeCage(surface, snapping(cell));
    expectSnapPromises(cage, lattice, surface);
    EXPECT_LT(cage.m_report.m_volumeRatio, maxRatio);
    EXPECT_LT(cage.m_report.m_volumeRatio - 1, 0.6 * (lattice.m_report.m_volumeRatio - 1));
    EXPECT_EQ(makeCage(surface, snapping(cell)).m_mesh.restPositions()[7].x, cage.m_mesh.restPositions()[7].x);
}

INSTANTIATE_TEST_SUITE_P(
    Surfaces, SnappedCage,
    testing::Values(SnapCase{"ball", sphereSurface(1, {}, 3), 0.3, 1.2},
                    SnapCase{"torus", torusSurface(1, 0.3, 32), 0.2, 1.5},
                    SnapCase{"tiltedPlate", boxSurface({0.01, 0, 0}, {1, 0.93, 0.11}), 0.15, 1.2},
                    SnapCase{"tiltedCross", tiltedCross(), 0.2, 1.9},
                    SnapCase{"overlap", joined(sphereSurface(1, {}, 2), sphereSurface(1, {1, 0, 0}, 2)), 0.3, 1.25},
                    SnapCase{"insideOut", flipped(sphereSurface(1, {}, 2)), 0.3, 1.2},
                    SnapCase{"farAway", sphereSurface(1, {1000, 2000, 500}, 2), 0.3, 1.2}),
    [](const auto& suite) { return suite.param.m_name; });

TEST(SnappedCage, AlignedBoxStaysUnchanged)
{
    const SurfaceMesh surface = boxSurface({-1, 0, 2}, {1, 1.5, 3});
    const Cage lattice = makeCage(surface, withCell(0.25)), cage = makeCage(surface, snapping(0.25));
    for (int i = 0; i < cage.m_mesh.nodeCount(); ++i)
        EXPECT_LT(norm(cage.m_mesh.restPositions()[i] - lattice.m_mesh.restPositions()[i]), 1e-12);
    EXPECT_NEAR(cage.m_report.m_volumeRatio, 1, 1e-9);
}

TEST(SnappedCage, MovesNodesByTheGivenShare)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 3);
    double previous = makeCage(ball, withCell(0.3)).m_report.m_volumeRatio;
    for (const double share : {0.25, 0.5, 1.0})
    {
        const double ratio = makeCage(ball, snapping(0.3, share)).m_report.m_volumeRatio;
        EXPECT_LT(ratio, previous - 0.02);
        previous = ratio;
    }
}

TEST(SnappedCage, StaysOutOfTheHolesOfAnOpenSurface)
{
    const SurfaceMesh surface = without(boxSurface({0, 0, 0}, {1, 1, 1}), 0, 2);
    const Cage cage = makeCage(surface, snapping(0.15));
    double highest = -1;  // of the nodes near the open side, whose plane bounds the inside
    for (const Vec3& X : cage.m_mesh.restPositions())
        if (std::abs(X.z) < 0.07) highest = std::max(highest, X.z);
    EXPECT_LT(highest, 1e-6);
    EXPECT_GT(highest, -0.07);
    EXPECT_GE(cage.m_report.m_leastQuality, 0.3);
}

// A slit in the wall of a cavity: the surface that closes it bulges into the cavity, across the path to its rim.
TEST(SnappedCage, StaysOutOfASlit)
{
    SurfaceMesh cavity = flipped(sphereSurface(1, {}, 3));
    const auto isSlit = [&](const Triangle& t)
    {
        const Vec3 middle = (cavity.m_vertices[t[0]] + cavity.m_vertices[t[1]] + cavity.m_vertices[t[2]]) * (1.0 / 3);
        return std::abs(middle.y) < 0.2 && middle.x > -0.5;
    };
    std::vector<Triangle>& triangles = cavity.m_triangles;
    triangles.erase(std::remove_if(triangles.begin(), triangles.end(), isSlit), triangles.end());
    const SurfaceMesh surface = joined(cavity, sphereSurface(1.5, {}, 3));
    CageSettings settings = withCell(0.3);
    settings.m_fillSamples = 16;
    const Cage lattice = makeCage(surface, settings);
    settings.m_snap = 1;
    const Cage cage = makeCage(surface, settings);
    const WindingNumber winding(surface.m_vertices, surface.m_triangles);
    const TriangleTree tree(surface.m_vertices, surface.m_triangles);
    double most = 0;
    for (const int i : cage.m_mesh.surfaceNodes())
    {
        const Vec3& x = cage.m_mesh.restPositions()[i];
        const bool onSurface = norm(tree.nearest(x) - x) < 1e-6;  // the winding number jumps there
        const bool hasMoved = norm(x - lattice.m_mesh.restPositions()[i]) > 0;
        if (hasMoved && !onSurface) most = std::max(most, winding.at(x));
    }
    EXPECT_LT(most, 0.501);  // snapping sums about another origin
    EXPECT_GT(most, 0.3);
}

// Half of the ball's volume is in moved elements: their newly measured fractions sum to the ball's volume.
TEST(SnappedCage, MeasuresFilledFractionsAnew)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 3);
    CageSettings settings = snapping(0.3);
    settings.m_fillFloor = 1e-3;
    settings.m_fillSamples = 256;
    EXPECT_NEAR(makeCage(ball, settings).m_massScale, 1, 0.01);
}

TEST(SnappedCage, RejectsShares)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 1);
    expectRejected([&] { makeCage(ball, snapping(0.5, -0.1)); }, {"snapped by is -0.1", "[0, 1]", "m_snap"});
    expectRejected([&] { makeCage(ball, snapping(0.5, 1.1)); }, {"is 1.1"});
    expectRejected([&] { makeCage(ball, snapping(0.5, std::numeric_limits<double>::quiet_NaN())); }, {"is nan"});
}

TEST(TriangleTree, FindsTheNearestPoint)
{
    SurfaceMesh surface = torusSurface(1, 0.3, 24);
    surface.m_triangles.push_back({5, 5, 5});  // without area
    surface.m_triangles.push_back({5, 5, 9});
    const TriangleTree tree(surface.m_vertices, surface.m_triangles);
    for (int n = 0; n < 200; ++n)
    {
        const Vec3 p = {std::sin(1.3 * n), 1.5 * std::sin(2.1 * n), std::cos(0.7 * n)};
        const double ring = std::hypot(std::hypot(p.x, p.y) - 1, p.z);  // from the circle in the middle
        // Facets lie inside the torus by 1 - cos(7.5 deg) of the major radius, and of the minor one by twice that
        // angle.
        EXPECT_NEAR(norm(tree.nearest(p) - p), std::abs(ring - 0.3), 0.025) << n;
    }
}

TEST(TriangleTree, FindsTrianglesEnteringATetrahedron)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 3);
    const TriangleTree tree(ball.m_vertices, ball.m_triangles);
    const auto cornerAt = [](const Vec3& o, double s) {
        return std::array<Vec3, 4>{o, o + Vec3{s, 0, 0}, o + Vec3{0, s, 0}, o + Vec3{0, 0, s}};
    };
    EXPECT_FALSE(tree.entersTet(cornerAt({0, 0, 0}, 0.9), 0));  // inside
    EXPECT_TRUE(tree.entersTet(cornerAt({0, 0, 0}, 1.1), 0));
    EXPECT_FALSE(tree.entersTet(cornerAt({0, 0, 0}, 1.1), 0.2));  // not as deep
    EXPECT_FALSE(tree.entersTet(cornerAt({1, 1, 1}, 1), 0));
    int entered = 0;
    for (int n = 0; n < 300; ++n)
    {
        const std::array<Vec3, 4> tet =
            cornerAt({std::sin(1.3 * n), std::sin(2.1 * n), std::sin(0.7 * n)}, 0.05 + 0.3 * std::abs(std::sin(n)));
        const bool expected = std::any_of(
            ball.m_triangles.begin(), ball.m_triangles.end(),
            [&](const Triangle& t) {
                return triangleMeetsTet({ball.m_vertices[t[0]], ball.m_vertices[t[1]], ball.m_vertices[t[2]]}, tet, 0);
            });
        EXPECT_EQ(tree.entersTet(tet, 0), expected) << n;
        entered += expected;
    }
    EXPECT_GT(entered, 30);
}

}  // namespace
}  // namespace bullet_fem
