// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/shape_distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "BulletCollision/CollisionShapes/btConvexPointCloudShape.h"
#include "BulletCollision/CollisionShapes/btTriangleShape.h"
#include "BulletCollision/CollisionShapes/btUniformScalingShape.h"
#include "BulletCollision/NarrowPhaseCollision/btGjkEpa2.h"
#include "bridge/bridge_test_shapes.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{

namespace
{

constexpr double anyDistance = 1e30;

SurfaceDistance distanceTo(btCollisionShape& shape, const Vec3& point)
{
    SurfaceDistance d;
    EXPECT_TRUE(pointShapeDistance(leafOf(shape), point, anyDistance, d));
    return d;
}

/// A value computed by hand. Sizes are binary fractions, so that the only error is that of Bullet's float margin.
struct HandValue
{
    const char* m_what;
    Vec3 m_point;
    double m_gap;
    Vec3 m_normal;
};

void expectHandValues(btCollisionShape& shape, const std::vector<HandValue>& values, double tolerance = 1e-7)
{
    for (const HandValue& value : values)
    {
        SCOPED_TRACE(value.m_what);
        const SurfaceDistance d = distanceTo(shape, value.m_point);
        EXPECT_NEAR(d.m_gap, value.m_gap, tolerance);
        EXPECT_NEAR(norm(d.m_normal - value.m_normal), 0, 1e-6);
        EXPECT_EQ(d.m_barycentric[0], 1);
    }
}

const double s2 = std::sqrt(0.5), s3 = std::sqrt(1.0 / 3), s5 = std::sqrt(0.2);

}  // namespace

TEST(PointShapeDistance, MatchesHandValuesForBox)
{
    btBoxShape box(btVector3(1, 2, 3));
    expectHandValues(box, {{"face", {1.5, 0.5, 1}, 0.5, {1, 0, 0}},
                           {"edge", {2, 3, 1}, std::sqrt(2), {s2, s2, 0}},
                           {"corner", {-2, -3, 4}, std::sqrt(3), {-s3, -s3, s3}},
                           {"inside", {0.5, 1.75, 0}, -0.25, {0, 1, 0}},
                           {"inside, negative side", {-0.75, 0, 0}, -0.25, {-1, 0, 0}},
                           {"centre", {0, 0, 0}, -1, {1, 0, 0}}});
    box.setLocalScaling(btVector3(2, 1, 1));
    expectHandValues(box, {{"scaled", {2.5, 0, 0}, 0.5, {1, 0, 0}}});
}

TEST(PointShapeDistance, MatchesHandValuesForSphere)
{
    btSphereShape sphere(0.5);
    expectHandValues(sphere, {{"outside", {0, 0, 2}, 1.5, {0, 0, 1}},
                              {"inside", {-0.25, 0, 0}, -0.25, {-1, 0, 0}},
                              {"centre", {0, 0, 0}, -0.5, {0, 1, 0}}});
    sphere.setLocalScaling(btVector3(2, 2, 2));
    expectHandValues(sphere, {{"scaled", {0, 0, 2}, 1, {0, 0, 1}}});
}

TEST(PointShapeDistance, MatchesHandValuesForCapsule)
{
    btCapsuleShapeX x(0.5, 2);
    expectHandValues(x, {{"side", {0.5, 0, 2}, 1.5, {0, 0, 1}},
                         {"cap", {2, 1, 0}, std::sqrt(2) - 0.5, {s2, s2, 0}},
                         {"inside", {0, -0.25, 0}, -0.25, {0, -1, 0}}});
    btCapsuleShape y(0.5, 2);
    expectHandValues(y, {{"end", {0, -2, 0}, 0.5, {0, -1, 0}}, {"side", {0, 1, 2}, 1.5, {0, 0, 1}}});
    expectHandValues(y, {{"on the end's centre", {0, 1, 0}, -0.5, {0, 0, 1}}});
    btCapsuleShapeZ z(0.5, 2);
    z.setLocalScaling(btVector3(2, 2, 2));
    expectHandValues(z, {{"scaled end", {0, 0, 4}, 1, {0, 0, 1}}, {"scaled side", {2, 0, 1}, 1, {1, 0, 0}}});
}

