// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "soak/trace.h"

#include <cstdio>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

void print(const btSoftBody& body, const btSoftBody::Anchor& anchor)
{
    const btVector3 arm = anchor.m_body->getWorldTransform().getBasis() * anchor.m_local;
    const btVector3 point = anchor.m_body->getWorldTransform().getOrigin() + arm;
    std::printf("    node %d, anchored %.4g m from a rigid body's centre, where it moves at %.4g m/s; %.4g m off\n",
                int(anchor.m_node - &body.m_nodes[0]), double(arm.length()),
                double(anchor.m_body->getVelocityInLocalPoint(arm).length()),
                double((anchor.m_node->m_x - point).length()));
}

void print(std::size_t k, const btSoftBody& body, const btFemStepReport& report)
{
    int fastest = 0, pinned = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        if (body.m_nodes[i].m_v.length2() > body.m_nodes[fastest].m_v.length2()) fastest = i;
        pinned += body.m_nodes[i].m_im == 0;
    }
    const Vec3 center = centerOf(body);
    std::printf(
        "  soft %zu: %.4g kg at (%.4g %.4g %.4g), node %d of %d is as fast as %.4g m/s, %.4g J; %d pinned, %d anchors, "
        "flags 0x%x, %d iterations\n",
        k, massOf(body), center.x, center.y, center.z, fastest, body.m_nodes.size(), fastestNode(body),
        motionOf(body).m_energy, pinned, body.m_anchors.size() + body.m_deformableAnchors.size(), report.m_flags,
        report.m_iterations);
    for (int a = 0; a < body.m_anchors.size(); ++a) print(body, body.m_anchors[a]);
}

void print(std::size_t k, const btRigidBody& body)
{
    const Vec3 x = vec3(body.getWorldTransform().getOrigin()), v = vec3(body.getLinearVelocity()),
               w = vec3(body.getAngularVelocity());
    const double inverseMass = double(body.getInvMass());
    std::printf("  rigid %zu: %.4g kg at (%.4g %.4g %.4g), (%.4g %.4g %.4g) m/s, (%.4g %.4g %.4g) rad/s\n", k,
                inverseMass > 0 ? 1 / inverseMass : 0.0, x.x, x.y, x.z, v.x, v.y, v.z, w.x, w.y, w.z);
}

}  // namespace

void printTrace(int act, RandomProgram& program)
{
    std::printf("act %d (%s), %ld steps\n", act, program.lastAct(), program.steps());
    const std::vector<btSoftBody*>& soft = program.soft();
    for (std::size_t k = 0; k < soft.size(); ++k) print(k, *soft[k], program.world().fem().stepReport(soft[k]));
    for (std::size_t k = 0; k < program.rigid().size(); ++k) print(k, *program.rigid()[k]);
}

}  // namespace bullet_fem
