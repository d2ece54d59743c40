// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btEmptyShape.h"
#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"
#include "BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btTriangleMesh.h"
#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "bridge/bridge_test_shapes.h"

namespace bullet_fem
{

namespace
{

btTransform moved(double x, double y, double z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

/// A quarter turn about z: exact enough in float to be compared with 1e-7.
btTransform turned(double x, double y, double z)
{
    return btTransform(btMatrix3x3(0, -1, 0, 1, 0, 0, 0, 0, 1), btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

struct OneTriangle : btTriangleMesh
{
    OneTriangle() { addTriangle(btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0)); }
};

struct Collected
{
    btAlignedObjectArray<ShapeLeaf> m_leaves;
    int m_unknown = 0;

    Collected(btCollisionShape& shape, const btTransform& transform)
    {
        btCollisionObject object;
        object.setCollisionShape(&shape);
        object.setWorldTransform(transform);
        m_unknown = collectShapeLeaves(object, m_leaves);
    }
    double gap(int leaf, const Vec3& point) const
    {
        SurfaceDistance d;
        EXPECT_TRUE(pointShapeDistance(m_leaves[leaf], point, 1e30, d));
        return d.m_gap;
    }
};

}  // namespace

TEST(ShapeLeaves, OneShapeIsOneLeafAndIsAppended)
{
    btBoxShape box(btVector3(1, 2, 3));
    btCollisionObject object;
    object.setCollisionShape(&box);
    object.setWorldTransform(turned(10, 0, 0));
    btAlignedObjectArray<ShapeLeaf> leaves;
    EXPECT_EQ(collectShapeLeaves(object, leaves), 0);
    EXPECT_EQ(collectShapeLeaves(object, leaves), 0);
    ASSERT_EQ(leaves.size(), 2);
    EXPECT_EQ(leaves[1].m_shape, &box);
    EXPECT_NEAR(norm(leaves[1].m_boundsMin - Vec3{8, -1, -3}), 0, 1e-4);  // turned, so 2 along x and 1 along y
    EXPECT_NEAR(norm(leaves[1].m_boundsMax - Vec3{12, 1, 3}), 0, 1e-4);
}

TEST(ShapeLeaves, AnObjectWithoutAShapeHasNone)
{
    btCollisionObject object;
    btAlignedObjectArray<ShapeLeaf> leaves;
    EXPECT_EQ(collectShapeLeaves(object, leaves), 0);
    EXPECT_EQ(leaves.size(), 0);
}

TEST(ShapeLeaves, BoundsHoldTheShapeFarFromTheOrigin)
{
    btSphereShape sphere(btScalar(0.1));
    const ShapeLeaf leaf = leafOf(sphere, moved(1000.3, 0, 0));  // floats are 6e-5 m apart there
    const double x = btScalar(1000.3), radius = btScalar(0.1);
    EXPECT_LE(leaf.m_boundsMin.x, x - radius);
    EXPECT_GE(leaf.m_boundsMax.x, x + radius);
    EXPECT_NEAR(leaf.m_boundsMax.x, x + radius, 1e-6);
}

TEST(ShapeLeaves, RotationsAreOrthonormalInDouble)
{
    btSphereShape sphere(1);
    RandomPoints random;
    for (int i = 0; i < 100; ++i)
    {
        const Mat3 R = leafOf(sphere, random.placement(1)).m_pose.m_rotation;
        EXPECT_LT(std::sqrt(squaredNorm(transposeTimes(R, R) - Mat3::identity())), 1e-12);
        EXPECT_NEAR(determinant(R), 1, 1e-12);
    }
}

TEST(ShapeLeaves, CompoundsPlaceTheirChildren)
{
    btSphereShape sphere(1);
    btBoxShape box(btVector3(1, 2, 3));
    btCompoundShape compound;
    compound.addChildShape(moved(4, 0, 0), &sphere);
    compound.addChildShape(turned(0, 8, 0), &box);
    const Collected c(compound, turned(100, 0, 0));
    EXPECT_EQ(c.m_unknown, 0);
    ASSERT_EQ(c.m_leaves.size(), 2);
    // A rotation by 90 degrees: x goes to y and y to -x.
    EXPECT_NEAR(c.gap(0, {100, 4, 3}), 2, 1e-12);
    EXPECT_NEAR(c.gap(0, {100, 4, -3}), 2, 1e-12);
    EXPECT_NEAR(c.gap(1, {100 - 8 + 3, 0, 0}), 2, 1e-6);  // turned twice: half extents 1, 2, 3 again
    EXPECT_NEAR(c.gap(1, {100 - 8, 5, 0}), 3, 1e-6);
}

TEST(ShapeLeaves, CompoundsNestToAnyDepth)
{
    btSphereShape sphere(1);
    btCompoundShape inner, middle, outer;
    inner.addChildShape(moved(1, 0, 0), &sphere);
    middle.addChildShape(turned(2, 0, 0), &inner);
    middle.addChildShape(moved(0, 0, 30), &sphere);
    outer.addChildShape(turned(0, 0, 4), &middle);
    const Collected c(outer, moved(0, 100, 0));
    ASSERT_EQ(c.m_leaves.size(), 2);
    // inner: (1,0,0); in middle: (2,1,0); in outer: (-1,2,4); in the world: (-1,102,4).
    EXPECT_NEAR(norm(c.m_leaves[0].m_pose.m_origin - Vec3{-1, 102, 4}), 0, 1e-12);
    EXPECT_NEAR(c.gap(0, {-1, 102, 7}), 2, 1e-12);
    EXPECT_NEAR(c.gap(1, {0, 100, 37}), 2, 1e-12);
}

TEST(ShapeLeaves, ScaledCompoundsAreSeenScaled)
{
    btSphereShape sphere(1);
    btCompoundShape compound;
    compound.addChildShape(moved(4, 0, 0), &sphere);
    compound.setLocalScaling(btVector3(2, 2, 2));
    const Collected c(compound, moved(0, 0, 0));
    EXPECT_NEAR(c.gap(0, {8, 0, 5}), 3, 1e-12);
}

TEST(ShapeLeaves, ConcaveShapesAreLeavesAndGImpactIsItsParts)
{
    OneTriangle mesh;
    btBvhTriangleMeshShape triangles(&mesh, true);
    btScaledBvhTriangleMeshShape scaled(&triangles, btVector3(2, 2, 2));
    btGImpactMeshShape gimpact(&mesh);
    gimpact.updateBound();
    const btScalar heights[4] = {0, 0, 0, 0};
    btHeightfieldTerrainShape terrain(2, 2, heights, 1, -1, 1, 1, PHY_FLOAT, false);
    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    btCompoundShape compound;
    for (btCollisionShape* shape : std::initializer_list<btCollisionShape*>{&triangles, &scaled, &gimpact, &terrain})
        compound.addChildShape(moved(0, 0, 1), shape);
    compound.addChildShape(moved(0, 0, 0), &plane);
    const Collected c(compound, moved(0, 0, 0));
    EXPECT_EQ(c.m_unknown, 0);
    ASSERT_EQ(c.m_leaves.size(), 5);
    EXPECT_EQ(c.m_leaves[0].m_shape, &triangles);
    EXPECT_EQ(c.m_leaves[1].m_shape, &scaled);
    EXPECT_EQ(c.m_leaves[2].m_shape, gimpact.getMeshPart(0));
    EXPECT_EQ(c.m_leaves[3].m_shape, &terrain);
    EXPECT_EQ(c.m_leaves[2].m_pose.m_origin.z, 1);
    EXPECT_NEAR(c.m_leaves[1].m_boundsMax.x, 2, 1e-4);
    EXPECT_TRUE(std::isinf(c.m_leaves[4].m_boundsMax.x));
}

TEST(ShapeLeaves, AGImpactCompoundIsItsChildren)
{
    btSphereShape sphere(1);
    btGImpactCompoundShape children;
    children.addChildShape(moved(0, 0, 5), &sphere);
    children.updateBound();
    const Collected c(children, moved(1, 0, 0));
    EXPECT_EQ(c.m_unknown, 0);
    EXPECT_NEAR(c.gap(0, {1, 0, 8}), 2, 1e-12);
}

TEST(ShapeLeaves, BoundsOfScaledMeshesHaveTheirOwnMargin)
{
    OneTriangle mesh;
    btBvhTriangleMeshShape triangles(&mesh, true);
    btScaledBvhTriangleMeshShape scaled(&triangles, btVector3(2, 2, 2));
    scaled.setMargin(btScalar(0.5));
    const Collected c(scaled, moved(0, 0, 0));
    EXPECT_GE(c.m_leaves.at(0).m_boundsMax.z, 0.5);
}

TEST(ShapeLeaves, UnknownKindsAreCountedAndLeftOut)
{
    OneTriangle mesh;
    btBvhTriangleMeshShape noTree(&mesh, true, false);
    btEmptyShape empty;
    btConvexHullShape noPoints;
    btSphereShape sphere(1);
    btCompoundShape compound;
    for (btCollisionShape* shape : std::initializer_list<btCollisionShape*>{&noTree, &empty, &noPoints, &sphere})
        compound.addChildShape(moved(0, 0, 0), shape);
    const Collected c(compound, moved(0, 0, 0));
    EXPECT_EQ(c.m_unknown, 3);
    ASSERT_EQ(c.m_leaves.size(), 1);
    EXPECT_EQ(c.m_leaves[0].m_shape, &sphere);
}

}  // namespace bullet_fem
