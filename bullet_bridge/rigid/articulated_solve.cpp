// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// ArticulatedBodies within Bullet's rigid solver: its rows and the impulses of soft bodies change joint velocities in
// one single-precision array.
#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "bullet_bridge/rigid/articulated_bodies.h"

namespace bullet_fem
{

void ArticulatedBodies::beginSolve(btAlignedObjectArray<btScalar>& deltas)
{
    m_deltas = &deltas;
    m_beyondDeltas.assign(m_velocity.size(), 0);
    m_solved.assign(m_velocity.size(), 0);
    for (Link& link : m_links) link.m_accumulatedImpulse = link.m_accumulatedAngularImpulse = {};
}

// Total change of coordinate k. A multibody without rows in Bullet's solver has no entry in *m_deltas.
double ArticulatedBodies::changeIn(const Tree& tree, int k) const
{
    const int first = tree.m_body->getCompanionId();
    const double known = first >= 0 ? double((*m_deltas)[first + k]) : 0;
    return known + m_beyondDeltas[tree.m_first + k];
}

void ArticulatedBodies::readSolved(std::vector<RigidProxy>& rigidProxies) const
{
    for (const Tree& tree : m_trees)
        for (int k = 0; k < tree.m_coordinates; ++k)
            m_solved[tree.m_first + k] = m_velocity[tree.m_first + k] + changeIn(tree, k);
    for (const Link& link : m_links)
    {
        const LinkMotion now = motion(link, m_solved);
        rigidProxies[link.m_rigidProxy].m_linearVelocity = now.m_linear;
        rigidProxies[link.m_rigidProxy].m_angularVelocity = now.m_angular;
    }
}

void ArticulatedBodies::writeSolved(const std::vector<RigidProxy>& rigidProxies)
{
    for (Link& link : m_links)
    {
        const RigidProxy& proxy = rigidProxies[link.m_rigidProxy];
        const Vec3 impulse = proxy.m_accumulatedImpulse - link.m_accumulatedImpulse,
                   angular = proxy.m_accumulatedAngularImpulse - link.m_accumulatedAngularImpulse;
        link.m_accumulatedImpulse = proxy.m_accumulatedImpulse;
        link.m_accumulatedAngularImpulse = proxy.m_accumulatedAngularImpulse;
        const Tree& tree = m_trees[link.m_tree];
        for (int row = 0; row < 6; ++row)
            for (int k = 0; k < tree.m_coordinates; ++k)
                m_beyondDeltas[tree.m_first + k] += double(m_answer[link.m_first + row * tree.m_coordinates + k]) *
                                                    (row < 3 ? impulse[row] : angular[row - 3]);
    }
    for (const Tree& tree : m_trees)
    {
        const int first = tree.m_body->getCompanionId();
        for (int k = 0; first >= 0 && k < tree.m_coordinates; ++k)
        {
            const double exact = changeIn(tree, k);
            (*m_deltas)[first + k] = static_cast<btScalar>(exact);
            m_beyondDeltas[tree.m_first + k] = exact - double((*m_deltas)[first + k]);
        }
    }
}

}  // namespace bullet_fem
