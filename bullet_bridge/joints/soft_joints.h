// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"
#include "bullet_bridge/joints/welds.h"

namespace bullet_fem
{

/// All joints of FEM bodies: anchors, attachments to each other, cluster joints, springs. All are read in every step,
/// so the user may edit the arrays between steps in any way. A step calls
///     hideClusterJoints      before collision detection, for each FEM body of the world (cluster_joints.h)
///     forgetWorld            once, when free motion begins
///     append, takeBack       before and after the solve of each group of bodies
///     showClusterJoints      with the new state, for each FEM body of the world
class SoftJoints
{
public:
    /// Call when objects may have been added to or removed from the world.
    void forgetWorld() { m_world.forget(); }

    /// A group of bodies that is solved together, as in JointScene.
    struct Group
    {
        const std::vector<FemSoftBody*>& m_bodies;
        const std::vector<FemSoftBody*>& m_outside;
        RigidProxies& m_rigid;
        double m_step;
    };

    /// Appends the joints of all bodies to the problem, and their objects to the group's rigid proxies. `flags` gets
    /// one entry per body. Call after solveFreeMotion; may be called again in a step.
    void append(const Group& group, ContactProblem& problem, std::vector<JointFlags>& flags);

    /// Hands a body the impulses of the solved problem that it was in.
    static void takeBack(FemSoftBody& fem, const ContactProblem& problem);

private:
    WorldObjects m_world;
    WeldClusters m_clusters;
};

/// True if an attachment or a cluster joint of the body connects it to one of the others. Valid between predictMotion
/// and the end of the step.
bool reachesInto(const FemSoftBody& fem, const std::vector<FemSoftBody*>& others);

/// Calls visit(object) with the addresses of all rigid objects of the body's anchors and cluster joints; the pointers
/// may dangle. Valid between predictMotion and the end of the step.
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

/// True if the two must not collide: by setIgnoreCollisionCheck on either side, or by anchors with
/// disableCollisionBetweenLinkedBodies. Does not allocate; may be called by several threads.
bool ignoresCollision(const btSoftBody& body, const btCollisionObject& object);

/// True if the node is anchored to the object. It may be inside of the object, and contact must not push it out.
bool isAnchoredTo(const FemSoftBody& fem, int node, const btCollisionObject& object);

}  // namespace bullet_fem
