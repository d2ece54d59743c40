// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bridge/bridge_test_shapes.h"
#include "bullet_bridge/geometry/shapes/convex_core.h"

namespace bullet_fem
{

namespace
{

using Corners = std::array<Vec3, 3>;

constexpr double anyGap = 1e30;

SurfaceDistance distanceTo(const ShapeLeaf& leaf, const Corners& triangle)
{
    SurfaceDistance d;
    EXPECT_TRUE(triangleShapeDistance(leaf, triangle, anyGap, d));
    return d;
}

/// Invariants of each result: a unit normal, and barycentrics in [0, 1] of sum 1.
void expectWellFormed(const SurfaceDistance& d)
{
    EXPECT_TRUE(std::isfinite(d.m_gap));
    EXPECT_NEAR(norm(d.m_normal), 1, 1e-12);
    EXPECT_NEAR(d.m_barycentric[0] + d.m_barycentric[1] + d.m_barycentric[2], 1, 1e-14);
    for (double w : d.m_barycentric) EXPECT_GE(w, 0);
}

struct KnownAnswer
{
    const char* m_what;
    Corners m_triangle;
    double m_gap;
    Vec3 m_normal, m_softPoint;
};

void expectAnswers(btCollisionShape& shape, const std::vector<KnownAnswer>& answers, double tolerance)
{
    const ShapeLeaf leaf = leafOf(shape);
    for (const KnownAnswer& answer : answers)
    {
        SCOPED_TRACE(answer.m_what);
        const SurfaceDistance d = distanceTo(leaf, answer.m_triangle);
        expectWellFormed(d);
        EXPECT_NEAR(d.m_gap, answer.m_gap, tolerance);
        EXPECT_NEAR(norm(d.m_normal - answer.m_normal), 0, 10 * tolerance);
        EXPECT_NEAR(norm(interpolate(answer.m_triangle, d.m_barycentric) - answer.m_softPoint), 0, 10 * tolerance);
    }
}

const double halfRoot = std::sqrt(0.5);

/// Penetration depth of a box and a triangle: the minimum over the separating axes (face normals and cross products of
/// edges). It is minus the distance if the two are separated along one of these axes.
double overlapDepth(const Vec3& halfExtents, const Corners& t)
{
    std::vector<Vec3> axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, cross(t[1] - t[0], t[2] - t[0])};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) axes.push_back(cross(axes[i], t[(j + 1) % 3] - t[j]));
    double depth = std::numeric_limits<double>::infinity();
    for (const Vec3& axis : axes)
    {
        const Vec3 n = axis * (1 / norm(axis));
        const double box =
            std::abs(n.x) * halfExtents.x + std::abs(n.y) * halfExtents.y + std::abs(n.z) * halfExtents.z;
        const auto [low, high] = std::minmax({dot(n, t[0]), dot(n, t[1]), dot(n, t[2])});
        depth = std::min({depth, box - low, box + high});
    }
    return depth;
}

}  // namespace

TEST(TriangleShapeDistance, MatchesHandValuesForSphere)
{
    btSphereShape sphere(1);
    expectAnswers(sphere,
                  {{"face", {{{-1, 2, -1}, {1, 2, -1}, {0, 2, 2}}}, 1, {0, 1, 0}, {0, 2, 0}},
                   {"edge", {{{-1, 2, 0}, {1, 2, 0}, {0, 4, 0}}}, 1, {0, 1, 0}, {0, 2, 0}},
                   {"vertex", {{{3, 0, 0}, {4, 1, 0}, {4, -1, 1}}}, 2, {1, 0, 0}, {3, 0, 0}},
                   {"face inside", {{{-1, 0.25, -1}, {1, 0.25, -1}, {0, 0.25, 2}}}, -0.75, {0, 1, 0}, {0, 0.25, 0}},
                   {"vertex inside", {{{0.5, 0, 0}, {4, 1, 0}, {4, -1, 1}}}, -0.5, {1, 0, 0}, {0.5, 0, 0}}},
                  1e-14);
}

