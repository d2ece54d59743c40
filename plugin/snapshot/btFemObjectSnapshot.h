// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h"
#include "plugin/snapshot/btFemRecordSnapshot.h"

/// Motion and sleep of a collision object: a rigid body, a link of a multibody or a soft body.
struct btFemObjectSnapshot
{
    int m_id = -1;    ///< broadphase id; -1: none
    int m_type = 0;   ///< internal type of btCollisionObject
    int m_shape = 0;  ///< type of its shape
    btTransform m_place = btTransform::getIdentity(), m_interpolated = btTransform::getIdentity();
    btVector3 m_interpolatedVelocity{0, 0, 0}, m_interpolatedSpin{0, 0, 0};
    int m_activation = 0;
    btScalar m_deactivationTime = 0, m_hitFraction = 0;
    btVector3 m_velocity{0, 0, 0}, m_spin{0, 0, 0}, m_force{0, 0, 0}, m_torque{0, 0, 0};  ///< of a rigid body
};

/// A joint's last impulses [N s], and whether it is intact.
struct btFemJointSnapshot
{
    int m_type = 0;
    bool m_enabled = true;
    std::vector<btScalar> m_impulses;
};

/// State of a link and its joint. Numbers are those of btMultibodyLink.
struct btFemLinkSnapshot
{
    std::array<btScalar, 7> m_position{}, m_interpolatedPosition{};
    std::array<btScalar, 6> m_jointForce{};
    btVector3 m_force{0, 0, 0}, m_torque{0, 0, 0};
    btTransform m_place = btTransform::getIdentity();
};

/// State of a multibody. Numbers are those of btMultiBody.
struct btFemMultiBodySnapshot
{
    btVector3 m_position{0, 0, 0}, m_interpolatedPosition{0, 0, 0};
    std::array<btScalar, 4> m_rotation{}, m_interpolatedRotation{};
    btVector3 m_force{0, 0, 0}, m_torque{0, 0, 0};
    std::vector<btScalar> m_reals;  ///< velocities, then scratch of the articulated-body algorithm
    bool m_awake = true;
    btScalar m_sleepTimer = 0;  ///< [s]
    std::vector<btFemLinkSnapshot> m_links;
};

/// Bullet's objects of a world, without their contacts. In the order of the world's arrays.
struct btFemObjectsSnapshot
{
    std::vector<btFemObjectSnapshot> m_objects;
    std::vector<btFemJointSnapshot> m_joints, m_linkJoints;
    std::vector<btFemMultiBodySnapshot> m_multiBodies;
    std::vector<unsigned> m_seeds;  ///< of the rigid solver; empty if it has none
    btScalar m_localTime = 0;       ///< time since the last fixed step [s]
};

btFemObjectsSnapshot objectsSnapshotOf(btDiscreteDynamicsWorld& world);

/// Throws std::invalid_argument, naming the value, unless the world has these objects and all numbers are finite.
void check(const btFemObjectsSnapshot& snapshot, btDiscreteDynamicsWorld& world);

/// Parts of those three for multibodies.
void appendMultiBodies(btFemObjectsSnapshot& snapshot, btDiscreteDynamicsWorld& world);
void checkMultiBodies(const btFemObjectsSnapshot& snapshot, btDiscreteDynamicsWorld& world);
void restoreMultiBodies(const btFemObjectsSnapshot& snapshot, btDiscreteDynamicsWorld& world);

/// Call after check().
void restore(const btFemObjectsSnapshot& snapshot, btDiscreteDynamicsWorld& world);

template <class Bytes>
void transfer(Bytes& bytes, btFemObjectSnapshot& s)
{
    bytes(s.m_id, s.m_type, s.m_shape, s.m_place, s.m_interpolated, s.m_interpolatedVelocity, s.m_interpolatedSpin,
          s.m_activation, s.m_deactivationTime, s.m_hitFraction, s.m_velocity, s.m_spin, s.m_force, s.m_torque);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemJointSnapshot& s)
{
    bytes(s.m_type, s.m_enabled, s.m_impulses);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemLinkSnapshot& s)
{
    bytes(s.m_position, s.m_interpolatedPosition, s.m_jointForce, s.m_force, s.m_torque, s.m_place);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemMultiBodySnapshot& s)
{
    bytes(s.m_position, s.m_interpolatedPosition, s.m_rotation, s.m_interpolatedRotation, s.m_force, s.m_torque,
          s.m_reals, s.m_awake, s.m_sleepTimer, s.m_links);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemObjectsSnapshot& s)
{
    bytes(s.m_objects, s.m_joints, s.m_linkJoints, s.m_multiBodies, s.m_seeds, s.m_localTime);
}
