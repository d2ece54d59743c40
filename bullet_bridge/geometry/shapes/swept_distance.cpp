// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/swept_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{

namespace
{

constexpr int kSafeAdvances = 24;   // by the upper bound of the closing speed; pure translation takes less than 10
constexpr int kMaxAdvances = 40;    // the others by the closing speed itself (Newton's method)
constexpr double kAccuracy = 1e-6;  // gap that counts as zero, relative to the thickness [-]
constexpr double kMin = 1e-8;       // smallest such gap, relative to the largest extent [-]; below, GJK has no reliable
                                    // direction
constexpr double kFastFraction = 0.5;  // travel that counts as fast, relative to an edge or the thickness [-]
constexpr double kThinnest = 0.2;      // smallest thickness of shapes here, in edges
constexpr double kSlowSpeed = 2;       // multiple of the speed that gravity adds in a step up to which bodies count as
                                       // resting [-]

/// Rodrigues' formula: the rotation by the vector w, about it, by its length [rad].
Mat3 rotationBy(const Vec3& w)
{
    const double angle = norm(w);
    if (!(angle > 0)) return Mat3::identity();
    const Vec3 axis = w * (1 / angle);
    return std::cos(angle) * Mat3::identity() + std::sin(angle) * crossMatrix(axis) +
           (1 - std::cos(angle)) * outer(axis, axis);
}

double fastWay(const SweptShape& shape, double edge)
{
    return kFastFraction * std::min(edge, std::max(shape.m_thickness, kThinnest * edge));
}

double axisDistance(const RigidMotion& motion, const Vec3& point)
{
    const double spin = norm(motion.m_angularVelocity);
    return spin > 0 ? norm(cross(motion.m_angularVelocity, point - motion.m_center)) / spin : 0;
}

/// Sets the values that depend on the shape's local bounding box: extents, and the largest distance from the axis of
/// rotation.
void measure(SweptShape& swept)
{
    btVector3 low, high;
    swept.m_leaf.m_shape->getAabb(btTransform::getIdentity(), low, high);
    const Vec3 extent = vec3(high - low);
    swept.m_thickness = std::min({extent.x, extent.y, extent.z});
    swept.m_accuracy = std::max(kAccuracy * swept.m_thickness, kMin * std::max({extent.x, extent.y, extent.z}));
    swept.m_spinRadius = axisDistance(swept.m_motion, swept.m_leaf.m_pose.m_origin);
    if (swept.m_leaf.m_shape->getShapeType() == SPHERE_SHAPE_PROXYTYPE) return;  // a sphere rotates in itself
    for (int corner = 0; corner < 8; ++corner)
    {
        const Vec3 local = {double(corner & 1 ? low.x() : high.x()), double(corner & 2 ? low.y() : high.y()),
                            double(corner & 4 ? low.z() : high.z())};
        const double distance = axisDistance(swept.m_motion, swept.m_leaf.m_pose.toWorld(local));
        swept.m_spinRadius = std::max(swept.m_spinRadius, distance);
    }
}

/// Upper bounds of the speed at which the gap between a shape and a feature closes.
class ClosingBound
{
public:
    ClosingBound(const SweptShape& shape, const SweptFeature& feature) : m_shape(shape), m_feature(feature)
    {
        double reach = 0;
        for (int i = 0; i < feature.m_count; ++i)
        {
            const double speed = norm(feature.m_velocity[i] - shape.m_motion.m_linearVelocity);
            m_speed = std::max(m_speed, speed);  // NaN makes distanceAt() fail
            reach = std::max(reach, norm(feature.m_position[i] - shape.m_motion.m_center) + shape.m_step * speed);
        }
        if (!isPlane(shape.m_leaf)) reach = shape.m_spinRadius;
        const double spin = norm(shape.m_motion.m_angularVelocity);
        if (spin != 0) m_speed += spin * reach;
    }

    /// Bound for all directions [m/s]; not finite if the motion is not.
    double speed() const { return m_speed; }

