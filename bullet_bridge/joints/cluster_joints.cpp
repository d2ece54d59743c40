// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/cluster_joints.h"

#include "bullet_bridge/joints/cluster_joint_maker.h"
#include "bullet_bridge/joints/cluster_motion.h"

namespace bullet_fem
{
namespace
{

// True if the joint still exists: callbacks may have deleted it.
bool stillThere(const btSoftBody& soft, const HiddenJoint& hidden)
{
    return hidden.m_joint && soft.m_joints.findLinearSearch2(hidden.m_joint) >= 0;
}

}  // namespace

void hideClusterJoints(FemSoftBody& fem)
{
    btSoftBody& soft = *fem.m_softBody;
    if (!fem.m_joints.m_hidden.empty()) showClusterJoints(fem);  // left by an unfinished step
    int kept = 0;
    for (int k = 0; k < soft.m_joints.size(); ++k)
    {
        btSoftBody::Joint* joint = soft.m_joints[k];
        const bool isContact = joint->Type() == btSoftBody::Joint::eType::Contact;
        if (isContact || soft.m_clusters.size() == 0)
        {
            btAlignedFree(joint);
            continue;
        }
        soft.m_joints[kept++] = joint;
        HiddenJoint hidden;
        hidden.m_joint = joint;
        hidden.m_control = btSoftBody::AJoint::IControl::Default();
        const btSoftBody::Cluster* own = joint->m_bodies[0].m_soft;
        hidden.m_bodies[0] = hidden.m_bodies[1] =
            btSoftBody::Body(holdsCluster(soft, own) ? joint->m_bodies[0].m_soft : soft.m_clusters[0]);
        swapEnds(hidden);
        fem.m_joints.m_hidden.push_back(hidden);
    }
    while (soft.m_joints.size() > kept) soft.m_joints.pop_back();
}

JointFlags appendClusterJoints(int body, const JointScene& scene, ContactProblem& problem)
{
    FemSoftBody& fem = *scene.m_bodies[body];
    JointFlags flags;
    ClusterJointMaker maker(body, scene, problem);
    for (HiddenJoint& hidden : fem.m_joints.m_hidden)
        if (stillThere(*fem.m_softBody, hidden)) flags |= maker.append(hidden);
    return flags;
}

void showClusterJoints(FemSoftBody& fem)
{
    btSoftBody& soft = *fem.m_softBody;
    for (HiddenJoint& hidden : fem.m_joints.m_hidden)
        if (stillThere(soft, hidden)) swapEnds(hidden);
    fem.m_joints.m_hidden.clear();
    for (int c = 0; c < soft.m_clusters.size(); ++c)
        if (isClusterOf(fem, *soft.m_clusters[c])) ClusterMotion(fem, *soft.m_clusters[c]).writeTo(*soft.m_clusters[c]);
}

}  // namespace bullet_fem
