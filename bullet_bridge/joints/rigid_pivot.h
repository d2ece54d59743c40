// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

class btCollisionObject;

namespace bullet_fem
{

/// A place that is fixed in a rigid object, over a step: where it was as the step began and where it goes if the
/// object's velocity stays. Along the arc of a spin, not its tangent, so nothing that is held there lags behind.
struct RigidPivot
{
    int m_rigidProxy = -1;                               ///< index; -1: the place is fixed in the world
    Mat3 m_rotation = Mat3::identity();                  ///< of the object as the step began
    Vec3 m_start;                                        ///< [m]
    Vec3 m_way;                                          ///< from there to where it ends [m]
    Vec3 m_now;                                          ///< where it is on the rigid proxy [m]
    Vec3 m_center, m_linearVelocity, m_angularVelocity;  ///< that the way was found with [m], [m/s], [rad/s]

    /// Velocity [m/s] that a point at `at` [m] shall have relative to the object's, so that within `step` [s] it goes
    /// the pivot's way and `correction` [m] besides.
    Vec3 wantedVelocity(const Vec3& at, const Vec3& correction, double step) const;
};

/// The pivot at `local` [m] in the frame of an object of the scene's world; null stands for the world itself.
RigidPivot rigidPivot(const btCollisionObject* object, const Vec3& local, const JointScene& scene);

/// a, or what is left of it with a length of at most `longest`.
Vec3 shortened(const Vec3& a, double longest);

}  // namespace bullet_fem
