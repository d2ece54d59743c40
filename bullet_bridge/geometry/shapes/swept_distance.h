// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/shapes/shape_distance.h"

/// When and where a moving rigid shape meets a moving feature of a soft surface. Gaps measured as the step begins have
/// the wrong normals for what moves far within it: features beside the path would push, and those in it might not stop.
namespace bullet_fem
{

/// Constant velocity of a rigid body over a step, about a centre that moves with it.
struct RigidMotion
{
    Vec3 m_center;           ///< as the step begins [m]
    Vec3 m_linearVelocity;   ///< of the centre [m/s]
    Vec3 m_angularVelocity;  ///< [rad/s]
};

/// A leaf on its way through a step, with bounds on it. A view of the leaf's shape.
struct SweptShape
{
    ShapeLeaf m_leaf;  ///< as the step begins
    RigidMotion m_motion;
    double m_step = 0;              ///< [s], > 0
    double m_spinRadius = 0;        ///< greatest distance of a point from the axis of spin [m]; a plane's is infinite
    double m_spinReach = 0;         ///< farthest that a point goes by spin [m]; a plane's is infinite
    double m_thickness = 0;         ///< smallest extent of the shape in its own frame [m]; a plane's is infinite
    double m_accuracy = 1e-9;       ///< gap at which the search for the touch ends [m], > 0
    Vec3 m_boundsMin, m_boundsMax;  ///< of all of the way, in the world [m]; a plane's are infinite

    SweptShape(const ShapeLeaf& leaf, const RigidMotion& motion, double step);

    /// The leaf's placement at a time [s] after the beginning.
    Pose poseAt(double time) const;
};

/// A node, edge or triangle of a soft surface whose corners move straight through the step.
struct SweptFeature
{
    int m_count = 1;                 ///< corners: 1, 2 or 3
    std::array<Vec3, 3> m_position;  ///< as the step begins [m]
    std::array<Vec3, 3> m_velocity;  ///< [m/s]
};

/// The first touch of a feature within the step.
struct SweptContact
{
    double m_time = 0;  ///< when [s], in [0, step]; 0 if they touch as the step begins
    /// Where on the feature, the normal at that time, and the gap of the row gap + h n . (v_soft - v_rigid) >= 0 that
    /// stops both just there: -time n . (v_soft - v_rigid). If they touch as the step begins, the gap of that time.
    SurfaceDistance m_surface;
    Vec3 m_arm;  ///< from the rigid body's centre to the soft point, both at that time [m]
};

/// The leaf as it was before it moved for `step` [s]; `motion` has the centre of the present.
ShapeLeaf movedBack(const ShapeLeaf& leaf, const RigidMotion& motion, double step);

/// True if what moves with `speed` [m/s] at most, relative to the shape's centre, can go so far within the step that
/// gaps and normals of its beginning say little about its end: half of a surface edge or of the shape's thickness; of
/// shapes thinner than a fifth of an edge, half of that. `edge` is the surface's mean edge [m]. Never for planes, whose
/// normal is the same everywhere.
bool isFast(const SweptShape& shape, double speed, double edge);

/// True if gravity [m/s2] takes what rests so far within the step. Then it counts as motion: free motion has both
/// sides fall, and what one of them lies on may hold it. Never for planes.
bool fallsFar(const SweptShape& shape, double gravity, double edge);

/// False only if the feature stays farther than `reach` [m] from the leaf throughout the step: by its bounds, and by
/// the sphere about it.
bool mayMeet(const SweptShape& shape, const SweptFeature& feature, double reach);

/// The first time a feature and a convex leaf or plane come as near as `offset` [m] (>= 0): where its gap to the shape,
/// less the offset, is 0. By conservative advancement [Mirtich 1996]: a gap g cannot close sooner than in g over a
/// bound on the closing speed along its normal, with the spin's share of it. After 24 such advances (a turning shape,
/// beside the feature or close to it) by Newton's method, 16 times at most, and then the rest of the step is judged by
/// the gap and closing speed reached. Times are exact to 1e-6 of the shape's thickness over the closing speed, and as
/// exact as the distances. False, and `contact` untouched, if they do not touch, or only part, or if a number is not
/// finite. Never allocates.
bool sweptDistance(const SweptShape& shape, const SweptFeature& feature, double offset, SweptContact& contact);

}  // namespace bullet_fem
