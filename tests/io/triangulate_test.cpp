// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/surface/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace bullet_fem
{
namespace
{

struct Areas
{
    double sum = 0;     ///< length of the summed area vectors
    double ofEach = 0;  ///< sum of the area vectors' lengths: larger if triangles overlap with opposite orientation
    std::size_t count = 0;
};

/// Triangulates the polygon with corners 0, 1, ... n - 1.
Areas triangulatedAreas(const std::vector<Vec3>& positions)
{
    std::vector<int> corners(positions.size());
    std::iota(corners.begin(), corners.end(), 0);
    std::vector<Triangle> triangles;
    triangulatePolygon(positions, corners, triangles);
    Areas areas;
    areas.count = triangles.size();
    Vec3 sum;
    for (const Triangle& t : triangles)
    {
        const Vec3 a = 0.5 * cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]);
        sum += a;
        areas.ofEach += norm(a);
    }
    areas.sum = norm(sum);
    return areas;
}

/// A point of an oblique plane, so that no axis is special.
Vec3 placed(double u, double v)
{
    return Vec3{1, -2, 3} + u * Vec3{0.6, 0.8, 0} + v * Vec3{0, 0, 1};
}

TEST(Triangulate, MakesNoTriangleBelowThreeCorners)
{
    EXPECT_EQ(triangulatedAreas({}).count, 0u);
    EXPECT_EQ(triangulatedAreas({{0, 0, 0}, {1, 0, 0}}).count, 0u);
}

TEST(Triangulate, CoversConvexPolygonsOfAnySize)
{
    for (const int n : {3, 4, 10, 256, 300})
    {
        std::vector<Vec3> circle;
        for (int i = 0; i < n; ++i) circle.push_back(placed(std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n)));
        const Areas areas = triangulatedAreas(circle);
        const double area = 0.5 * n * std::sin(2 * M_PI / n);
        EXPECT_EQ(areas.count, static_cast<std::size_t>(n - 2));
        EXPECT_NEAR(areas.sum, area, 1e-12 * area) << n;  // rounding of n terms of size 1
        EXPECT_NEAR(areas.ofEach, area, 1e-12 * area) << n;
    }
}

TEST(Triangulate, ConcavePolygonIsNotCoveredTwice)
{
    // A comb of two teeth, starting at a corner from which a fan would leave the polygon.
    const Areas areas = triangulatedAreas({placed(1, 1), placed(1, 3), placed(0, 3), placed(0, 0), placed(3, 0),
                                           placed(3, 3), placed(2, 3), placed(2, 1)});
    EXPECT_EQ(areas.count, 6u);
    EXPECT_NEAR(areas.sum, 7, 1e-14 * 7 * 8);
    EXPECT_NEAR(areas.ofEach, 7, 1e-14 * 7 * 8);
}

TEST(Triangulate, CoversAPolygonWithABridgedHole)
{
    // A square of 3 with a hole of 1; corners 0 and 4 are repeated at the bridge.
    const Areas areas = triangulatedAreas({placed(0, 0), placed(3, 0), placed(3, 3), placed(0, 3), placed(0, 0),
                                           placed(1, 1), placed(1, 2), placed(2, 2), placed(2, 1), placed(1, 1)});
    EXPECT_EQ(areas.count, 8u);
    EXPECT_NEAR(areas.sum, 8, 1e-13 * 8);
    EXPECT_NEAR(areas.ofEach, 8, 1e-13 * 8);
}

TEST(Triangulate, PolygonsWithoutEarsKeepTheirAreaVector)
{
    const Areas bow = triangulatedAreas({placed(0, 0), placed(1, 1), placed(1, 0), placed(0, 1)});  // crosses itself
    EXPECT_EQ(bow.count, 2u);
    EXPECT_NEAR(bow.sum, 0, 1e-14);
    const Areas line = triangulatedAreas({placed(0, 0), placed(1, 0), placed(2, 0), placed(3, 0)});
    EXPECT_EQ(line.count, 2u);
    EXPECT_NEAR(line.ofEach, 0, 1e-14);
}

}  // namespace
}  // namespace bullet_fem
