// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/link_deltas.h"

#include "BulletDynamics/Featherstone/btMultiBody.h"

namespace bullet_fem
{

void LinkDeltas::begin(ArticulatedBodies& bodies, btAlignedObjectArray<btScalar>& deltas)
{
    m_bodies = &bodies;
    m_deltas = &deltas;
    m_beyond.assign(bodies.m_velocity.size(), 0);
    m_solved.assign(bodies.m_velocity.size(), 0);
    m_written.assign(bodies.m_links.size(), {});
}

// Total change of coordinate k. A multibody without rows in Bullet's solver has no entry in *m_deltas.
double LinkDeltas::changeIn(std::size_t tree, int k) const
{
    const int first = m_bodies->m_trees[tree].m_body->getCompanionId();
    const double known = first >= 0 ? double((*m_deltas)[first + k]) : 0;
    return known + m_beyond[m_bodies->m_trees[tree].m_first + k];
}

void LinkDeltas::read(std::vector<RigidProxy>& rigidProxies)
{
    for (std::size_t t = 0; t < m_bodies->m_trees.size(); ++t)
    {
        const ArticulatedBodies::Tree& tree = m_bodies->m_trees[t];
        for (int k = 0; k < tree.m_coordinates; ++k)
            m_solved[tree.m_first + k] = m_bodies->m_velocity[tree.m_first + k] + changeIn(t, k);
    }
    for (const ArticulatedBodies::Link& link : m_bodies->m_links)
    {
        const LinkMotion now = m_bodies->motion(link, m_solved);
        rigidProxies[link.m_rigidProxy].m_linearVelocity = now.m_linear;
        rigidProxies[link.m_rigidProxy].m_angularVelocity = now.m_angular;
    }
}

void LinkDeltas::write(const std::vector<RigidProxy>& rigidProxies)
{
    for (std::size_t l = 0; l < m_written.size(); ++l)
    {
        const ArticulatedBodies::Link& link = m_bodies->m_links[l];
        const RigidProxy& proxy = rigidProxies[link.m_rigidProxy];
        const Vec3 impulse = proxy.m_accumulatedImpulse - m_written[l].m_impulse,
                   angular = proxy.m_accumulatedAngularImpulse - m_written[l].m_angularImpulse;
        m_written[l] = {proxy.m_accumulatedImpulse, proxy.m_accumulatedAngularImpulse};
        const ArticulatedBodies::Tree& tree = m_bodies->m_trees[link.m_tree];
        for (int row = 0; row < 6; ++row)
            for (int k = 0; k < tree.m_coordinates; ++k)
                m_beyond[tree.m_first + k] += double(m_bodies->m_answer[link.m_first + row * tree.m_coordinates + k]) *
                                              (row < 3 ? impulse[row] : angular[row - 3]);
    }
    for (std::size_t t = 0; t < m_bodies->m_trees.size(); ++t)
    {
        const ArticulatedBodies::Tree& tree = m_bodies->m_trees[t];
        const int first = tree.m_body->getCompanionId();
        for (int k = 0; first >= 0 && k < tree.m_coordinates; ++k)
        {
            const double exact = changeIn(t, k);
            (*m_deltas)[first + k] = static_cast<btScalar>(exact);
            m_beyond[tree.m_first + k] = exact - double((*m_deltas)[first + k]);
        }
    }
}

}  // namespace bullet_fem
