// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/node_attachments.h"

#include <algorithm>

#include "bullet_bridge/joints/rigid_pivot.h"
#include "bullet_bridge/joints/soft_anchors.h"

namespace bullet_fem
{
namespace
{

constexpr double kErp = 0.5;  // share of the error that a step corrects (Baumgarte) [-]

// Index of the attachment's other body; -1 if it is not in `bodies`.
int indexOf(const NodeAttachment& attachment, const std::vector<FemSoftBody*>& bodies)
{
    const auto isIt = [&](const FemSoftBody* fem)
    { return fem->m_softBody == attachment.m_other && fem->m_setUp.m_mark == attachment.m_otherMark; };
    const auto found = std::find_if(bodies.begin(), bodies.end(), isIt);
    return found != bodies.end() ? static_cast<int>(found - bodies.begin()) : -1;
}

Vec3 pointOf(const NodeAttachment& attachment, const FemSoftBody& other)
{
    Vec3 point;
    for (int a = 0; a < 4; ++a) point += attachment.m_weights[a] * other.m_body.m_state.m_x[attachment.m_otherNodes[a]];
    return point;
}

}  // namespace

JointFlags appendAttachments(int body, const JointScene& scene, ContactProblem& problem)
{
    JointFlags flags;
    FemSoftBody& fem = *scene.m_bodies[body];
    std::vector<NodeAttachment>& attachments = fem.m_joints.m_attachments;
    const auto isGone = [&](const NodeAttachment& attachment)
    { return indexOf(attachment, scene.m_bodies) < 0 && indexOf(attachment, scene.m_outside) < 0; };
    const auto gone = std::remove_if(attachments.begin(), attachments.end(), isGone);
    flags.m_lost = gone != attachments.end();
    attachments.erase(gone, attachments.end());
    for (const NodeAttachment& attachment : attachments)
    {
        const int other = indexOf(attachment, scene.m_bodies);
        const FemSoftBody& otherFem =
            other >= 0 ? *scene.m_bodies[other] : *scene.m_outside[indexOf(attachment, scene.m_outside)];
        flags.m_outside = flags.m_outside || (other < 0 && otherFem.m_softBody->isActive());
        HeldJoint held;
        held.m_kind = HeldJoint::Kind::attachment;
        held.m_id = attachment.m_id;
        held.m_node = attachment.m_node;
        held.m_object = attachment.m_other;
        held.m_point = fem.m_body.m_state.m_x[attachment.m_node];
        const Vec3 target = pointOf(attachment, otherFem);
        held.m_error = norm(target - held.m_point);
        if (const HeldJoint* before = continuedBy(held, fem.m_joints.m_before, fem.m_joints.m_now.size()))
            held.m_impulse = before->m_impulse;
        Joint joint;
        joint.m_a = nodeEnd(body, attachment.m_node, problem);
        if (other >= 0) joint.m_b = pointEnd(other, attachment.m_otherNodes, attachment.m_weights, problem);
        if (attachment.m_compliance > 0)  // an implicit spring, see node_springs.cpp
        {
            joint.m_wanted = (1 / scene.m_step) * (target - held.m_point);
            joint.m_compliance = attachment.m_compliance / (scene.m_step * scene.m_step);
        }
        else
            joint.m_wanted =
                (1 / scene.m_step) * shortened(kErp * (target - held.m_point), longestCorrection(fem, scene.m_step));
        joint.m_impulse = held.m_impulse;
        held.m_row = static_cast<int>(problem.m_joints.size());
        problem.m_joints.push_back(joint);
        fem.m_joints.m_now.push_back(held);
        if (other < 0) continue;
        held.m_object = fem.m_softBody;
        held.m_node = -1;
        held.m_point = target;
        held.m_isEndB = true;
        scene.m_bodies[other]->m_joints.m_now.push_back(held);
    }
    return flags;
}

bool isPointAttached(const FemSoftBody& fem, const SurfacePoint& point, const FemSoftBody& other)
{
    const auto end = point.m_nodes.begin() + point.m_count;
    const auto isAmong = [&](int node) { return std::find(point.m_nodes.begin(), end, node) != end; };
    for (const NodeAttachment& attachment : fem.m_joints.m_attachments)
        if (attachment.m_other == other.m_softBody && isAmong(attachment.m_node)) return true;
    for (const NodeAttachment& attachment : other.m_joints.m_attachments)
        if (attachment.m_other == fem.m_softBody)
            for (int a = 0; a < 4; ++a)
                if (attachment.m_weights[a] != 0 && isAmong(attachment.m_otherNodes[a])) return true;
    return false;
}

}  // namespace bullet_fem