TEST(TriangleShapeDistance, SphereWithItsCentreInTheTriangleGoesOutThroughItsOutside)
{
    btSphereShape sphere(1);
    const Corners up = {{{-1, 0, -1}, {0, 0, 2}, {1, 0, -1}}};  // its outward normal is +y, so soft goes down
    expectAnswers(sphere, {{"up", up, -1, {0, -1, 0}, {0, 0, 0}}}, 1e-14);
    expectAnswers(sphere, {{"down", {{up[0], up[2], up[1]}}, -1, {0, 1, 0}, {0, 0, 0}}}, 1e-14);
}

TEST(TriangleShapeDistance, MatchesHandValuesForCapsule)
{
    btCapsuleShape capsule(0.5, 2);
    expectAnswers(
        capsule,
        {{"face above the end", {{{-1, 2, -1}, {1, 2, -1}, {0, 2, 2}}}, 0.5, {0, 1, 0}, {0, 2, 0}},
         {"edge across the side", {{{1, 0, -1}, {1, 0, 1}, {3, 0, 0}}}, 0.5, {1, 0, 0}, {1, 0, 0}},
         {"vertex in the side", {{{0.25, 0.5, 0}, {3, 2, 0}, {3, 0, 0}}}, -0.25, {1, 0, 0}, {0.25, 0.5, 0}},
         {"the axis goes through", {{{-3, 0.75, -3}, {3, 0.75, -3}, {0, 0.75, 4}}}, -0.75, {0, 1, 0}, {0, 0.75, 0}}},
        1e-12);
}

TEST(TriangleShapeDistance, MatchesHandValuesForBox)
{
    btBoxShape box(btVector3(1, 1, 1));
    const double rounded = ConvexCore::edgeRounding * (std::sqrt(2) - 1);  // added to the gap at a box's edge
    expectAnswers(
        box,
        {{"vertex above a face", {{{0.5, 1.25, 0}, {1, 2, 1}, {0, 2, 1}}}, 0.25, {0, 1, 0}, {0.5, 1.25, 0}},
         {"vertex in a face", {{{0.5, 0.75, 0}, {1, 2, 1}, {0, 2, 1}}}, -0.25, {0, 1, 0}, {0.5, 0.75, 0}},
         {"edge over a face", {{{-2, 1.5, 0}, {0, 1.25, 0.5}, {2, 1.5, 0}}}, 0.25, {0, 1, 0}, {0, 1.25, 0.5}}},
        2e-6);
    const Corners acrossEdge = {{{3, 0, -1}, {0, 3, -1}, {1.5, 1.5, 2}}};  // in the plane x + y = 3
    const SurfaceDistance d = distanceTo(leafOf(box), acrossEdge);
    expectWellFormed(d);
    EXPECT_NEAR(d.m_gap, halfRoot + rounded, 1e-7);
    EXPECT_NEAR(norm(d.m_normal - Vec3{halfRoot, halfRoot, 0}), 0, 1e-7);
    const Vec3 soft = interpolate(acrossEdge, d.m_barycentric);
    EXPECT_NEAR(soft.x, 1.5, 1e-7);
    EXPECT_NEAR(soft.y, 1.5, 1e-7);
    EXPECT_LE(std::abs(soft.z), 1 + 1e-7);
}

TEST(TriangleShapeDistance, MatchesHandValuesForHull)
{
    const ShapePtr hull = boxHull({1, 1, 1}, 0.125);
    expectAnswers(
        *hull,
        {{"vertex above a face", {{{0.5, 1.25, 0}, {1, 2, 1}, {0, 2, 1}}}, 0.125, {0, 1, 0}, {0.5, 1.25, 0}},
         {"vertex in the margin", {{{0.5, 1.0625, 0}, {1, 2, 1}, {0, 2, 1}}}, -0.0625, {0, 1, 0}, {0.5, 1.0625, 0}},
         {"vertex inside", {{{0.5, 0.75, 0}, {1, 2, 1}, {0, 2, 1}}}, -0.375, {0, 1, 0}, {0.5, 0.75, 0}},
         {"corner under a face",
          {{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}},
          -0.125,
          {1 / std::sqrt(3.0), 1 / std::sqrt(3.0), 1 / std::sqrt(3.0)},
          {1, 1, 1}},
         {"corner through a face",
          {{{2.25, 0, 0}, {0, 2.25, 0}, {0, 0, 2.25}}},
          -0.125 - 0.75 / std::sqrt(3.0),
          {1 / std::sqrt(3.0), 1 / std::sqrt(3.0), 1 / std::sqrt(3.0)},
          {0.75, 0.75, 0.75}}},
        1e-10);
}

