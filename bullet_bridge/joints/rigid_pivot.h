// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

class btCollisionObject;

namespace bullet_fem
{

/// A point that is fixed to a rigid object during a step: its position at the start of the step, and its displacement
/// if the object's velocity is constant. The displacement is along the arc of the rotation, not its tangent, so that a
/// node held there does not lag behind.
struct RigidPivot
{
    int m_rigidProxy = -1;                               ///< index; -1: the point is fixed in the world
    Mat3 m_rotation = Mat3::identity();                  ///< rotation of the object as the step began
    Vec3 m_start;                                        ///< position as the step began [m]
    Vec3 m_way;                                          ///< displacement in the step [m]
    Vec3 m_now;                                          ///< position on the rigid proxy [m]
    Vec3 m_center, m_linearVelocity, m_angularVelocity;  ///< motion from which m_way was computed [m], [m/s], [rad/s]

    /// Velocity [m/s] relative to the object that moves a point at `at` [m] within `step` [s] by the pivot's
    /// displacement plus `correction` [m].
    Vec3 wantedVelocity(const Vec3& at, const Vec3& correction, double step) const;
};

/// The pivot at `local` [m] in the frame of an object of the scene's world; null is the world itself.
RigidPivot rigidPivot(const btCollisionObject* object, const Vec3& local, const JointScene& scene);

/// a, scaled down to the length `longest` if it is longer.
Vec3 shortened(const Vec3& a, double longest);

}  // namespace bullet_fem
