// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/rolling_curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "BulletCollision/CollisionShapes/btConvexShape.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr int kAround = 10;    // directions around the axis: a polyhedron of fewer facets goes from corner to corner
constexpr double kUneven = 3;  // largest distance over the smallest between neighbouring supporting points: one or two
                               // sides of a regular polygon of ten sides and more, up to 2, and its wobble

// Distance by which a shape is rounded around the points that it supports without margin, and yet round itself.
double roundingOf(const btConvexShape& shape)
{
    return shape.getShapeType() == CAPSULE_SHAPE_PROXYTYPE ? double(shape.getMargin()) : 0;
}

}  // namespace

double rollingCurvature(const ShapeLeaf& leaf, const Vec3& normal, const Vec3& spin)
{
    if (leaf.m_shape->getShapeType() == SPHERE_SHAPE_PROXYTYPE)
        return leaf.m_shape->getMargin() > 0 ? 1 / double(leaf.m_shape->getMargin()) : 0;
    const Vec3 axis = spin - dot(spin, normal) * normal;
    const double length = norm(axis);
    if (!(length > 0) || !leaf.m_shape->isConvex() || leaf.m_shape->getShapeType() == BOX_SHAPE_PROXYTYPE) return 0;
    const auto& shape = static_cast<const btConvexShape&>(*leaf.m_shape);
    const Vec3 across = (1 / length) * axis, ahead = cross(across, normal);
    const double rounding = roundingOf(shape), angle = 2 * kPi / kAround;
    // Supporting points, without the margin of shapes that are not round by it, in the plane of rolling.
    std::array<Vec3, kAround> points;
    for (int k = 0; k < kAround; ++k)
    {
        const Vec3 direction = std::cos(k * angle) * normal + std::sin(k * angle) * ahead;
        const Vec3 supporting = vec3(shape.localGetSupportingVertexWithoutMargin(
            bulletVector(transposeTimes(leaf.m_pose.m_rotation, direction))));
        points[k] = leaf.m_pose.m_rotation * supporting + rounding * direction;
        points[k] -= dot(points[k], across) * across;
    }
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (int k = 0; k < kAround; ++k)
    {
        const double side = norm(points[(k + 1) % kAround] - points[k]);
        shortest = std::min(shortest, side);
        longest = std::max(longest, side);
    }
    if (!(longest <= kUneven * shortest)) return 0;
    const double radius =
        dot(ahead, points[1] - points[kAround - 1]) / (2 * std::sin(angle)) - rounding + double(shape.getMargin());
    return radius > 0 ? 1 / radius : 0;
}

}  // namespace bullet_fem
