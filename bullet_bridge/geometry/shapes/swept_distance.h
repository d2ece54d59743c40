// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/shapes/shape_distance.h"

/// Continuous collision detection of a moving rigid shape and a moving feature of a soft surface. If the motion within
/// a step is large, gaps measured at its beginning have wrong normals: features beside the path would push, and
/// features on it might not stop the shape.
namespace bullet_fem
{

/// Constant velocity of a rigid body over a step, about a centre that moves with the body.
struct RigidMotion
{
    Vec3 m_center;           ///< as the step begins [m]
    Vec3 m_linearVelocity;   ///< of the centre [m/s]
    Vec3 m_angularVelocity;  ///< [rad/s]
};

/// A leaf moving through a step, with bounds on its motion. A view of the leaf's shape.
struct SweptShape
{
    ShapeLeaf m_leaf;  ///< as the step begins
    RigidMotion m_motion;
    double m_step = 0;              ///< [s], > 0
    double m_spinRadius = 0;        ///< largest distance of a point from the axis of rotation [m]; infinite for planes
    double m_spinReach = 0;         ///< largest displacement of a point by rotation [m]; infinite for planes
    double m_thickness = 0;         ///< smallest extent of the shape in its own frame [m]; infinite for planes
    double m_accuracy = 1e-9;       ///< gap at which the search ends [m], > 0
    Vec3 m_boundsMin, m_boundsMax;  ///< of the whole path, in the world [m]; infinite for planes

    SweptShape(const ShapeLeaf& leaf, const RigidMotion& motion, double step);

    /// The leaf's transform at a time [s] after the start of the step.
    Pose poseAt(double time) const;
};

/// A node, edge or triangle of a soft surface whose corners move on straight lines during the step.
struct SweptFeature
{
    int m_count = 1;                 ///< number of corners: 1, 2 or 3
    std::array<Vec3, 3> m_position;  ///< as the step begins [m]
    std::array<Vec3, 3> m_velocity;  ///< [m/s]
};

/// The first contact of a feature within the step.
struct SweptContact
{
    double m_time = 0;  ///< time of contact [s], in [0, step]; 0 if the two overlap as the step begins
    /// Point of the feature, normal at that time, and the gap of the row gap + h n . (v_soft - v_rigid) >= 0 that stops
    /// the two at contact: -time n . (v_soft - v_rigid). If they overlap as the step begins, the gap at that time.
    SurfaceDistance m_surface;
    Vec3 m_arm;  ///< from the rigid body's centre to the soft point, both at the time of contact [m]
};

/// The leaf before it moved for `step` [s]. `motion` has the present centre.
ShapeLeaf movedBack(const ShapeLeaf& leaf, const RigidMotion& motion, double step);

/// True if the relative motion within the step is so large that gaps and normals of its beginning are not valid at its
/// end: half a surface edge or half the shape's thickness, where shapes count as at least a fifth of an edge thick.
/// `speed` is the largest speed of the surface relative to the shape's centre [m/s], `edge` the surface's mean edge
/// [m]. False for planes, whose normal is constant.
bool isFast(const SweptShape& shape, double speed, double edge);

/// True if gravity [m/s2] moves a resting body so far within the step. Its fall then counts as motion: in free motion
/// both sides fall, while contact may support one of them. False for planes.
bool fallsFar(const SweptShape& shape, double gravity, double edge);

/// False only if the feature stays farther than `reach` [m] from the leaf throughout the step, by the bounds and the
/// bounding sphere of the leaf.
bool mayMeet(const SweptShape& shape, const SweptFeature& feature, double reach);

/// Finds the first time at which the gap between a feature and a convex leaf or plane is `offset` [m] (>= 0), by
/// conservative advancement [Mirtich 1996]: a gap g needs at least g over an upper bound of the closing speed along its
/// normal, rotation included. After 24 such advances (a rotating shape close to the feature) it continues with up to 16
/// steps of Newton's method, and finally extrapolates from the gap and closing speed reached. Times are accurate to
/// 1e-6 of the shape's thickness over the closing speed, and to the accuracy of the distances. False, with `contact`
/// unchanged, if the two do not meet or only separate, or if a number is not finite. Never allocates.
bool sweptDistance(const SweptShape& shape, const SweptFeature& feature, double offset, SweptContact& contact);

}  // namespace bullet_fem
