// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <limits>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btConvexHullShape.h"
#include "BulletCollision/CollisionShapes/btMultiSphereShape.h"
#include "BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h"
#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_bridge/geometry/shapes/shape_distance.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{

namespace
{

/// Bullet's rotations are orthonormal to float precision only. One Newton step of the polar decomposition, R <- R (3 I
/// - R^T R) / 2, squares that error. A basis that is far from a rotation (scaled by a user) is left unchanged.
Mat3 orthonormalised(const Mat3& R)
{
    const Mat3 error = transposeTimes(R, R) - Mat3::identity();
    return squaredNorm(error) < 1e-6 ? R - 0.5 * (R * error) : R;
}

Pose poseOf(const btTransform& transform)
{
    return {orthonormalised(mat3(transform.getBasis())), vec3(transform.getOrigin())};
}

/// The mesh, if the class is Bullet's: a program's own class may use the type number of Bullet's.
const btBvhTriangleMeshShape* bulletsMesh(const btCollisionShape& shape)
{
    return dynamic_cast<const btBvhTriangleMeshShape*>(&shape);
}

/// Bullet divides by the scaling, and searches the tree without checking that it exists.
bool hasUsableTree(const btCollisionShape& shape)
{
    if (shape.getShapeType() != SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE)
        return !bulletsMesh(shape) ||
               const_cast<btBvhTriangleMeshShape*>(bulletsMesh(shape))->getOptimizedBvh() != nullptr;
    const auto* scaled = dynamic_cast<const btScaledBvhTriangleMeshShape*>(&shape);
    if (!scaled) return true;
    const Vec3 scale = vec3(scaled->getLocalScaling());
    return scale.x * scale.y * scale.z != 0 && isFinite(scale) && hasUsableTree(*scaled->getChildShape());
}

/// Bullet's bounds are floats. They are computed about the leaf's origin, so they stay precise far from the world's
/// origin.
void setBounds(ShapeLeaf& leaf)
{
    if (isPlane(leaf))
    {
        const double infinity = std::numeric_limits<double>::infinity();
        leaf.m_boundsMin = {-infinity, -infinity, -infinity};
        leaf.m_boundsMax = {infinity, infinity, infinity};
        return;
    }
    btVector3 boundsMin, boundsMax;
    leaf.m_shape->getAabb(btTransform(bulletMatrix(leaf.m_pose.m_rotation), btVector3(0, 0, 0)), boundsMin, boundsMax);
    // Bullet omits the margin of scaled and of GImpact meshes.
    const double margin = leaf.m_shape->isConcave() ? double(leaf.m_shape->getMargin()) : 0;
    const double rounding = margin + 1e-6 * (norm(vec3(boundsMin)) + norm(vec3(boundsMax)));
    const Vec3 padding = {rounding, rounding, rounding};
    leaf.m_boundsMin = leaf.m_pose.m_origin + vec3(boundsMin) - padding;
    leaf.m_boundsMax = leaf.m_pose.m_origin + vec3(boundsMax) + padding;
}

int collect(const btCollisionShape& shape, const Pose& pose, btAlignedObjectArray<ShapeLeaf>& leaves);

/// A GImpact mesh consists of parts, a GImpact compound of children. False if the shape is neither.
bool collectGImpact(const btCollisionShape& shape, const Pose& pose, btAlignedObjectArray<ShapeLeaf>& leaves,
                    int& unknown)
{
    if (shape.getShapeType() != GIMPACT_SHAPE_PROXYTYPE) return false;
    const auto& gimpact = static_cast<const btGImpactShapeInterface&>(shape);
    if (gimpact.getGImpactShapeType() == CONST_GIMPACT_TRIMESH_SHAPE)
    {
        const auto& mesh = static_cast<const btGImpactMeshShape&>(gimpact);
        for (int i = 0; i < mesh.getMeshPartCount(); ++i) unknown += collect(*mesh.getMeshPart(i), pose, leaves);
        return true;
    }
    if (gimpact.getGImpactShapeType() != CONST_GIMPACT_COMPOUND_SHAPE) return false;
    for (int i = 0; i < gimpact.getNumChildShapes(); ++i)
    {
        const Pose child = gimpact.childrenHasTransform() ? poseOf(gimpact.getChildTransform(i)) : Pose();
        unknown += collect(*gimpact.getChildShape(i),
                           {pose.m_rotation * child.m_rotation, pose.toWorld(child.m_origin)}, leaves);
    }
    return true;
}

int collect(const btCollisionShape& shape, const Pose& pose, btAlignedObjectArray<ShapeLeaf>& leaves)
{
    int unknown = 0;
    if (shape.isCompound())
    {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i)
        {
            const Pose child = poseOf(compound.getChildTransform(i));
            unknown += collect(*compound.getChildShape(i),
                               {pose.m_rotation * child.m_rotation, pose.toWorld(child.m_origin)}, leaves);
        }
        return unknown;
    }
    if (collectGImpact(shape, pose, leaves, unknown)) return unknown;
    if (!isKnownShape(shape)) return 1;
    ShapeLeaf leaf;
    leaf.m_shape = &shape;
    leaf.m_pose = pose;
    setBounds(leaf);
    leaves.push_back(leaf);
    return 0;
}

}  // namespace

bool isKnownShape(const btCollisionShape& shape)
{
    switch (shape.getShapeType())
    {
        case STATIC_PLANE_PROXYTYPE:
        case TERRAIN_SHAPE_PROXYTYPE:
            return true;
        case TRIANGLE_MESH_SHAPE_PROXYTYPE:
        case MULTIMATERIAL_TRIANGLE_MESH_PROXYTYPE:
        case SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE:
            return hasUsableTree(shape);
        case GIMPACT_SHAPE_PROXYTYPE:
            return static_cast<const btGImpactShapeInterface&>(shape).getGImpactShapeType() ==
                   CONST_GIMPACT_TRIMESH_SHAPE_PART;
        case CONVEX_HULL_SHAPE_PROXYTYPE:
            return static_cast<const btConvexHullShape&>(shape).getNumPoints() > 0;
        case MULTI_SPHERE_SHAPE_PROXYTYPE:
            return static_cast<const btMultiSphereShape&>(shape).getSphereCount() > 0;
        case EMPTY_SHAPE_PROXYTYPE:
            return false;
        case CUSTOM_CONCAVE_SHAPE_TYPE:  // the type number of fields, too
            if (const btSdfCollisionShape* field = fieldOf(shape)) return isLoaded(*field);
            [[fallthrough]];
        default:
            return shape.isConvex() || dynamic_cast<const btConcaveShape*>(&shape);
    }
}

bool isPlane(const ShapeLeaf& leaf)
{
    return leaf.m_shape->getShapeType() == STATIC_PLANE_PROXYTYPE;
}

int collectShapeLeaves(const btCollisionObject& object, btAlignedObjectArray<ShapeLeaf>& leaves)
{
    const btCollisionShape* shape = object.getCollisionShape();
    return shape ? collect(*shape, poseOf(object.getWorldTransform()), leaves) : 0;
}

}  // namespace bullet_fem
