// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/rolling_curvature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bridge/bridge_test_shapes.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kRadius = 0.2;        // [m]
const Vec3 kDown = {0, 0, -1};         // normal out of a shape at its lowest point
const Vec3 kRolling = {0.05, 5, 0.2};  // along x, with some wobble and yaw [rad/s]

double curvatureOf(btCollisionShape& shape, const Vec3& spin = kRolling, const Vec3& normal = kDown,
                   const btTransform& transform = btTransform::getIdentity())
{
    return rollingCurvature(leafOf(shape, transform), normal, spin);
}

// A regular prism along y with its first corner at `turn` [rad], and no margin.
std::unique_ptr<btConvexHullShape> prism(int facets, double turn)
{
    auto hull = std::make_unique<btConvexHullShape>();
    for (int k = 0; k < facets; ++k)
        for (const double y : {-0.1, 0.1})
        {
            const double angle = turn + 2 * std::acos(-1.0) * k / facets;
            hull->addPoint(bulletVector({kRadius * std::cos(angle), y, kRadius * std::sin(angle)}));
        }
    hull->setMargin(0);
    return hull;
}

TEST(RollingCurvature, IsThatOfRoundShapesAcrossTheirAxis)
{
    btSphereShape sphere{btScalar(kRadius)};
    btCylinderShape cylinder(bulletVector({kRadius, 0.1, kRadius}));
    btCapsuleShape capsule{btScalar(kRadius), btScalar(0.5)};
    for (btCollisionShape* shape : {static_cast<btCollisionShape*>(&sphere), static_cast<btCollisionShape*>(&cylinder),
                                    static_cast<btCollisionShape*>(&capsule)})
        EXPECT_NEAR(curvatureOf(*shape), 1 / kRadius, 0.03 / kRadius) << shape->getName();
    btCylinderShapeX turned(bulletVector({0.1, kRadius, kRadius}));
    const btTransform place(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI), btVector3(3, 2, 1));
    EXPECT_NEAR(curvatureOf(turned, kRolling, kDown, place), 1 / kRadius, 0.03 / kRadius);
}

TEST(RollingCurvature, IsZeroAlongTheAxisAndOnFlatSides)
{
    btCylinderShape cylinder(bulletVector({kRadius, 0.1, kRadius}));
    btCapsuleShape capsule{btScalar(kRadius), btScalar(0.5)};
    btBoxShape box(bulletVector({kRadius, kRadius, kRadius}));
    btStaticPlaneShape plane(btVector3(0, 0, -1), 0);
    const Vec3 tipping = {5, 0, 0};
    EXPECT_EQ(curvatureOf(cylinder, tipping), 0);
    EXPECT_EQ(curvatureOf(capsule, tipping), 0);
    EXPECT_EQ(curvatureOf(cylinder, tipping, {0, -1, 0}), 0);
    EXPECT_EQ(curvatureOf(box), 0);
    EXPECT_EQ(curvatureOf(plane), 0);
}

TEST(RollingCurvature, IsZeroWithoutSpinAcrossTheNormal)
{
    btCylinderShape cylinder(bulletVector({kRadius, 0.1, kRadius}));
    EXPECT_EQ(curvatureOf(cylinder, {0, 0, 0}), 0);
    EXPECT_EQ(curvatureOf(cylinder, {0, 0, 7}), 0);
    EXPECT_EQ(curvatureOf(cylinder, {std::nan(""), 0, 0}), 0);
    btSphereShape sphere{btScalar(kRadius)};
    EXPECT_NEAR(curvatureOf(sphere, {0, 0, 0}), 1 / kRadius, 1e-5 / kRadius);
}

// Ten directions around the axis meet different corners of prisms of eleven facets and more at any angle.
TEST(RollingCurvature, NeedsMoreThanTenFacets)
{
    for (int k = 0; k < 20; ++k)
    {
        const double turn = 0.05 * k;
        for (const int facets : {3, 4, 6, 8, 9})
            EXPECT_EQ(curvatureOf(*prism(facets, turn)), 0) << facets << " facets, " << turn << " rad";
        for (const int facets : {11, 12, 14, 16, 24, 60})
        {
            const double curvature = curvatureOf(*prism(facets, turn));
            EXPECT_GT(curvature, 0.75 / kRadius) << facets << " facets, " << turn << " rad";
            EXPECT_LT(curvature, 1.4 / kRadius) << facets << " facets, " << turn << " rad";
        }
    }
}

TEST(RollingCurvature, HasTheMarginOfHulls)
{
    auto hull = prism(60, 0);
    hull->setMargin(btScalar(0.05));
    EXPECT_NEAR(curvatureOf(*hull, {0, 5, 0}), 1 / (kRadius + 0.05), 0.1 / kRadius);
}

TEST(RollingCurvature, IsZeroForAPointWithoutMargin)
{
    btConvexHullShape point;
    point.addPoint(btVector3(0, 0, 0));
    point.setMargin(0);
    EXPECT_EQ(curvatureOf(point), 0);
}

}  // namespace
}  // namespace bullet_fem