TEST(PointShapeDistance, MatchesHandValuesForCylinder)
{
    btCylinderShape y(btVector3(1, 2, 1));
    expectHandValues(y, {{"side", {0, 1, -1.5}, 0.5, {0, 0, -1}},
                         {"cap", {0.5, 2.5, 0}, 0.5, {0, 1, 0}},
                         {"rim", {0, -3, 2}, std::sqrt(2), {0, -s2, s2}},
                         {"inside near the side", {0.75, 0, 0}, -0.25, {1, 0, 0}},
                         {"inside near the cap", {0.25, -1.75, 0}, -0.25, {0, -1, 0}},
                         {"centre", {0, 0, 0}, -1, {0, 0, 1}}});
    btCylinderShapeX x(btVector3(2, 1, 1));
    expectHandValues(x, {{"side", {1, -1.5, 0}, 0.5, {0, -1, 0}}, {"cap", {3, 0.5, 0}, 1, {1, 0, 0}}});
    btCylinderShapeZ z(btVector3(1, 1, 2));
    z.setLocalScaling(btVector3(1, 1, 2));
    expectHandValues(z, {{"scaled cap", {0.5, 0, 5}, 1, {0, 0, 1}}, {"scaled side", {2, 0, 3}, 1, {1, 0, 0}}});
}

TEST(PointShapeDistance, MatchesHandValuesForCone)
{
    // Apex (0, 1, 0), base of radius 1 at y = -1: the slant's normal is (2, 1) / sqrt 5.
    btConeShape y(1, 2);
    y.setMargin(0);
    const Vec3 slant = {2 * s5, s5, 0};
    expectHandValues(y, {{"above the apex", {0, 1.5, 0}, 0.5, {0, 1, 0}},
                         {"slant", Vec3{0.5, 0, 0} + 0.5 * slant, 0.5, slant},
                         {"base", {0.5, -2, 0}, 1, {0, -1, 0}},
                         {"rim", {2, -2, 0}, std::sqrt(2), {s2, -s2, 0}},
                         {"beside the rim", {1.5, -1, 0}, 0.5, {1, 0, 0}},
                         {"inside near the slant", Vec3{0.5, 0, 0} - 0.125 * slant, -0.125, slant},
                         {"inside near the base", {0.25, -0.875, 0}, -0.125, {0, -1, 0}},
                         {"on the axis", {0, 0.5, 0}, -s5 / 2, {0, s5, 2 * s5}}});
    y.setMargin(0.25);
    expectHandValues(y, {{"margin around", {0.5, -2, 0}, 0.75, {0, -1, 0}}});
    btConeShapeX x(1, 2);
    x.setMargin(0);
    expectHandValues(x, {{"above the apex", {1.5, 0, 0}, 0.5, {1, 0, 0}}, {"base", {-2, 0, 0.5}, 1, {-1, 0, 0}}});
    btConeShapeZ z(1, 2);
    z.setMargin(0);
    z.setLocalScaling(btVector3(1, 1, 2));
    expectHandValues(z, {{"scaled apex", {0, 0, 2.5}, 0.5, {0, 0, 1}}, {"scaled base", {0, 0, -3}, 1, {0, 0, -1}}});
}

TEST(PointShapeDistance, MatchesHandValuesForPlane)
{
    btStaticPlaneShape plane(btVector3(3, 4, 0), 2);
    plane.setMargin(0.5);  // rigid bodies in Bullet ignore a plane's margin
    expectHandValues(plane,
                     {{"above", {0.6 * 5, 0.8 * 5, 7}, 3, {0.6, 0.8, 0}},
                      {"deep below", {-0.6 * 50, -0.8 * 50, 7}, -52, {0.6, 0.8, 0}}},
                     1e-5);
}

TEST(PointShapeDistance, HullIsItsPointsWithTheMarginAround)
{
    const ShapePtr hull = boxHull({1, 2, 3}, 0.125);
    expectHandValues(*hull,
                     {{"face", {1.5, 0.5, 1}, 0.375, {1, 0, 0}},
                      {"edge", {2, 3, 1}, std::sqrt(2) - 0.125, {s2, s2, 0}},
                      {"corner", {-2, -3, 4}, std::sqrt(3) - 0.125, {-s3, -s3, s3}},
                      {"in the margin", {0.5, 2.0625, 0}, -0.0625, {0, 1, 0}},
                      {"on a face of the hull", {0.5, 2, 0.5}, -0.125, {0, 1, 0}},
                      {"inside", {0.5, 1.75, 0}, -0.375, {0, 1, 0}},
                      {"deep inside", {-0.25, 0, 0.5}, -0.875, {-1, 0, 0}}},
                     1e-11);
    hull->setLocalScaling(btVector3(2, 1, -1));
    expectHandValues(*hull, {{"scaled", {2.5, 0, 0}, 0.375, {1, 0, 0}}}, 1e-11);
}

