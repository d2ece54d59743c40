// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/soft_joints.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/cluster_joints.h"
#include "bullet_bridge/joints/node_attachments.h"
#include "bullet_bridge/joints/node_springs.h"
#include "bullet_bridge/joints/soft_anchors.h"

namespace bullet_fem
{
namespace
{

bool hasAny(const FemSoftBody& fem)
{
    const btSoftBody& soft = *fem.m_softBody;
    return soft.m_anchors.size() > 0 || soft.m_deformableAnchors.size() > 0 || !fem.m_joints.m_hidden.empty() ||
           !fem.m_joints.m_attachments.empty() || !fem.m_joints.m_springs.empty() || !fem.m_joints.m_before.empty();
}

}  // namespace

void SoftJoints::append(const Group& group, ContactProblem& problem, std::vector<JointFlags>& flags)
{
    const JointScene scene = {group.m_bodies, group.m_outside, group.m_rigid, m_world, group.m_step};
    flags.assign(group.m_bodies.size(), JointFlags());
    for (FemSoftBody* fem : group.m_bodies)
    {
        fem->m_joints.m_before.swap(fem->m_joints.m_now);
        fem->m_joints.m_now.clear();
    }
    for (std::size_t b = 0; b < group.m_bodies.size(); ++b)
    {
        if (!hasAny(*group.m_bodies[b])) continue;
        m_world.read(*group.m_bodies[b]->m_softBody);
        const int body = static_cast<int>(b);
        flags[b] |= appendAnchors(body, scene, problem);
        flags[b] |= appendAttachments(body, scene, problem);
        flags[b] |= appendClusterJoints(body, scene, problem);
        appendSprings(body, scene, problem);
    }
    m_clusters.find(group.m_bodies, group.m_outside);
}

void SoftJoints::takeBack(FemSoftBody& fem, const ContactProblem& problem)
{
    for (HeldJoint& held : fem.m_joints.m_now)
    {
        held.m_impulse = held.m_row >= 0 ? problem.m_joints[held.m_row].m_impulse : Vec3();
        if (held.m_isEndB) held.m_impulse = -held.m_impulse;
    }
}

bool reachesInto(const FemSoftBody& fem, const std::vector<FemSoftBody*>& others)
{
    for (const FemSoftBody* other : others)
    {
        for (const NodeAttachment& attachment : fem.m_joints.m_attachments)
            if (attachment.m_other == other->m_softBody && attachment.m_otherMark == other->m_setUp.m_mark) return true;
        for (const HiddenJoint& hidden : fem.m_joints.m_hidden)
            if (hidden.m_bodies[1].m_soft &&
                other->m_softBody->m_clusters.findLinearSearch2(hidden.m_bodies[1].m_soft) >= 0)
                return true;
    }
    return false;
}

bool ignoresCollision(const btSoftBody& body, const btCollisionObject& object)
{
    return body.m_collisionDisabledObjects.findLinearSearch2(&object) >= 0 || !body.checkCollideWith(&object) ||
           !object.checkCollideWith(&body);
}

bool isAnchoredTo(const FemSoftBody& fem, int node, const btCollisionObject& object)
{
    const btSoftBody& soft = *fem.m_softBody;
    if (soft.m_anchors.size() + soft.m_deformableAnchors.size() == 0) return false;
    const btSoftBody::Node* at = &soft.m_nodes[node];
    if (at->m_battach == 0) return false;
    for (int k = 0; k < soft.m_anchors.size(); ++k)
        if (soft.m_anchors[k].m_node == at && soft.m_anchors[k].m_body == &object) return true;
    for (int k = 0; k < soft.m_deformableAnchors.size(); ++k)
        if (soft.m_deformableAnchors[k].m_node == at && soft.m_deformableAnchors[k].m_cti.m_colObj == &object)
            return true;
    return false;
}

}  // namespace bullet_fem
