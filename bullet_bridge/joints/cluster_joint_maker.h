// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"
#include "bullet_bridge/joints/rigid_pivot.h"

namespace bullet_fem
{

/// True if the cluster is one of the body's. It need not exist.
bool holdsCluster(const btSoftBody& soft, const btSoftBody::Cluster* cluster);

/// Exchanges the ends and the control of the joint with those that were set aside.
void swapEnds(HiddenJoint& hidden);

/// Turns one body's hidden cluster joints into Joints.
class ClusterJointMaker
{
public:
    ClusterJointMaker(int body, const JointScene& scene, ContactProblem& problem)
        : m_fem(*scene.m_bodies[body]), m_scene(scene), m_problem(problem)
    {
    }

    /// Adds a joint to the problem; deletes it if its other end is gone.
    JointFlags append(HiddenJoint& hidden);

private:
    /// One end of a cluster joint, resolved.
    struct End
    {
        enum class Kind
        {
            rigid,
            cluster,
            unmoved,  ///< a cluster of a body that stands still in this step
            lost,
            bad
        };
        Kind m_kind = Kind::bad;
        int m_body = -1;                                 ///< of a cluster
        const btCollisionObject* m_object = nullptr;     ///< null: the world
        const btSoftBody::Cluster* m_cluster = nullptr;  ///< null: rigid
        FemSoftBody* m_fem = nullptr;
    };

    /// Of a pivot, or of an axis.
    struct Place
    {
        Vec3 m_start;
        RigidPivot m_pivot;  ///< of a rigid end
        Vec3 m_spin;         ///< before the joint acts [rad/s]
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
    btScalar m_current = 0;  // speed about the axis that a control was asked for [rad/s]
};

}  // namespace bullet_fem