TEST(PointShapeDistance, MatchesHandValuesForFlatHulls)
{
    btConvexHullShape square;
    for (int i = 0; i < 4; ++i) square.addPoint(btVector3(i & 1 ? 1 : -1, 0, i & 2 ? 1 : -1));
    square.setMargin(btScalar(0.125));
    expectHandValues(square, {{"above", {0.5, 1, 0.25}, 0.875, {0, 1, 0}},
                              {"close below", {0.5, -0.0625, 0.25}, -0.0625, {0, -1, 0}},
                              {"beside", {2, 0, 0.5}, 0.875, {1, 0, 0}}});
    EXPECT_NEAR(distanceTo(square, {0.5, 0, 0.25}).m_gap, -0.125, 1e-12);  // in its plane either side is correct
    EXPECT_NEAR(std::abs(distanceTo(square, {0.5, 0, 0.25}).m_normal.y), 1, 1e-12);

    btConvexHullShape rod, dot;
    rod.addPoint(btVector3(-1, 0, 0));
    rod.addPoint(btVector3(1, 0, 0));
    rod.setMargin(btScalar(0.125));
    expectHandValues(rod, {{"side", {0.5, 1, 0}, 0.875, {0, 1, 0}}, {"end", {2, 0, 0}, 0.875, {1, 0, 0}}});
    EXPECT_NEAR(distanceTo(rod, {0.5, 0, 0}).m_normal.x, 0, 1e-12);
    dot.addPoint(btVector3(0, 0, 0));
    dot.setMargin(btScalar(0.125));
    expectHandValues(dot, {{"outside", {0, 0, 1}, 0.875, {0, 0, 1}}, {"centre", {0, 0, 0}, -0.125, {0, 1, 0}}});
}

TEST(PointShapeDistance, MatchesHandValuesForMultiSphere)
{
    const ShapePtr spheres = twoSpheres();  // radius 1/4 at x = -1/4, 1/2 at x = 1/2: the mantle's normal has x = -1/3
    const Vec3 mantle = {-1.0 / 3, 0, std::sqrt(8.0) / 3};
    expectHandValues(*spheres,
                     {{"small end", {-1.5, 0, 0}, 1, {-1, 0, 0}},
                      {"large end", {2, 0, 0}, 1, {1, 0, 0}},
                      {"mantle", Vec3{0.125, 0, 0} + 1.375 * mantle, 1, mantle},
                      {"inside the mantle", Vec3{0.125, 0, 0} + 0.25 * mantle, -0.125, mantle}},
                     1e-6);
}

TEST(PointShapeDistance, MatchesHandValuesForOtherConvexShapes)
{
    const btVector3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    btConvexPointCloudShape cloud(const_cast<btVector3*>(corners), 4, btVector3(2, 2, 2));
    cloud.setMargin(0.125);
    expectHandValues(cloud, {{"face", {0.5, 0.5, -1}, 0.875, {0, 0, -1}}, {"corner", {4, 0, 0}, 1.875, {1, 0, 0}}});

    btTriangleShape triangle(corners[1], corners[2], corners[3]);
    triangle.setMargin(0.125);
    expectHandValues(triangle, {{"side", {1, 1, 1}, 2 * s3 - 0.125, {s3, s3, s3}},
                                {"other side", {-1, -1, -1}, 4 * s3 - 0.125, {-s3, -s3, -s3}},
                                {"corner", {2, 0, 0}, 0.875, {1, 0, 0}}});

    btSphereShape sphere(0.5);
    btUniformScalingShape large(&sphere, 3);
    expectHandValues(large, {{"scaled sphere", {0, 0, 2}, 0.5, {0, 0, 1}}});
}

TEST(PointShapeDistance, LeavesTheResultAloneBeyondTheLimit)
{
    btBoxShape box(btVector3(1, 1, 1));
    const ShapePtr hull = boxHull({1, 1, 1}, 0);
    for (btCollisionShape* shape : {static_cast<btCollisionShape*>(&box), hull.get()})
    {
        const ShapeLeaf leaf = leafOf(*shape);
        SurfaceDistance d;
        d.m_gap = 42;
        EXPECT_FALSE(pointShapeDistance(leaf, {1.5, 0, 0}, 0.25, d));
        EXPECT_FALSE(pointShapeDistance(leaf, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, 0.25, d));
        EXPECT_FALSE(pointShapeDistance(leaf, {std::numeric_limits<double>::infinity(), 0, 0}, anyDistance, d));
        EXPECT_FALSE(pointShapeDistance(leaf, {1e200, 0, 0}, std::numeric_limits<double>::infinity(), d));  // overflows
        EXPECT_EQ(d.m_gap, 42);
        EXPECT_TRUE(pointShapeDistance(leaf, {1.125, 0, 0}, 0.25, d));
        EXPECT_NEAR(d.m_gap, 0.125, 1e-7);
    }
}