    /// Bound along a present normal until the end of the step [m/s]. A point of the shape moves along n with n . (V + w
    /// x r) = n . V + r . (n x w), so only the part of r perpendicular to w counts. A plane has no largest r.
    double along(const Vec3& normal) const
    {
        const RigidMotion& motion = m_shape.m_motion;
        const double turning = norm(cross(normal, motion.m_angularVelocity));
        if (turning > 0 && isPlane(m_shape.m_leaf)) return m_speed;
        double closing = -std::numeric_limits<double>::infinity();
        for (int i = 0; i < m_feature.m_count; ++i)
            closing = std::max(closing, dot(normal, motion.m_linearVelocity - m_feature.m_velocity[i]));
        return turning > 0 ? closing + turning * m_shape.m_spinRadius : closing;
    }

private:
    const SweptShape& m_shape;
    const SweptFeature& m_feature;
    double m_speed = 0;
};

/// Signed distance at a time.
bool distanceAt(const SweptShape& shape, const SweptFeature& feature, double time, double reach, SurfaceDistance& d)
{
    const ShapeLeaf leaf = {shape.m_leaf.m_shape, shape.poseAt(time), {}, {}};
    std::array<Vec3, 3> corners;
    for (int i = 0; i < 3; ++i)
    {
        const int k = std::min(i, feature.m_count - 1);
        corners[i] = feature.m_position[k] + time * feature.m_velocity[k];
    }
    if (feature.m_count > 1 && !isPlane(leaf))
    {
        if (!triangleShapeDistance(leaf, corners, reach, d)) return false;
        if (feature.m_count == 2) d.m_barycentric = {d.m_barycentric[0], d.m_barycentric[1] + d.m_barycentric[2], 0};
        return true;
    }
    bool found = false;
    for (int i = 0; i < feature.m_count; ++i)
    {
        SurfaceDistance corner;
        if (!pointShapeDistance(leaf, corners[i], reach, corner) || (found && corner.m_gap >= d.m_gap)) continue;
        corner.m_barycentric = {0, 0, 0};
        corner.m_barycentric[i] = 1;
        d = corner;
        found = true;
    }
    return found;
}

/// State of the advancement at a time.
struct Approach
{
    double m_time;
    SurfaceDistance m_surface;  // the gap is less the offset
    Vec3 m_arm;
    double m_closing;  // closing speed of the nearest points [m/s]
};

Approach approachAt(const SweptShape& shape, const SweptFeature& feature, double time, const SurfaceDistance& d)
{
    const RigidMotion& motion = shape.m_motion;
    Vec3 position, velocity;
    for (int i = 0; i < feature.m_count; ++i)
    {
        position += d.m_barycentric[i] * (feature.m_position[i] + time * feature.m_velocity[i]);
        velocity += d.m_barycentric[i] * feature.m_velocity[i];
    }
    const Vec3 arm = position - (motion.m_center + time * motion.m_linearVelocity);
    const Vec3 rigidVelocity = motion.m_linearVelocity + cross(motion.m_angularVelocity, arm);
    return {time, d, arm, dot(d.m_normal, rigidVelocity - velocity)};
}

/// The contact from the present gap and closing speed. The gap of its row is the one from which the pair, closing at
/// this speed since the start of the step, would have reached the present gap.
bool contactFrom(const Approach& at, double step, SweptContact& contact)
{
    const double arrival = at.m_time + std::max(at.m_surface.m_gap, 0.0) / at.m_closing;
    if (!(at.m_closing > 0) || arrival > step) return false;
    contact.m_time = arrival;
    contact.m_surface = at.m_surface;
    contact.m_surface.m_gap = at.m_surface.m_gap + at.m_time * at.m_closing;
    contact.m_arm = at.m_arm;
    return true;
}

}  // namespace

SweptShape::SweptShape(const ShapeLeaf& leaf, const RigidMotion& motion, double step)
    : m_leaf(leaf), m_motion(motion), m_step(step), m_boundsMin(leaf.m_boundsMin), m_boundsMax(leaf.m_boundsMax)
{
    if (isPlane(leaf))
    {
        m_spinRadius = m_spinReach = m_thickness = std::numeric_limits<double>::infinity();
        return;
    }
    measure(*this);
    // bounded by the arc and the diameter
    m_spinReach = std::min(2.0, norm(motion.m_angularVelocity) * step) * m_spinRadius;
    const Vec3 travel = step * motion.m_linearVelocity;
    for (int c = 0; c < 3; ++c)
    {
        m_boundsMin[c] += std::min(travel[c], 0.0) - m_spinReach;
        m_boundsMax[c] += std::max(travel[c], 0.0) + m_spinReach;
    }
}

