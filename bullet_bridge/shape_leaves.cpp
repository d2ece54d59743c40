// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <limits>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btConvexHullShape.h"
#include "BulletCollision/CollisionShapes/btMultiSphereShape.h"
#include "bullet_bridge/bullet_vectors.h"
#include "bullet_bridge/shape_distance.h"

namespace bullet_fem
{

namespace
{

/// Bullet's rotations are orthonormal to float precision only. One Newton step of the polar decomposition,
/// R <- R (3 I - R^T R) / 2, squares that error; a basis that is no rotation at all (scaled by a user) stays as it is.
Mat3 orthonormalised(const Mat3& R)
{
    const Mat3 error = transposeTimes(R, R) - Mat3::identity();
    return squaredNorm(error) < 1e-6 ? R - 0.5 * (R * error) : R;
}

Pose poseOf(const btTransform& transform)
{
    const btMatrix3x3& basis = transform.getBasis();
    return {orthonormalised(
                Mat3::fromColumns(vec3(basis.getColumn(0)), vec3(basis.getColumn(1)), vec3(basis.getColumn(2)))),
            vec3(transform.getOrigin())};
}

bool isKnown(const btCollisionShape& shape)
{
    switch (shape.getShapeType())
    {
        case STATIC_PLANE_PROXYTYPE:
            return true;
        case CONVEX_HULL_SHAPE_PROXYTYPE:
            return static_cast<const btConvexHullShape&>(shape).getNumPoints() > 0;
        case MULTI_SPHERE_SHAPE_PROXYTYPE:
            return static_cast<const btMultiSphereShape&>(shape).getSphereCount() > 0;
        default:
            return shape.isConvex();
    }
}

/// Bullet's bounds are floats: asked for about the leaf's own origin, they keep their precision far from the world's.
void setBounds(ShapeLeaf& leaf)
{
    if (leaf.m_shape->getShapeType() == STATIC_PLANE_PROXYTYPE)
    {
        const double infinity = std::numeric_limits<double>::infinity();
        leaf.m_boundsMin = {-infinity, -infinity, -infinity};
        leaf.m_boundsMax = {infinity, infinity, infinity};
        return;
    }
    const Mat3& R = leaf.m_pose.m_rotation;
    const btMatrix3x3 basis(btScalar(R(0, 0)), btScalar(R(0, 1)), btScalar(R(0, 2)), btScalar(R(1, 0)),
                            btScalar(R(1, 1)), btScalar(R(1, 2)), btScalar(R(2, 0)), btScalar(R(2, 1)),
                            btScalar(R(2, 2)));
    btVector3 boundsMin, boundsMax;
    leaf.m_shape->getAabb(btTransform(basis, btVector3(0, 0, 0)), boundsMin, boundsMax);
    const double rounding = 1e-6 * (norm(vec3(boundsMin)) + norm(vec3(boundsMax)));
    const Vec3 padding = {rounding, rounding, rounding};
    leaf.m_boundsMin = leaf.m_pose.m_origin + vec3(boundsMin) - padding;
    leaf.m_boundsMax = leaf.m_pose.m_origin + vec3(boundsMax) + padding;
}

int collect(const btCollisionShape& shape, const Pose& pose, btAlignedObjectArray<ShapeLeaf>& leaves)
{
    if (shape.isCompound())
    {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        int unknown = 0;
        for (int i = 0; i < compound.getNumChildShapes(); ++i)
        {
            const Pose child = poseOf(compound.getChildTransform(i));
            unknown += collect(*compound.getChildShape(i),
                               {pose.m_rotation * child.m_rotation, pose.toWorld(child.m_origin)}, leaves);
        }
        return unknown;
    }
    if (!isKnown(shape)) return 1;
    ShapeLeaf leaf;
    leaf.m_shape = &shape;
    leaf.m_pose = pose;
    setBounds(leaf);
    leaves.push_back(leaf);
    return 0;
}

}  // namespace

int collectShapeLeaves(const btCollisionObject& object, btAlignedObjectArray<ShapeLeaf>& leaves)
{
    const btCollisionShape* shape = object.getCollisionShape();
    return shape ? collect(*shape, poseOf(object.getWorldTransform()), leaves) : 0;
}

}  // namespace bullet_fem