class EveryConvexSolid : public testing::TestWithParam<NamedShape>
{
protected:
    ShapePtr m_shape = GetParam().m_make();
    ShapeLeaf m_leaf = leafOf(*m_shape);
    RandomPoints m_random;
};

// Bullet rounds edges with the margin, here 1 mm: at a corner its gap is up to (sqrt 3 - 1) mm larger. Its GJK stops at
// a relative 1e-4, or when two support points are within 1 cm: 1e-4 m on a round surface of this size.
TEST_P(EveryConvexSolid, AgreesWithBulletsGjkOutside)
{
    m_shape->setMargin(btScalar(1e-3));
    m_leaf = leafOf(*m_shape);
    const auto& convex = static_cast<const btConvexShape&>(*m_shape);
    int outside = 0;
    for (int i = 0; i < 1000; ++i)
    {
        const Vec3 point = m_random.inBox(1.5);
        SurfaceDistance d;
        ASSERT_TRUE(pointShapeDistance(m_leaf, point, anyDistance, d));
        const bool isOutside = d.m_gap > 0.02;
        outside += isOutside;
        btGjkEpaSolver2::sResults results;
        const double bullets = isOutside ? btGjkEpaSolver2::SignedDistance(bulletVector(point), 0, &convex,
                                                                           btTransform::getIdentity(), results)
                                         : d.m_gap;
        EXPECT_NEAR(d.m_gap, bullets, 0.74e-3 + 1e-4 + 1e-4 * std::abs(d.m_gap))
            << point.x << " " << point.y << " " << point.z;
    }
    EXPECT_GT(outside, 500);
}

// The gap grows by the step along its normal, outside and inside; inwards the law ends at the medial axis.
TEST_P(EveryConvexSolid, NormalIsTheGradient)
{
    const double step = 1e-4, accuracy = GetParam().m_pointAccuracy;
    for (int i = 0; i < 300; ++i)
    {
        const Vec3 point = m_random.inBox(1);
        SurfaceDistance d, forward, backward;
        ASSERT_TRUE(pointShapeDistance(m_leaf, point, anyDistance, d));
        ASSERT_NEAR(norm(d.m_normal), 1, 1e-12);
        ASSERT_TRUE(pointShapeDistance(m_leaf, point + step * d.m_normal, anyDistance, forward));
        ASSERT_TRUE(pointShapeDistance(m_leaf, point - step * d.m_normal, anyDistance, backward));
        EXPECT_NEAR(forward.m_gap - d.m_gap, step, 1e-6 * step + accuracy) << "gap " << d.m_gap;
        EXPECT_LE(d.m_gap - backward.m_gap, step * (1 + 1e-6) + accuracy);
    }
}

// Bullet's float rotation is orthonormalised here, so that distances equal those of the local frame to double rounding.
TEST_P(EveryConvexSolid, IsInvariantUnderRigidMotion)
{
    for (int i = 0; i < 300; ++i)
    {
        const ShapeLeaf moved = leafOf(*m_shape, m_random.placement(3));
        const Vec3 point = m_random.inBox(1);
        SurfaceDistance here, there;
        ASSERT_TRUE(pointShapeDistance(m_leaf, point, anyDistance, here));
        ASSERT_TRUE(pointShapeDistance(moved, moved.m_pose.toWorld(point), anyDistance, there));
        EXPECT_NEAR(here.m_gap, there.m_gap, GetParam().m_pointAccuracy);
        EXPECT_NEAR(norm(moved.m_pose.m_rotation * here.m_normal - there.m_normal), 0, 1e-4);
    }
}

// Points on a lattice of 1/1024 m are exact at 100 m, so that local coordinates are bitwise equal.
TEST_P(EveryConvexSolid, HasNoNoiseFarFromTheOrigin)
{
    const ShapeLeaf far = leafOf(*m_shape, btTransform(btQuaternion::getIdentity(), btVector3(100, -100, 100)));
    for (int i = 0; i < 300; ++i)
    {
        Vec3 point = m_random.inBox(1);
        for (int k = 0; k < 3; ++k) point[k] = std::round(point[k] * 1024) / 1024;
        SurfaceDistance here, there;
        ASSERT_TRUE(pointShapeDistance(m_leaf, point, anyDistance, here));
        ASSERT_TRUE(pointShapeDistance(far, point + Vec3{100, -100, 100}, anyDistance, there));
        EXPECT_NEAR(here.m_gap, there.m_gap, 1e-12);
        EXPECT_NEAR(norm(here.m_normal - there.m_normal), 0, 1e-12);
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryConvexSolid, testing::ValuesIn(convexSolids()), shapeName);

}  // namespace bullet_fem