Pose SweptShape::poseAt(double time) const
{
    const Mat3 turn = rotationBy(time * m_motion.m_angularVelocity);
    const Vec3 arm = turn * (m_leaf.m_pose.m_origin - m_motion.m_center);
    return {turn * m_leaf.m_pose.m_rotation, m_motion.m_center + time * m_motion.m_linearVelocity + arm};
}

ShapeLeaf movedBack(const ShapeLeaf& leaf, const RigidMotion& motion, double step)
{
    const SweptShape swept(leaf, motion, step);
    ShapeLeaf start = {leaf.m_shape, swept.poseAt(-step), leaf.m_boundsMin, leaf.m_boundsMax};
    if (isPlane(leaf)) return start;
    const Vec3 spin = {swept.m_spinReach, swept.m_spinReach, swept.m_spinReach};
    start.m_boundsMin -= step * motion.m_linearVelocity + spin;
    start.m_boundsMax -= step * motion.m_linearVelocity - spin;
    return start;
}

bool isFast(const SweptShape& shape, double speed, double edge)
{
    const double fastest = speed + norm(shape.m_motion.m_angularVelocity) * shape.m_spinRadius;
    return !isPlane(shape.m_leaf) && shape.m_step * fastest > fastWay(shape, edge);
}

bool fallsFar(const SweptShape& shape, double gravity, double edge)
{
    return !isPlane(shape.m_leaf) && kSlowSpeed * shape.m_step * shape.m_step * gravity > fastWay(shape, edge);
}

bool mayMeet(const SweptShape& shape, const SweptFeature& feature, double reach)
{
    if (isPlane(shape.m_leaf)) return true;
    const double h = shape.m_step;
    for (int c = 0; c < 3; ++c)
    {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (int i = 0; i < feature.m_count; ++i)
        {
            const double start = feature.m_position[i][c], end = start + h * feature.m_velocity[i][c];
            low = std::min({low, start, end});
            high = std::max({high, start, end});
        }
        if (low > shape.m_boundsMax[c] + reach || high < shape.m_boundsMin[c] - reach) return false;
    }
    // Relative to the shape, the first corner moves along a segment, and the other corners stay within a radius of it.
    const Vec3 way = h * (feature.m_velocity[0] - shape.m_motion.m_linearVelocity);
    double radius = 0;
    for (int i = 1; i < feature.m_count; ++i)
        radius = std::max(radius, norm(feature.m_position[i] - feature.m_position[0]) +
                                      h * norm(feature.m_velocity[i] - feature.m_velocity[0]));
    const Vec3 middle = 0.5 * (shape.m_leaf.m_boundsMin + shape.m_leaf.m_boundsMax);
    const Vec3 from = middle - feature.m_position[0];
    const double length2 = dot(way, way);
    const double along = length2 > 0 ? std::clamp(dot(from, way) / length2, 0.0, 1.0) : 0;
    const double sphere = 0.5 * norm(shape.m_leaf.m_boundsMax - shape.m_leaf.m_boundsMin) + shape.m_spinReach;
    return !(norm(from - along * way) > sphere + radius + reach);
}

bool sweptDistance(const SweptShape& shape, const SweptFeature& feature, double offset, SweptContact& contact)
{
    const double step = shape.m_step;
    const ClosingBound bound(shape, feature);
    if (!std::isfinite(step * bound.speed())) return false;
    const double accuracy = shape.m_accuracy;

    Approach now = {};
    for (int advance = 0; advance < kMaxAdvances; ++advance)
    {
        const double reach = (step - now.m_time) * bound.speed() + accuracy;
        SurfaceDistance d;
        if (!distanceAt(shape, feature, now.m_time, offset + reach, d)) return false;
        d.m_gap -= offset;
        now = approachAt(shape, feature, now.m_time, d);
        if (advance == 0 && d.m_gap <= 0)
        {
            contact = {0, d, now.m_arm};
            return true;
        }
        const bool isSafe = advance < kSafeAdvances;
        const double closing = isSafe ? bound.along(d.m_normal) : now.m_closing;
        if (!(closing > 0)) return false;  // by the bound, the pair separates from now on
        if ((isSafe ? d.m_gap : std::fabs(d.m_gap)) <= accuracy && now.m_closing > 0)
            return contactFrom(now, step, contact);
        const double time = now.m_time + (isSafe ? std::max(d.m_gap, accuracy) : d.m_gap) / closing;
        if (!(time < step)) return false;
        now.m_time = time;
    }
    return contactFrom(now, step, contact);
}

}  // namespace bullet_fem
