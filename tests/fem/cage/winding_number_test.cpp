// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/winding_number.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/cage/triangle_overlap.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

double windingAt(const SurfaceMesh& surface, const Vec3& p)
{
    return WindingNumber(surface.m_vertices, surface.m_triangles).at(p);
}

TEST(WindingNumber, IsExactForABox)
{
    const SurfaceMesh box = boxSurface({0, 0, 0}, {1, 2, 3});
    EXPECT_NEAR(windingAt(box, {0.5, 1, 1.5}), 1, 1e-14);
    EXPECT_NEAR(windingAt(box, {1e-6, 1e-6, 1e-6}), 1, 1e-9);
    EXPECT_NEAR(windingAt(box, {-1e-6, 1, 1}), 0, 1e-9);
    EXPECT_NEAR(windingAt(flipped(box), {0.5, 1, 1.5}), -1, 1e-14);
}

TEST(WindingNumber, IsOneSixthForACubeFaceSeenFromTheCentre)
{
    const SurfaceMesh side = without(boxSurface({-1, -1, -1}, {1, 1, 1}), 2, 12);
    EXPECT_NEAR(windingAt(side, {0, 0, 0}), 1.0 / 6, 1e-15);
}

// The moments of a closed surface are N = 0 and C = V I, and their two terms cancel.
TEST(WindingNumber, VanishesForAFarBoxByItsMoments)
{
    const SurfaceMesh box = boxSurface({0, 0, 0}, {1, 2, 3});
    EXPECT_NEAR(windingAt(box, {20, -10, 10}), 0, 1e-17);  // either term alone: 1e-4
}

// A tube of many long faces, all near to its inside: the product of their complex numbers would underflow.
TEST(WindingNumber, DoesNotUnderflowForManyThinTriangles)
{
    constexpr int kSides = 600;
    SurfaceMesh tube;
    for (int k = 0; k < kSides; ++k)
        for (const double z : {0.0, 10.0})
            tube.m_vertices.push_back(
                {0.5 * std::cos(6.283185307 * k / kSides), 0.5 * std::sin(6.283185307 * k / kSides), z});
    tube.m_vertices.insert(tube.m_vertices.end(), {{0, 0, 0}, {0, 0, 10}});
    for (int k = 0; k < kSides; ++k)
    {
        const int i = 2 * k, j = 2 * ((k + 1) % kSides);
        for (const Triangle& t : {Triangle{i, j, j + 1}, Triangle{i, j + 1, i + 1}, Triangle{2 * kSides, j, i},
                                  Triangle{2 * kSides + 1, i + 1, j + 1}})
            tube.m_triangles.push_back(t);
    }
    const WindingNumber winding(tube.m_vertices, tube.m_triangles);
    for (const double z : {0.5, 2.0, 5.0, 9.5})
        for (const double r : {0.0, 0.2, 0.4, 0.49})
            EXPECT_NEAR(winding.at({0.6 * r, 0.8 * r, z}), 1, 0.1) << r << " m, " << z << " m";
    EXPECT_NEAR(winding.at({0.6, 0, 5}), 0, 0.1);
}

TEST(WindingNumber, IsZeroForAnEmptySurface)
{
    EXPECT_EQ(windingAt(SurfaceMesh(), {1, 2, 3}), 0);
}

// Moments replace triangles farther away than twice the cluster's radius; the error must stay far from the threshold of
// 1/2. One patch of the torus is compared with the direct sum over its triangles, and the whole torus with the integer.
TEST(WindingNumber, ApproximatesFarTriangles)
{
    const SurfaceMesh torus = torusSurface(1, 0.4, 100);  // 10,000 triangles
    const SurfaceMesh patch = without(torus, 1000, 10000);
    const WindingNumber whole(torus.m_vertices, torus.m_triangles), part(patch.m_vertices, patch.m_triangles);
    std::vector<WindingNumber> each;
    for (const Triangle& t : patch.m_triangles) each.emplace_back(patch.m_vertices, std::vector<Triangle>{t});
    double worstPart = 0, worstInside = 0, worstOutside = 0;
    for (int n = 0; n < 500; ++n)
    {
        const double u = n * 0.7548776662, v = n * 0.5698402909;
        const auto at = [&](double minor)
        {
            const double r = 1 + minor * std::cos(v);
            return Vec3{r * std::cos(u), r * std::sin(u), minor * std::sin(v)};
        };
        worstInside = std::max(worstInside, std::abs(whole.at(at(0.39)) - 1));
        worstOutside = std::max(worstOutside, std::abs(whole.at(at(0.41))));
        double sum = 0;
        for (const WindingNumber& triangle : each) sum += triangle.at(at(0.39));
        worstPart = std::max(worstPart, std::abs(part.at(at(0.39)) - sum));
    }
    EXPECT_LT(worstInside, 0.05);  // measured 0.03; 0.06 to 0.09 with the vector area alone
    EXPECT_LT(worstOutside, 0.05);
    EXPECT_LT(worstPart, 0.02);
}

