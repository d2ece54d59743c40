// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/shape_distance.h"

#include <cmath>

#include "BulletCollision/CollisionShapes/btBoxShape.h"
#include "BulletCollision/CollisionShapes/btCapsuleShape.h"
#include "BulletCollision/CollisionShapes/btConeShape.h"
#include "BulletCollision/CollisionShapes/btCylinderShape.h"
#include "BulletCollision/CollisionShapes/btSphereShape.h"
#include "BulletCollision/CollisionShapes/btStaticPlaneShape.h"
#include "bullet_bridge/geometry/shapes/convex_distance.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_bridge/geometry/shapes/primitive_distance.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{

namespace
{

/// Closed-form distance to a shape in its frame. False for shapes without one.
bool primitiveDistance(const btCollisionShape& shape, const Vec3& p, PointDistance& d)
{
    switch (shape.getShapeType())
    {
        case BOX_SHAPE_PROXYTYPE:
            d = boxDistance(p, vec3(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin()));
            return true;
        case SPHERE_SHAPE_PROXYTYPE:
            d = sphereDistance(p, static_cast<const btSphereShape&>(shape).getRadius());
            return true;
        case CAPSULE_SHAPE_PROXYTYPE:
        {
            const auto& capsule = static_cast<const btCapsuleShape&>(shape);
            d = capsuleDistance(p, capsule.getUpAxis(), capsule.getRadius(), capsule.getHalfHeight());
            return true;
        }
        case CYLINDER_SHAPE_PROXYTYPE:
        {
            const auto& cylinder = static_cast<const btCylinderShape&>(shape);
            const int axis = cylinder.getUpAxis();
            d = cylinderDistance(p, axis, cylinder.getRadius(), cylinder.getHalfExtentsWithMargin()[axis]);
            return true;
        }
        case CONE_SHAPE_PROXYTYPE:
        {
            const auto& cone = static_cast<const btConeShape&>(shape);
            d = coneDistance(p, cone.getConeUpIndex(), cone.getRadius(), 0.5 * cone.getHeight());
            d.m_gap -= cone.getMargin();
            return true;
        }
        case STATIC_PLANE_PROXYTYPE:
        {
            const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
            d = planeDistance(p, vec3(plane.getPlaneNormal()), plane.getPlaneConstant());
            return true;
        }
        default:
            return false;
    }
}

/// Signed distance of a point (count 1) or triangle (count 3) in local coordinates to a convex shape or field; the
/// normal is in world coordinates.
bool solidShapeDistance(const ShapeLeaf& leaf, const Vec3* local, int count, double maxDistance,
                        SurfaceDistance& distance)
{
    if (const btSdfCollisionShape* field = fieldOf(*leaf.m_shape))
    {
        if (count == 1 ? !pointFieldDistance(*field, local[0], maxDistance, distance)
                       : !triangleFieldDistance(*field, {local[0], local[1], local[2]}, maxDistance, distance))
            return false;
    }
    else
    {
        if (!leaf.m_shape->isConvex()) return false;
        const ConvexCore core(static_cast<const btConvexShape&>(*leaf.m_shape));
        if (!convexDistance({core, local, count}, maxDistance, distance)) return false;
    }
    distance.m_normal = leaf.m_pose.m_rotation * distance.m_normal;
    return true;
}

}  // namespace

bool pointShapeDistance(const ShapeLeaf& leaf, const Vec3& point, double maxDistance, SurfaceDistance& distance)
{
    const Vec3 local = leaf.m_pose.toLocal(point);
    if (!isFinite(local)) return false;
    PointDistance d;
    if (!primitiveDistance(*leaf.m_shape, local, d)) return solidShapeDistance(leaf, &local, 1, maxDistance, distance);
    if (!(d.m_gap <= maxDistance) || !std::isfinite(d.m_gap)) return false;
    distance = {d.m_gap, leaf.m_pose.m_rotation * d.m_normal, {1, 0, 0}};
    return true;
}

bool triangleShapeDistance(const ShapeLeaf& leaf, const std::array<Vec3, 3>& triangle, double maxDistance,
                           SurfaceDistance& distance)
{
    Vec3 local[3];
    for (int i = 0; i < 3; ++i)
    {
        local[i] = leaf.m_pose.toLocal(triangle[i]);
        if (!isFinite(local[i])) return false;
    }
    return solidShapeDistance(leaf, local, 3, maxDistance, distance);
}

}  // namespace bullet_fem
