// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/field_distance.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "bridge/sdf_test_shapes.h"

namespace bullet_fem
{
namespace
{

constexpr double kBallOfField = 0.6;  // radius [m]

std::unique_ptr<btSdfCollisionShape> ballField()
{
    return std::unique_ptr<btSdfCollisionShape>(
        makeSdf({[](const Vec3& x) { return norm(x) - kBallOfField; }, {1, 1, 1}, 12}));
}

TEST(FieldDistance, MatchesTheBallAndItsNormal)
{
    const auto ball = ballField();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> part(-0.95, 0.95);
    for (int k = 0; k < 500; ++k)
    {
        const Vec3 x = {part(random), part(random), part(random)};
        if (norm(x) < 0.3) continue;  // the field's cubic interpolation rounds off the peak in the middle
        SurfaceDistance d;
        ASSERT_TRUE(pointFieldDistance(*ball, x, 10, d));
        EXPECT_NEAR(d.m_gap, norm(x) - kBallOfField, 1e-3);
        EXPECT_NEAR(norm(d.m_normal - (1 / norm(x)) * x), 0, 0.02);
        EXPECT_NEAR(norm(d.m_normal), 1, 1e-12);
    }
}

TEST(FieldDistance, HasTheMargin)
{
    const auto ball = ballField();
    ball->setMargin(btScalar(0.05));
    SurfaceDistance d;
    ASSERT_TRUE(pointFieldDistance(*ball, {0.8, 0, 0}, 10, d));
    EXPECT_NEAR(d.m_gap, 0.15, 1e-3);
}

TEST(FieldDistance, IsALowerBoundBeyondTheDomain)
{
    const auto ball = ballField();
    for (const Vec3& x : {Vec3{1.2, 0, 0}, Vec3{3, 2, 1}, Vec3{0, -1.05, 0.4}})
    {
        SurfaceDistance d;
        ASSERT_TRUE(pointFieldDistance(*ball, x, 10, d));
        EXPECT_GT(d.m_gap, 0);
        EXPECT_LE(d.m_gap, norm(x) - kBallOfField + 1e-3);
    }
    SurfaceDistance untouched;
    EXPECT_FALSE(pointFieldDistance(*ball, {3, 2, 1}, 0.5, untouched));
    EXPECT_EQ(untouched.m_gap, 0);
}

// The oracle is the minimum over a fine grid.
TEST(FieldDistance, TriangleDistanceIsTheMinimumOverTheTriangle)
{
    const auto ball = ballField();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> part(-1, 1);
    for (int k = 0; k < 200; ++k)
    {
        std::array<Vec3, 3> t;
        for (Vec3& corner : t) corner = {part(random), part(random), part(random)};
        double least = 1e30;
        constexpr int kSteps = 60;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; i + j <= kSteps; ++j)
            {
                const double a = i / double(kSteps), b = j / double(kSteps);
                least = std::min(least, norm(a * t[0] + b * t[1] + (1 - a - b) * t[2]) - kBallOfField);
            }
        if (least < -0.3) continue;  // near the centre the cubic field is no ball
        SurfaceDistance d;
        ASSERT_TRUE(triangleFieldDistance(*ball, t, 10, d));
        EXPECT_NEAR(d.m_gap, least, 5e-3);
        EXPECT_NEAR(d.m_barycentric[0] + d.m_barycentric[1] + d.m_barycentric[2], 1, 1e-12);
        const Vec3 at = d.m_barycentric[0] * t[0] + d.m_barycentric[1] * t[1] + d.m_barycentric[2] * t[2];
        EXPECT_NEAR(norm(at) - kBallOfField, d.m_gap, 2e-3);
    }
}

TEST(FieldDistance, DegenerateTriangleGivesTheEdgeDistance)
{
    const auto ball = ballField();
    const Vec3 a = {-0.9, 0.1, 0.7}, b = {0.8, 0.1, 0.7};
    SurfaceDistance d;
    ASSERT_TRUE(triangleFieldDistance(*ball, {a, b, a}, 10, d));
    EXPECT_NEAR(d.m_gap, std::sqrt(0.5) - kBallOfField, 2e-3);
}

TEST(FieldDistance, FieldsAreLeavesWhenTheyAreLoaded)
{
    const auto ball = ballField();
    btCollisionObject object;
    object.setCollisionShape(ball.get());
    btTransform place = btTransform::getIdentity();
    place.setOrigin({0, 0, 5});
    object.setWorldTransform(place);
    btAlignedObjectArray<ShapeLeaf> leaves;
    EXPECT_EQ(collectShapeLeaves(object, leaves), 0);
    ASSERT_EQ(leaves.size(), 1);
    EXPECT_TRUE(isSolid(*leaves[0].m_shape));
    EXPECT_FALSE(isSheet(*leaves[0].m_shape));
    SurfaceDistance d;
    ASSERT_TRUE(pointShapeDistance(leaves[0], {0, 0, 5.9}, 10, d));
    EXPECT_NEAR(d.m_gap, 0.3, 1e-3);
    EXPECT_NEAR(d.m_normal.z, 1, 1e-3);
#ifdef NDEBUG  // Bullet's own assertions stop a debug build
    btSdfCollisionShape empty;
    object.setCollisionShape(&empty);
    EXPECT_EQ(collectShapeLeaves(object, leaves), 1);
#endif
}

}  // namespace
}  // namespace bullet_fem
