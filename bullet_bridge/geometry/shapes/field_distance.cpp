// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/field_distance.h"

#include <algorithm>
#include <cmath>

#include "BulletCollision/CollisionShapes/btSdfCollisionShape.h"
#include "bullet_bridge/geometry/surface/triangle_proximity.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr int kGrid = 4;            // intervals per axis of the grid that is sampled to see whether a field is loaded
constexpr double kInside = 1e-6;    // how far queries stay within the domain, over its size
constexpr int kMaxDescents = 24;    // largest number of queries per triangle after the first seven
constexpr double kFirstWay = 0.25;  // first step length over the longest edge
constexpr double kLastWay = 1e-3;   // last step length over the longest edge

struct FieldDomain
{
    Vec3 m_low, m_high;
};

FieldDomain domainOf(const btSdfCollisionShape& field)
{
    btVector3 low, high;
    field.getAabb(btTransform::getIdentity(), low, high);
    const Vec3 border = kInside * vec3(high - low);
    return {vec3(low) + border, vec3(high) - border};
}

struct FieldValue
{
    double m_distance = 0;
    Vec3 m_normal;
};

// Value and normal at a point. Bullet's query is not const but does not write. A vanishing gradient gets a fixed
// normal.
bool valueAt(const btSdfCollisionShape& field, const Vec3& point, FieldValue& value)
{
    btScalar distance;
    btVector3 gradient;
    if (!const_cast<btSdfCollisionShape&>(field).queryPoint(bulletVector(point), distance, gradient)) return false;
    const double slope = norm(vec3(gradient));
    if (!std::isfinite(distance) || !std::isfinite(slope)) return false;
    value.m_distance = double(distance) - double(field.getMargin());
    value.m_normal = slope > 0 ? (1 / slope) * vec3(gradient) : Vec3{0, 0, 1};
    return true;
}

}  // namespace

const btSdfCollisionShape* fieldOf(const btCollisionShape& shape)
{
    if (shape.getShapeType() != SDF_SHAPE_PROXYTYPE) return nullptr;
    return dynamic_cast<const btSdfCollisionShape*>(&shape);
}

bool isSolid(const btCollisionShape& shape)
{
    return shape.isConvex() || fieldOf(shape);
}

bool isSheet(const btCollisionShape& shape)
{
    return shape.isConcave() && !shape.isInfinite() && !fieldOf(shape);
}

bool isLoaded(const btSdfCollisionShape& field)
{
    const FieldDomain domain = domainOf(field);
    const Vec3 size = domain.m_high - domain.m_low;
    if (!isFinite(size) || !(std::min({size.x, size.y, size.z}) > 0)) return false;
    FieldValue value;
    for (int k = 0; k <= kGrid; ++k)
        for (int j = 0; j <= kGrid; ++j)
            for (int i = 0; i <= kGrid; ++i)
                if (valueAt(field, domain.m_low + (1.0 / kGrid) * Vec3{i * size.x, j * size.y, k * size.z}, value))
                    return true;
    return false;
}

bool pointFieldDistance(const btSdfCollisionShape& field, const Vec3& point, double maxDistance,
                        SurfaceDistance& distance)
{
    const FieldDomain domain = domainOf(field);
    Vec3 within;
    for (int c = 0; c < 3; ++c) within[c] = std::clamp(point[c], domain.m_low[c], domain.m_high[c]);
    FieldValue value;
    if (!valueAt(field, within, value)) return false;
    const double outside = norm(point - within);
    if (outside > 0) value.m_distance = std::max(outside, value.m_distance - outside);
    if (!(value.m_distance <= maxDistance)) return false;
    distance = {value.m_distance, value.m_normal, {1, 0, 0}};
    return true;
}

bool triangleFieldDistance(const btSdfCollisionShape& field, const std::array<Vec3, 3>& triangle, double maxDistance,
                           SurfaceDistance& distance)
{
    constexpr double kEverywhere = 1e300;
    SurfaceDistance best;
    bool any = false;
    Vec3 at;
    const auto take = [&](const Vec3& point, const std::array<double, 3>& weights)
    {
        SurfaceDistance here;
        if (!pointFieldDistance(field, point, kEverywhere, here) || (any && !(here.m_gap < best.m_gap))) return false;
        best = here;
        best.m_barycentric = weights;
        at = point;
        return any = true;
    };
    constexpr double kThird = 1.0 / 3;
    for (const std::array<double, 3>& w : {std::array<double, 3>{kThird, kThird, kThird},
                                           {1, 0, 0},
                                           {0, 1, 0},
                                           {0, 0, 1},
                                           {0.5, 0.5, 0},
                                           {0, 0.5, 0.5},
                                           {0.5, 0, 0.5}})
        take(w[0] * triangle[0] + w[1] * triangle[1] + w[2] * triangle[2], w);
    if (!any) return false;
    const double longest =
        std::max({norm(triangle[1] - triangle[0]), norm(triangle[2] - triangle[1]), norm(triangle[0] - triangle[2])});
    double way = kFirstWay * longest;
    for (int k = 0; k < kMaxDescents && way > kLastWay * longest; ++k)
    {
        const TrianglePoint next = nearestOnTriangle(triangle, at - way * best.m_normal);
        if (norm(next.m_point - at) < kLastWay * longest) break;  // the gradient is perpendicular to the triangle
        if (!take(next.m_point, next.m_weights)) way *= 0.5;
    }
    if (!(best.m_gap <= maxDistance)) return false;
    distance = best;
    return true;
}

}  // namespace bullet_fem
