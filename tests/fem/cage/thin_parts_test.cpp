// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/thin_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

/// Parts thinner than 0.5 m, from fragments of at most 0.1 m.
std::vector<ThinPart> partsOf(const SurfaceMesh& surface)
{
    const TriangleTree tree(surface.m_vertices, surface.m_triangles);
    const SurfaceWinding winding(surface.m_vertices, surface.m_triangles, true);
    return findThinParts(surface.m_vertices, surface.m_triangles, {tree, winding, 0.5, 0.1, 0.02, 1});
}

double areaOf(const ThinPart& part)
{
    const TriangleCorners& x = part.m_corners;
    return 0.5 * norm(cross(x[1] - x[0], x[2] - x[0]));
}

struct Found
{
    double m_area = 0, m_min = 1e300, m_max = 0;
};

Found found(const std::vector<ThinPart>& parts, bool gaps)
{
    Found sum;
    for (const ThinPart& part : parts)
    {
        if (part.m_isGap != gaps) continue;
        sum.m_area += areaOf(part);
        sum.m_min = std::min(sum.m_min, norm(part.m_across));
        sum.m_max = std::max(sum.m_max, norm(part.m_across));
    }
    return sum;
}

TEST(ThinParts, IncludeTheFacesOfAPlate)
{
    const std::vector<ThinPart> parts = partsOf(boxSurface({0, 0, 0}, {1, 1, 0.1}));
    const Found solid = found(parts, false);
    EXPECT_NEAR(solid.m_area, 2, 1e-12);  // without the rim, which is 1 m across
    EXPECT_NEAR(solid.m_min, 0.1, 1e-12);
    EXPECT_NEAR(solid.m_max, 0.1, 1e-12);
    EXPECT_EQ(found(parts, true).m_area, 0);
    for (const ThinPart& part : parts)
        for (int a = 0; a < 3; ++a) EXPECT_LE(norm(part.m_corners[a] - part.m_corners[(a + 1) % 3]), 0.1);
}

TEST(ThinParts, ExcludeTheEdgesOfThickSolids)
{
    EXPECT_TRUE(partsOf(boxSurface({0, 0, 0}, {1, 1, 1})).empty());
    EXPECT_TRUE(partsOf(sphereSurface(1, {}, 3)).empty());
    EXPECT_TRUE(partsOf(flipped(sphereSurface(1, {}, 3))).empty());
}

TEST(ThinParts, IncludeTheEdgeOfAWedge)
{
    SurfaceMesh wedge;  // 1 m long, 0.3 m high at its back: 17 degrees
    wedge.m_vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0.3}, {1, 1, 0.3}};
    wedge.m_triangles = {{0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {1, 4, 5}, {2, 3, 4}, {3, 5, 4}, {0, 2, 4}, {1, 5, 3}};
    const std::vector<ThinPart> parts = partsOf(wedge);
    double worst = 0;
    for (const ThinPart& part : parts)
    {
        const Vec3 middle = (part.m_corners[0] + part.m_corners[1] + part.m_corners[2]) * (1.0 / 3);
        const double flat = 0.3 * middle.x, tilted = flat * std::sqrt(1.09);
        worst = std::max(worst, std::min(std::abs(norm(part.m_across) - flat), std::abs(norm(part.m_across) - tilted)));
    }
    EXPECT_LT(worst, 0.3 * 0.02);  // small fragments adopt their neighbours' thickness
    EXPECT_GT(found(parts, false).m_area, 1.8);
}

TEST(ThinParts, AreGapsBetweenTwoSides)
{
    const SurfaceMesh low = boxSurface({0, 0, 0}, {1, 1, 1}), high = boxSurface({0, 0, 1.2}, {1, 1, 2.2});
    for (const SurfaceMesh& surface :
         {joined(low, high), joined(flipped(low), flipped(high)), joined(low, flipped(high))})
    {
        const std::vector<ThinPart> parts = partsOf(surface);
        const Found gap = found(parts, true);
        EXPECT_NEAR(gap.m_area, 2, 1e-12);
        EXPECT_NEAR(gap.m_min, 0.2, 1e-12);
        EXPECT_NEAR(gap.m_max, 0.2, 1e-12);
        EXPECT_EQ(found(parts, false).m_area, 0);
    }
}

// Inner walls of overlapping components bound no solid.
TEST(ThinParts, ExcludeOverlapsOfSolids)
{
    EXPECT_TRUE(partsOf(joined(boxSurface({0, 0, 0}, {1, 1, 1}), boxSurface({0.8, 0, 0}, {1.8, 1, 1}))).empty());
}

/// Splits each triangle into four.
SurfaceMesh split(const SurfaceMesh& surface)
{
    SurfaceMesh fine;
    for (const Triangle& t : surface.m_triangles)
    {
        const Vec3 &a = surface.m_vertices[t[0]], &b = surface.m_vertices[t[1]], &c = surface.m_vertices[t[2]];
        const int n = static_cast<int>(fine.m_vertices.size());
        fine.m_vertices.insert(fine.m_vertices.end(), {a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)});
        for (const Triangle& part : {Triangle{0, 3, 5}, Triangle{3, 1, 4}, Triangle{5, 4, 2}, Triangle{3, 4, 5}})
            fine.m_triangles.push_back({n + part[0], n + part[1], n + part[2]});
    }
    return fine;
}

// The rim's triangles share blocks with those of the faces, and measure 1 m across.
TEST(ThinParts, ExcludeTheRimOfAFinePlate)
{
    SurfaceMesh plate = boxSurface({0, 0, 0}, {1, 1, 0.02});
    for (int n = 0; n < 4; ++n) plate = split(plate);
    const TriangleTree tree(plate.m_vertices, plate.m_triangles);
    const SurfaceWinding winding(plate.m_vertices, plate.m_triangles, true);
    const std::vector<ThinPart> parts =
        findThinParts(plate.m_vertices, plate.m_triangles, {tree, winding, 0.5, 0.3, 0.15, 1});
    const Found solid = found(parts, false);
    EXPECT_NEAR(solid.m_area, 2, 1e-12);
    EXPECT_NEAR(solid.m_max, 0.02, 1e-12);
}

TEST(ThinParts, AreIndependentOfTriangleSize)
{
    const Found ring = found(partsOf(torusSurface(1, 0.15, 400)), false);  // triangles of 0.005 to 0.02 m
    const double area = 4 * 9.8696044 * 0.15;
    EXPECT_NEAR(ring.m_area, area, 0.01 * area);
    EXPECT_NEAR(ring.m_min, 0.3, 0.01);
    EXPECT_NEAR(ring.m_max, 0.3, 0.01);
}

}  // namespace
}  // namespace bullet_fem
