// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/soft_anchors.h"

#include <algorithm>
#include <functional>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/joints/rigid_pivot.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

// Largest correction of a joint in a step, in mean edges: a distant pivot pulls its node in, not through it. Nor is the
// correction faster than in steps of 1/60 s, as nodes would get a velocity proportional to 1/h in short steps.
constexpr double kLongestCorrection = 0.25;
constexpr double kFastestCorrection = 60 * kLongestCorrection;  // largest rate of correction, in mean edges [1/s]

// Common view of both kinds of anchors.
struct AnchorView
{
    HeldJoint::Kind m_kind;
    const btSoftBody::Node* m_node;
    const btCollisionObject* m_object;
    Vec3 m_local;
    double m_influence;
};

AnchorView viewOf(const btSoftBody::Anchor& anchor)
{
    return {HeldJoint::Kind::anchor, anchor.m_node, anchor.m_body, vec3(anchor.m_local), double(anchor.m_influence)};
}

AnchorView viewOf(const btSoftBody::DeformableNodeRigidAnchor& anchor)
{
    return {HeldJoint::Kind::deformableAnchor, anchor.m_node, anchor.m_cti.m_colObj, vec3(anchor.m_local), 1.0};
}

class AnchorHolder
{
public:
    AnchorHolder(int body, const JointScene& scene, ContactProblem& problem)
        : m_fem(*scene.m_bodies[body]), m_body(body), m_scene(scene), m_problem(problem)
    {
    }

    template <class Anchor>
    void holdAll(btAlignedObjectArray<Anchor>& anchors)
    {
        int kept = 0;
        for (int i = 0; i < anchors.size(); ++i)
        {
            if (!hold(viewOf(anchors[i]))) continue;
            if (kept != i) anchors[kept] = anchors[i];
            ++kept;
        }
        if (kept < anchors.size()) m_flags.m_lost = true;
        while (anchors.size() > kept) anchors.pop_back();
    }

    JointFlags m_flags;

private:
    bool hold(const AnchorView& anchor);
    void append(const AnchorView& anchor, const RigidPivot& pivot, HeldJoint& held);

    FemSoftBody& m_fem;
    int m_body;
    const JointScene& m_scene;
    ContactProblem& m_problem;
};

// False if the anchor's object left the world.
bool AnchorHolder::hold(const AnchorView& anchor)
{
    const btAlignedObjectArray<btSoftBody::Node>& nodes = m_fem.m_softBody->m_nodes;
    const bool foreign = std::less<const void*>()(anchor.m_node, &nodes[0]) ||
                         !std::less<const void*>()(anchor.m_node, &nodes[0] + nodes.size());
    if (foreign || !anchor.m_object || !isFinite(anchor.m_local) || !(anchor.m_influence >= 0))
    {
        m_flags.m_bad = true;
        return true;
    }
    if (!m_scene.m_world.holds(*m_fem.m_softBody, anchor.m_object)) return false;

    HeldJoint held;
    held.m_kind = anchor.m_kind;
    held.m_node = static_cast<int>(anchor.m_node - &nodes[0]);
    held.m_object = anchor.m_object;
    held.m_objectId = broadphaseId(*anchor.m_object);
    held.m_point = m_fem.m_body.m_state.m_x[held.m_node];
    const RigidPivot pivot = rigidPivot(anchor.m_object, anchor.m_local, m_scene);
    held.m_error = norm(pivot.m_start - held.m_point);
    const HeldJoint* before = continuedBy(held, m_fem.m_joints.m_before, m_fem.m_joints.m_now.size());
    if (before)
    {
        // An object that was added since counts as the former one only if it is about where that held the node.
        const double jump = held.m_error - before->m_error;
        if (before->m_objectId != held.m_objectId && jump > m_fem.m_body.m_model->mesh().meanEdgeLength()) return false;
        held.m_impulse = before->m_impulse;
    }
    append(anchor, pivot, held);
    m_fem.m_joints.m_now.push_back(held);
    return true;
}

void AnchorHolder::append(const AnchorView& anchor, const RigidPivot& pivot, HeldJoint& held)
{
    const bool pinned = m_fem.m_body.m_state.m_fixed[held.m_node];
    if (anchor.m_influence == 0 || (pinned && !m_scene.m_rigid.rigidProxies()[pivot.m_rigidProxy].canMove()))
    {
        held.m_impulse = {};
        return;
    }
    Joint joint;
    joint.m_a = nodeEnd(m_body, held.m_node, m_problem);
    joint.m_b.m_rigidProxy = pivot.m_rigidProxy;
    const double erp = std::min(1.0, std::max(0.0, double(m_fem.m_softBody->m_cfg.kAHR)));
    joint.m_softness = anchor.m_influence < 1 ? 1 / anchor.m_influence - 1 : 0;
    const double longest = longestCorrection(m_fem, m_scene.m_step, joint.m_softness);
    const Vec3 correction = shortened(erp * (pivot.m_start - held.m_point), longest);
    // The impulse acts on both sides at one point, otherwise it would change the angular momentum of the pair. For a
    // distant pivot it acts at the pivot: with a lever of that length, the object would rotate ever faster while it is
    // drawn in.
    joint.m_b.m_point = held.m_error > longest ? pivot.m_now : held.m_point;
    joint.m_wanted = pivot.wantedVelocity(joint.m_b.m_point, correction, m_scene.m_step);
    joint.m_impulse = held.m_impulse;
    held.m_row = static_cast<int>(m_problem.m_joints.size());
    m_problem.m_joints.push_back(joint);
}

}  // namespace

JointFlags appendAnchors(int body, const JointScene& scene, ContactProblem& problem)
{
    FemSoftBody& fem = *scene.m_bodies[body];
    AnchorHolder holder(body, scene, problem);
    holder.holdAll(fem.m_softBody->m_anchors);
    holder.holdAll(fem.m_softBody->m_deformableAnchors);
    // Bullet never resets m_battach.
    const auto isAnchor = [](const HeldJoint& held)
    { return held.m_kind == HeldJoint::Kind::anchor || held.m_kind == HeldJoint::Kind::deformableAnchor; };
    for (const HeldJoint& held : fem.m_joints.m_before)
        if (isAnchor(held)) fem.m_softBody->m_nodes[held.m_node].m_battach = 0;
    for (const HeldJoint& held : fem.m_joints.m_now)
        if (isAnchor(held)) fem.m_softBody->m_nodes[held.m_node].m_battach = -1;  // a signed bit
    return holder.m_flags;
}

double longestCorrection(const FemSoftBody& fem, double step, double softness)
{
    const double share = std::min(kLongestCorrection, step * kFastestCorrection);
    return (1 + softness) * share * fem.m_body.m_model->mesh().meanEdgeLength();
}

const HeldJoint* continuedBy(const HeldJoint& now, const std::vector<HeldJoint>& before, std::size_t nth)
{
    if (nth < before.size() && now.continues(before[nth])) return &before[nth];
    const auto found = std::find_if(before.begin(), before.end(), [&](const HeldJoint& b) { return now.continues(b); });
    return found != before.end() ? &*found : nullptr;
}

}  // namespace bullet_fem
