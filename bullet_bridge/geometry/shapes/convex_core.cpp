// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/convex_core.h"

#include <algorithm>
#include <cmath>

#include "BulletCollision/CollisionShapes/btBoxShape.h"
#include "BulletCollision/CollisionShapes/btCapsuleShape.h"
#include "BulletCollision/CollisionShapes/btConeShape.h"
#include "BulletCollision/CollisionShapes/btConvexHullShape.h"
#include "BulletCollision/CollisionShapes/btCylinderShape.h"
#include "BulletCollision/CollisionShapes/btMultiSphereShape.h"
#include "BulletCollision/CollisionShapes/btSphereShape.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{

namespace
{

/// Support point of a disc perpendicular to an axis; its centre if the direction is along the axis.
Vec3 discSupport(const Vec3& direction, int axis, double radius)
{
    Vec3 radial = direction;
    radial[axis] = 0;
    const double length = norm(radial);
    return length > 0 ? radial * (radius / length) : Vec3{};
}

Vec3 componentProduct(const Vec3& a, const Vec3& b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

}  // namespace

ConvexCore::ConvexCore(const btConvexShape& shape) : m_shape(shape), m_kind(shape.getShapeType())
{
    switch (m_kind)
    {
        case BOX_SHAPE_PROXYTYPE:
        {
            m_halfExtents = vec3(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
            m_rounding = edgeRounding * std::min({m_halfExtents.x, m_halfExtents.y, m_halfExtents.z});
            m_halfExtents -= {m_rounding, m_rounding, m_rounding};
            break;
        }
        case SPHERE_SHAPE_PROXYTYPE:
            m_rounding = static_cast<const btSphereShape&>(shape).getRadius();
            break;
        case CAPSULE_SHAPE_PROXYTYPE:
        {
            const auto& capsule = static_cast<const btCapsuleShape&>(shape);
            m_axis = capsule.getUpAxis();
            m_halfExtents[m_axis] = capsule.getHalfHeight();
            m_rounding = capsule.getRadius();
            break;
        }
        case CYLINDER_SHAPE_PROXYTYPE:
        {
            const auto& cylinder = static_cast<const btCylinderShape&>(shape);
            m_axis = cylinder.getUpAxis();
            const double radius = cylinder.getRadius();
            const double halfHeight = cylinder.getHalfExtentsWithMargin()[m_axis];
            m_rounding = edgeRounding * std::min(radius, halfHeight);
            m_halfExtents = {radius - m_rounding, radius - m_rounding, radius - m_rounding};
            m_halfExtents[m_axis] = halfHeight - m_rounding;
            m_isCurved = true;
            break;
        }
        case CONE_SHAPE_PROXYTYPE:
        {
            const auto& cone = static_cast<const btConeShape&>(shape);
            m_axis = cone.getConeUpIndex();
            m_halfExtents = {cone.getRadius(), cone.getRadius(), cone.getRadius()};
            m_halfExtents[m_axis] = 0.5 * cone.getHeight();
            m_rounding = cone.getMargin();
            m_isCurved = true;
            break;
        }
        case MULTI_SPHERE_SHAPE_PROXYTYPE:
        {
            const auto& spheres = static_cast<const btMultiSphereShape&>(shape);
            const Vec3 scale = vec3(spheres.getLocalScaling());
            m_rounding = spheres.getSphereRadius(0);
            for (int i = 1; i < spheres.getSphereCount(); ++i)
                m_rounding = std::min(m_rounding, double(spheres.getSphereRadius(i)));
            m_rounding *= std::min({scale.x, scale.y, scale.z});
            m_isCurved = true;
            break;
        }
        default:
            m_rounding = shape.getMargin();
            m_isCurved = !shape.isPolyhedral();
            m_precision = m_isCurved ? 1e-7 : 1e-15;
    }
}

Vec3 ConvexCore::support(const Vec3& direction) const
{
    switch (m_kind)
    {
        case SPHERE_SHAPE_PROXYTYPE:
            return {};
        case BOX_SHAPE_PROXYTYPE:
            return {std::copysign(m_halfExtents.x, direction.x), std::copysign(m_halfExtents.y, direction.y),
                    std::copysign(m_halfExtents.z, direction.z)};
        case CAPSULE_SHAPE_PROXYTYPE:
        {
            Vec3 end;
            end[m_axis] = std::copysign(m_halfExtents[m_axis], direction[m_axis]);
            return end;
        }
        case CYLINDER_SHAPE_PROXYTYPE:
        {
            Vec3 rim = discSupport(direction, m_axis, m_halfExtents[(m_axis + 1) % 3]);
            rim[m_axis] = std::copysign(m_halfExtents[m_axis], direction[m_axis]);
            return rim;
        }
        case CONE_SHAPE_PROXYTYPE:
        {
            Vec3 apex, rim = discSupport(direction, m_axis, m_halfExtents[(m_axis + 1) % 3]);
            apex[m_axis] = m_halfExtents[m_axis];
            rim[m_axis] = -m_halfExtents[m_axis];
            return dot(direction, apex) > dot(direction, rim) ? apex : rim;
        }
        case CONVEX_HULL_SHAPE_PROXYTYPE:
            return hullSupport(direction);
        case MULTI_SPHERE_SHAPE_PROXYTYPE:
            return multiSphereSupport(direction);
        default:
            return vec3(m_shape.localGetSupportingVertexWithoutMargin(bulletVector(direction * (1 / norm(direction)))));
    }
}

Vec3 ConvexCore::hullSupport(const Vec3& direction) const
{
    const auto& hull = static_cast<const btConvexHullShape&>(m_shape);
    const Vec3 scale = vec3(hull.getLocalScaling()), scaledDirection = componentProduct(direction, scale);
    const btVector3* points = hull.getUnscaledPoints();
    Vec3 farthest = vec3(points[0]);
    for (int i = 1; i < hull.getNumPoints(); ++i)
    {
        const Vec3 point = vec3(points[i]);
        if (dot(scaledDirection, point) > dot(scaledDirection, farthest)) farthest = point;
    }
    return componentProduct(farthest, scale);
}

Vec3 ConvexCore::multiSphereSupport(const Vec3& direction) const
{
    const auto& spheres = static_cast<const btMultiSphereShape&>(m_shape);
    const Vec3 scale = vec3(spheres.getLocalScaling()), n = direction * (1 / norm(direction));
    Vec3 farthest;
    for (int i = 0; i < spheres.getSphereCount(); ++i)
    {
        // Bullet's own support point: with a non-uniform scaling it is not that of an ellipsoid.
        const Vec3 point =
            componentProduct(vec3(spheres.getSpherePosition(i)) + n * double(spheres.getSphereRadius(i)), scale) -
            n * m_rounding;
        if (i == 0 || dot(n, point) > dot(n, farthest)) farthest = point;
    }
    return farthest;
}

}  // namespace bullet_fem