TEST(TriangleShapeDistance, LeavesTheResultAloneBeyondTheLimit)
{
    btBoxShape box(btVector3(1, 1, 1));
    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    const Corners above = {{{0.5, 1.5, 0}, {1, 2, 1}, {0, 2, 1}}};
    Corners broken = above;
    broken[1].y = std::numeric_limits<double>::quiet_NaN();
    SurfaceDistance d;
    d.m_gap = 42;
    EXPECT_FALSE(triangleShapeDistance(leafOf(box), above, 0.25, d));
    EXPECT_FALSE(triangleShapeDistance(leafOf(box), broken, anyGap, d));
    EXPECT_FALSE(triangleShapeDistance(leafOf(plane), above, anyGap, d));
    EXPECT_EQ(d.m_gap, 42);
    EXPECT_TRUE(triangleShapeDistance(leafOf(box), above, 0.75, d));
    EXPECT_NEAR(d.m_gap, 0.5, 1e-7);
}

TEST(TriangleShapeDistance, DegenerateTrianglesAreAnswered)
{
    for (const NamedShape& solid : convexSolids())
    {
        SCOPED_TRACE(solid.m_name);
        const ShapePtr shape = solid.m_make();
        const ShapeLeaf leaf = leafOf(*shape);
        for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{0.1, 0.1, 0.1}, Vec3{0.5, 0.25, 0.75}})
        {
            expectWellFormed(distanceTo(leaf, {p, p, p}));
            expectWellFormed(distanceTo(leaf, {p, p + Vec3{0, 1, 0}, p + Vec3{0, 2, 0}}));
            expectWellFormed(distanceTo(leaf, {p, -p, p}));
        }
    }
}

// The oracle is the separating axis theorem, for hulls without margin: exact to rounding; 300 of the triangles are
// thin.
TEST(TriangleShapeDistance, DepthInAHullIsThatOfTheSeparatingAxes)
{
    const Vec3 h = {0.5, 0.25, 0.75};
    const ShapePtr hull = boxHull({0.5f, 0.25f, 0.75f}, 0);
    const ShapeLeaf leaf = leafOf(*hull);
    RandomPoints random;
    int overlapping = 0;
    for (int i = 0; i < 3000; ++i)
    {
        Corners t = random.triangle(0.6, 0.7);
        t[1] = i % 10 ? t[1] : 0.5 * (t[0] + t[2]) + 1e-6 * t[1];
        const double depth = overlapDepth(h, t);
        const SurfaceDistance d = distanceTo(leaf, t);
        expectWellFormed(d);
        overlapping += depth > 0;
        EXPECT_EQ(d.m_gap<0, depth> 0) << i;
        EXPECT_NEAR(std::min(d.m_gap, 0.0), std::min(-depth, 0.0), 1e-9) << i;
    }
    EXPECT_GT(overlapping, 1000);
}

