// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "LinearMath/btMatrix3x3.h"
#include "bullet_bridge/rigid/rigid_objects.h"
#include "bullet_fem/fem/common/vec3.h"

class btMultiBody;
class btMultiBodyLinkCollider;
struct btMultiBodyJointFeedback;

namespace bullet_fem
{

constexpr int kBaseCoordinates = 6;  ///< generalized velocities of a multibody's base: three angular, three linear

/// True if impulses move the link. False if it is static or kinematic, if it is a base that is fixed, or if its
/// multibody sleeps and must not wake up.
bool canMove(const btMultiBodyLinkCollider& link);

/// True if Bullet does not step the multibody because a collider of it sleeps.
bool sleeps(const btMultiBody& body);

/// Wakes a multibody that sleeps. One that is only about to sleep decides by its own motion.
void wakeIfAsleep(btMultiBody& body);

/// Velocity of a link's centre and its spin. `scratch` grows with the number of links.
LinkMotion motionOf(const btMultiBodyLinkCollider& link, std::vector<btVector3>& scratch);

/// Sets the velocity of all coordinates: base, then joints.
void setVelocity(btMultiBody& body, const std::vector<btScalar>& velocity);

/// Bullet's articulated body algorithm for one multibody after the other, with its scratch.
class MultiBodyDynamics
{
public:
    /// Momentum of base and links.
    struct Momentum
    {
        Vec3 m_linear;   ///< [kg m/s]
        Vec3 m_angular;  ///< about the world's origin [kg m2/s]
    };

    /// Sets the gravity [m/s2] that the forces on multibodies lack.
    void setTakenGravity(const Vec3& gravity) { m_takenGravity = gravity; }

    /// Computes acceleration() and the factors for impulse responses at the present pose.
    void factor(btMultiBody& body);

    /// Accelerations per coordinate at the last factor() [m/s2], [rad/s2].
    const std::vector<double>& acceleration() const { return m_acceleration; }

    /// Change of the coordinates' velocities by a generalized impulse.
    void respond(const btMultiBody& body, const btScalar* impulse, btScalar* change);

    /// Fills six rows of J, three of velocity and three of spin at `center` [m], and of J M^-1 for a link; -1: the
    /// base.
    void fillRows(const btMultiBody& body, int link, const Vec3& center, btScalar* J, btScalar* answer);

    /// Moves the joints with `velocity` for `step` [s], and leaves the multibody's own velocity alone.
    void displace(btMultiBody& body, const std::vector<btScalar>& velocity, double step);

    Momentum momentumOf(const btMultiBody& body);

private:
    Vec3 m_takenGravity;
    std::vector<double> m_acceleration;
    std::vector<btMultiBodyJointFeedback*> m_feedback;
    std::vector<btScalar> m_velocity;
    btAlignedObjectArray<btScalar> m_scalars;  // scratch of Bullet's functions, as the next three
    btAlignedObjectArray<btVector3> m_vectors;
    btAlignedObjectArray<btMatrix3x3> m_matrices;
    btAlignedObjectArray<btQuaternion> m_turns;
};

}  // namespace bullet_fem
