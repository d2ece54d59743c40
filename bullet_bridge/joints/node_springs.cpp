// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/node_springs.h"

#include "bullet_bridge/joints/soft_anchors.h"

namespace bullet_fem
{
namespace
{

Vec3 pointOf(const NodeSpring& spring, const std::vector<Vec3>& x)
{
    return spring.m_weights[0] * x[spring.m_nodes[0]] + spring.m_weights[1] * x[spring.m_nodes[1]] +
           spring.m_weights[2] * x[spring.m_nodes[2]];
}

bool canMove(const NodeSpring& spring, const BodyState& state)
{
    bool moves = false;
    for (int a = 0; a < 3; ++a) moves = moves || (spring.m_weights[a] != 0 && !state.m_fixed[spring.m_nodes[a]]);
    return moves;
}

}  // namespace

// An implicit spring. With v the velocity at the end of the step, x + h v is the new position of the point:
//     lambda = h (k (target - x - h v) - d v)   or   v + lambda / (h s) = k (target - x) / s   with s = h k + d
void appendSprings(int body, const JointScene& scene, ContactProblem& problem)
{
    FemSoftBody& fem = *scene.m_bodies[body];
    const double h = scene.m_step;
    for (const NodeSpring& spring : fem.m_joints.m_springs)
    {
        HeldJoint held;
        held.m_kind = HeldJoint::Kind::spring;
        held.m_id = spring.m_id;
        held.m_point = pointOf(spring, fem.m_body.m_state.m_x);
        held.m_error = norm(spring.m_target - held.m_point);
        const double s = h * spring.m_stiffness + spring.m_damping;
        Joint joint;
        if (s > 0 && canMove(spring, fem.m_body.m_state))
        {
            joint.m_a = pointEnd(body, spring.m_nodes, spring.m_weights, problem);
            if (const HeldJoint* before = continuedBy(held, fem.m_joints.m_before, fem.m_joints.m_now.size()))
                joint.m_impulse = before->m_impulse;
            joint.m_wanted = spring.m_stiffness / s * (spring.m_target - held.m_point);
            joint.m_compliance = 1 / (h * s);
            if (spring.m_maxForce > 0) joint.m_maxImpulse = h * spring.m_maxForce;
            held.m_row = static_cast<int>(problem.m_joints.size());
            problem.m_joints.push_back(joint);
        }
        fem.m_joints.m_now.push_back(held);
    }
}

}  // namespace bullet_fem
