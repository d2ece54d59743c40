// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/shape_mark.h"

#include <gtest/gtest.h>

#include <limits>

#include "BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h"
#include "btBulletCollisionCommon.h"

namespace bullet_fem
{
namespace
{

const Vec3 kLow = {-1, -1, -1}, kHigh = {1, 1, 1};

std::uint64_t markAt(const btCollisionShape& shape, const btVector3& origin = {0, 0, 0})
{
    return markOfShape(shape, btTransform(btQuaternion::getIdentity(), origin), kLow, kHigh);
}

btTransform moved(btScalar x)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 0));
}

TEST(ShapeMark, IsEqualForEqualShapesElsewhere)
{
    const btBoxShape box(btVector3(1, 2, 3)), same(btVector3(1, 2, 3)), other(btVector3(1, 2, btScalar(3.01)));
    EXPECT_EQ(markAt(box), markAt(same));
    EXPECT_NE(markAt(box), markAt(other));
}

TEST(ShapeMark, TellsAxesOfEqualBounds)
{
    const btVector3 half(1, 1, 1);
    const btCylinderShapeX alongX(half);
    const btCylinderShapeZ alongZ(half);
    EXPECT_NE(markAt(alongX), markAt(alongZ));
}

TEST(ShapeMark, IsIndependentOfCompoundChildOrder)
{
    btBoxShape box(btVector3(1, 1, 1));
    btSphereShape ball(1);
    for (const bool tree : {true, false})
    {
        btCompoundShape one(tree), two(tree);
        one.addChildShape(moved(0), &box);
        one.addChildShape(moved(btScalar(0.5)), &ball);
        two.addChildShape(moved(btScalar(0.5)), &ball);
        two.addChildShape(moved(0), &box);
        EXPECT_EQ(markAt(one), markAt(two));
    }
}

TEST(ShapeMark, CoversNestedCompoundChildrenInsideTheBox)
{
    btBoxShape box(btVector3(1, 1, 1)), far(btVector3(1, 1, 1));
    btCompoundShape inner, outer;
    inner.addChildShape(moved(-10), &box);
    inner.addChildShape(moved(10), &far);
    outer.addChildShape(moved(10), &inner);
    const std::uint64_t before = markAt(outer);
    far.setLocalScaling(btVector3(1, 2, 1));
    EXPECT_EQ(markAt(outer), before);
    box.setLocalScaling(btVector3(1, 2, 1));
    EXPECT_NE(markAt(outer), before);
}

TEST(ShapeMark, DependsOnTheScalingOfAMesh)
{
    btTriangleMesh triangles;
    triangles.addTriangle({-2, -2, 0}, {2, -2, 0}, {0, 2, 0});
    btBvhTriangleMeshShape mesh(&triangles, false);
    btScaledBvhTriangleMeshShape scaled(&mesh, btVector3(1, 1, 1));
    const std::uint64_t before = markAt(scaled);
    scaled.setLocalScaling(btVector3(btScalar(1.1), 1, 1));
    EXPECT_NE(markAt(scaled), before);
    EXPECT_NE(markAt(scaled), markAt(scaled, {0, 0, 5}));  // not there
}

TEST(ShapeMark, AcceptsInvalidBoxes)
{
    const double infinity = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();
    btTriangleMesh triangles;
    triangles.addTriangle({-2, -2, 0}, {2, -2, 0}, {0, 2, 0});
    btBvhTriangleMeshShape mesh(&triangles, false);
    btCompoundShape compound;
    compound.addChildShape(moved(0), &mesh);
    const std::uint64_t nothing = markAt(compound, {100, 0, 0});
    for (const double bad : {infinity, none})
    {
        EXPECT_EQ(markOfShape(compound, moved(0), {bad, 0, 0}, {bad, 0, 0}), nothing);
        EXPECT_EQ(markOfShape(compound, moved(0), {-bad, -bad, -bad}, {bad, bad, bad}), nothing);
    }
    EXPECT_NE(markOfShape(compound, moved(0), {-1e30, -1e30, -1e30}, {1e30, 1e30, 1e30}), nothing);
    EXPECT_EQ(markOfShape(compound, moved(0), kHigh, kLow), nothing);
    EXPECT_EQ(markOfShape(compound, moved(std::numeric_limits<btScalar>::quiet_NaN()), kLow, kHigh), nothing);
}

}  // namespace
}  // namespace bullet_fem