TEST(TriangleOverlap, DetectsOverlapWithABox)
{
    const Vec3 low = {0, 0, 0}, high = {1, 1, 1};
    const TriangleCorners through = {Vec3{-5, 0.5, 0.5}, Vec3{5, 0.5, 0.5}, Vec3{0, 9, 0.5}};
    EXPECT_TRUE(triangleMeetsBox(through, low, high, 0));
    const TriangleCorners pastTheCorner = {Vec3{1.9, 0, 0}, Vec3{0, 1.9, 0}, Vec3{0, 0, 5}};
    EXPECT_TRUE(triangleMeetsBox(pastTheCorner, low, high, 0));
    // One edge passes the box's edge x = y = 1 at x + y = 2.1, in a plane through the box: only their cross product
    // separates.
    const TriangleCorners pastAnEdge = {Vec3{2.3, -0.2, 0.9}, Vec3{-0.2, 2.3, 0.1}, Vec3{3, 3, 0.5}};
    EXPECT_FALSE(triangleMeetsBox(pastAnEdge, low, high, 0));
    EXPECT_TRUE(triangleMeetsBox(pastAnEdge, low, high, 0.1));  // 0.1 / sqrt 2 away
    const TriangleCorners beside = {Vec3{2.1, 0, -9}, Vec3{0, 2.1, -9}, Vec3{1.05, 1.05, 9}};
    EXPECT_FALSE(triangleMeetsBox(beside, low, high, 0));
}

TEST(TriangleOverlap, LargeTriangleBeyondACornerIsSeparatedByItsNormalAlone)
{
    const auto inPlane = [](double sum)  // x + y + z = sum
    {
        return TriangleCorners{Vec3{sum + 10, -5, -5}, Vec3{-5, sum + 10, -5}, Vec3{-5, -5, sum + 10}};
    };
    EXPECT_FALSE(triangleMeetsBox(inPlane(3.1), {0, 0, 0}, {1, 1, 1}, 0));
    EXPECT_TRUE(triangleMeetsBox(inPlane(2.9), {0, 0, 0}, {1, 1, 1}, 0));
}

TEST(TriangleOverlap, SlackDecidesBoundaryContact)
{
    const std::array<Vec3, 4> tet = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const TriangleCorners onItsFace = {Vec3{0.1, 0.1, 0}, Vec3{2, 0.1, 0}, Vec3{0.1, 2, 0}};
    EXPECT_TRUE(triangleMeetsTet(onItsFace, tet, 1e-9));
    EXPECT_FALSE(triangleMeetsTet(onItsFace, tet, -1e-9));
    TriangleCorners inside = onItsFace;
    for (Vec3& x : inside) x.z = 0.01;
    EXPECT_TRUE(triangleMeetsTet(inside, tet, -1e-9));
    const TriangleCorners atItsTip = {Vec3{0, 0, 1}, Vec3{1, 0, 2}, Vec3{0, 1, 2}};
    EXPECT_TRUE(triangleMeetsTet(atItsTip, tet, 1e-9));
    EXPECT_FALSE(triangleMeetsTet(atItsTip, tet, -1e-9));
    // A spike on the plane x + y + z = 1: only that plane's normal separates.
    const TriangleCorners spike = {Vec3{0.36, 0.36, 0.36}, Vec3{1.3, 1.4, 1.3}, Vec3{2.5, 2.4, 2.3}};
    EXPECT_FALSE(triangleMeetsTet(spike, tet, 1e-9));
    EXPECT_TRUE(triangleMeetsTet(spike, tet, 0.08 / std::sqrt(3.0) + 1e-9));
    const TriangleCorners point = {Vec3{0.2, 0.2, 0.2}, Vec3{0.2, 0.2, 0.2}, Vec3{0.2, 0.2, 0.2}};
    EXPECT_TRUE(triangleMeetsTet(point, tet, -1e-9));
}

}  // namespace
}  // namespace bullet_fem
