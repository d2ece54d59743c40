// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"
#include "bullet_bridge/joints/rigid_pivot.h"

namespace bullet_fem
{

/// True if the cluster belongs to the body. The pointer may dangle.
bool holdsCluster(const btSoftBody& soft, const btSoftBody::Cluster* cluster);

/// Exchanges bodies and control of the joint with those that are hidden.
void swapEnds(HiddenJoint& hidden);

/// Makes Joints of one body's hidden cluster joints.
class ClusterJointMaker
{
public:
    ClusterJointMaker(int body, const JointScene& scene, ContactProblem& problem)
        : m_fem(*scene.m_bodies[body]), m_scene(scene), m_problem(problem)
    {
    }

    /// Appends a joint to the problem. Deletes it if its other side no longer exists.
    JointFlags append(HiddenJoint& hidden);

private:
    /// One side of a cluster joint.
    struct End
    {
        enum class Kind
        {
            rigid,
            cluster,
            unmoved,  ///< cluster of a body that does not move in this step
            lost,
            bad
        };
        Kind m_kind = Kind::bad;
        int m_body = -1;                                 ///< index of the cluster's body
        const btCollisionObject* m_object = nullptr;     ///< null: the world
        const btSoftBody::Cluster* m_cluster = nullptr;  ///< null: rigid
        FemSoftBody* m_fem = nullptr;
    };

    /// The reference point or axis of one side.
    struct Place
    {
        Vec3 m_start;
        RigidPivot m_pivot;  ///< of a rigid side
        Vec3 m_spin;         ///< angular velocity before the joint acts [rad/s]
    };

    End resolve(const btSoftBody::Body& body) const;
    Place placeOf(const End& end, const Vec3& reference, bool angular) const;
    JointEnd pointEnd(const End& end, const Place& place, const Vec3& at);
    JointEnd spinEnd(const End& end, const Place& place);
    btScalar askControl(HiddenJoint& hidden, const End* ends, Place* places);
    void appendLinear(const btSoftBody::LJoint& linear, const End* ends, HeldJoint held);
    void appendAngular(HiddenJoint& hidden, const End* ends, HeldJoint held);
    void hold(const HeldJoint& held, const End& other, const Joint& joint);

    FemSoftBody& m_fem;
    const JointScene& m_scene;
    ContactProblem& m_problem;
    btScalar m_current = 0;  // relative speed about the axis that the control was given [rad/s]
};

}  // namespace bullet_fem
