// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"
#include "bullet_bridge/joints/welds.h"

namespace bullet_fem
{

/// All that holds FEM bodies besides contact: anchors, attachments to each other, cluster joints, springs. Everything
/// is read anew in every step, so the user's arrays may be edited between steps in any way. A step calls
///     hideClusterJoints      before collision detection, every FEM body of the world (cluster_joints.h)
///     forgetWorld            once, when free motion begins
///     append, takeBack       around the solve of every group of bodies
///     showClusterJoints      with the new state, every FEM body of the world
class SoftJoints
{
public:
    /// What the world holds may have changed.
    void forgetWorld() { m_world.forget(); }

    /// What is solved together, as in JointScene.
    struct Group
    {
        const std::vector<FemSoftBody*>& m_bodies;
        const std::vector<FemSoftBody*>& m_outside;
        RigidProxies& m_rigid;
        double m_step;
        RigidPhase m_phase;
    };

    /// Adds the joints of all bodies to the problem, and their objects to the group's rigid proxies; `flags` gets one
    /// entry a body. After solveFreeMotion. May be called anew for the same step.
    void append(const Group& group, ContactProblem& problem, std::vector<JointFlags>& flags);

    /// Hands a body the impulses of a solved problem that it was in.
    static void takeBack(FemSoftBody& fem, const ContactProblem& problem);

private:
    WorldObjects m_world;
    WeldClusters m_clusters;
};

/// True if an attachment or a cluster joint of the body goes to one of the others. Between predictMotion and the step's
/// end.
bool reachesInto(const FemSoftBody& fem, const std::vector<FemSoftBody*>& others);

/// Calls visit(object) with the address of all rigid objects that anchors and cluster joints of the body hold, which
/// may be gone. Between predictMotion and the step's end.
template <class Visit>
void forEachRigidEnd(const FemSoftBody& fem, const Visit& visit)
{
    const btSoftBody& soft = *fem.m_softBody;
    for (int k = 0; k < soft.m_anchors.size(); ++k) visit(soft.m_anchors[k].m_body);
    for (int k = 0; k < soft.m_deformableAnchors.size(); ++k) visit(soft.m_deformableAnchors[k].m_cti.m_colObj);
    for (const HiddenJoint& hidden : fem.m_joints.m_hidden)
        for (const btSoftBody::Body& end : hidden.m_bodies)
            if (!end.m_soft) visit(end.m_collisionObject ? end.m_collisionObject : end.m_rigid);
}

/// True if the two shall not collide: Bullet's switches setIgnoreCollisionCheck on either side, and anchors with
/// disableCollisionBetweenLinkedBodies. Does not allocate; may be called by several threads.
bool ignoresCollision(const btSoftBody& body, const btCollisionObject& object);

/// True if the node is anchored to the object: it may well be inside, and contact must not push it out.
bool isAnchoredTo(const FemSoftBody& fem, int node, const btCollisionObject& object);

}  // namespace bullet_fem