// Axis-aligned configurations are hard for EPA: many points are coplanar.
TEST(TriangleShapeDistance, DepthIsRightForAlignedShapes)
{
    const Vec3 h = {0.5, 0.25, 0.75};
    const ShapePtr hull = boxHull({0.5f, 0.25f, 0.75f}, 0);
    const ShapeLeaf leaf = leafOf(*hull);
    for (double x : {-0.5, -0.25, 0.0, 0.25, 0.5})
        for (double y : {-0.25, -0.125, 0.0, 0.125, 0.25})
            for (double size : {0.125, 0.5, 2.0})
            {
                const Vec3 p = {x, y, 0.25};
                for (const Corners& t : {Corners{p, p + Vec3{size, 0, 0}, p + Vec3{0, size, 0}},
                                         Corners{p, p + Vec3{0, 0, size}, p + Vec3{size, 0, 0}},
                                         Corners{p, p + Vec3{0, size, 0}, p + Vec3{0, 0, size}}})
                {
                    const SurfaceDistance d = distanceTo(leaf, t);
                    expectWellFormed(d);
                    EXPECT_NEAR(d.m_gap, -overlapDepth(h, t), 1e-12) << x << " " << y << " " << size;
                }
            }
}

class TriangleToSolid : public testing::TestWithParam<NamedShape>
{
protected:
    /// Bound on the gap added by the rounded edges of boxes and cylinders; float rounding for other shapes.
    double edgeError() const
    {
        return GetParam().m_name == "box" ? 0.74 * ConvexCore::edgeRounding * 0.25
                                          : 0.42 * ConvexCore::edgeRounding * 0.5;
    }
    ShapePtr m_shape = GetParam().m_make();
    ShapeLeaf m_leaf = leafOf(*m_shape);
    RandomPoints m_random;
};

// The gap equals that of the point with the returned barycentrics, and no sampled point of the triangle is nearer.
TEST_P(TriangleToSolid, NamesTheNearestPointOfTheTriangle)
{
    int separated = 0;
    for (int i = 0; i < 2000; ++i)
    {
        const Corners t = m_random.triangle(1.5, i % 2 ? 0.75 : 0.003);
        const SurfaceDistance d = distanceTo(m_leaf, t);
        expectWellFormed(d);
        double least = std::numeric_limits<double>::infinity();
        SurfaceDistance point;
        for (int a = 0; a <= 8; ++a)
            for (int b = 0; a + b <= 8; ++b)
            {
                ASSERT_TRUE(
                    pointShapeDistance(m_leaf, interpolate(t, {a / 8.0, b / 8.0, (8 - a - b) / 8.0}), anyGap, point));
                least = std::min(least, point.m_gap);
            }
        EXPECT_LE(d.m_gap, least + edgeError() + 1e-7);
        ASSERT_TRUE(pointShapeDistance(m_leaf, interpolate(t, d.m_barycentric), anyGap, point));
        separated += d.m_gap > 0;
        EXPECT_NEAR(d.m_gap, d.m_gap > 0 ? point.m_gap : d.m_gap, edgeError() + 1e-6);
        EXPECT_GE(point.m_gap, d.m_gap - edgeError() - 1e-6);
    }
    EXPECT_GT(separated, 500);
}

// Moving the triangle along the normal opens the gap by that distance: outside to rounding, inside until it is
// separated.
TEST_P(TriangleToSolid, IsResolvedByMovingAlongTheNormal)
{
    for (int i = 0; i < 1000; ++i)
    {
        Corners t = m_random.triangle(0.5, 0.5);
        const SurfaceDistance before = distanceTo(m_leaf, t);
        for (Vec3& x : t) x += (0.01 - before.m_gap) * before.m_normal;
        const SurfaceDistance after = distanceTo(m_leaf, t);
        EXPECT_NEAR(after.m_gap, 0.01, 5 * GetParam().m_triangleAccuracy) << i << " from " << before.m_gap;
    }
}

TEST_P(TriangleToSolid, IsInvariantUnderRigidMotion)
{
    for (int i = 0; i < 300; ++i)
    {
        const ShapeLeaf moved = leafOf(*m_shape, m_random.placement(100));
        const Corners t = m_random.triangle(1, 0.5);
        const Corners there = {moved.m_pose.toWorld(t[0]), moved.m_pose.toWorld(t[1]), moved.m_pose.toWorld(t[2])};
        EXPECT_NEAR(distanceTo(m_leaf, t).m_gap, distanceTo(moved, there).m_gap, GetParam().m_triangleAccuracy);
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, TriangleToSolid, testing::ValuesIn(convexSolids()), shapeName);

}  // namespace bullet_fem
