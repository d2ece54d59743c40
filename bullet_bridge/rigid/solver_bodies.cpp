// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/solver_bodies.h"

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{

void SolverBodies::begin(RigidProxies& rigid, btAlignedObjectArray<btSolverBody>& pool,
                         btAlignedObjectArray<btScalar>* linkDeltas)
{
    m_pool = &pool;
    m_hasLinks = linkDeltas && !rigid.links().isEmpty();
    if (m_hasLinks) m_linkDeltas.begin(rigid.links(), *linkDeltas);
    m_links.assign(rigid.rigidProxies().size(), Link());
    m_proxyOf.assign(pool.size(), -1);
    for (std::size_t k = 0; k < m_links.size(); ++k)
    {
        const btRigidBody* body = movableBody(rigid.object(static_cast<int>(k)));
        if (!body || body->getCompanionId() < 0 || body->getCompanionId() >= pool.size()) continue;
        const RigidHistory::Remainder& remainder = rigid.history().remainderOf(rigid.object(static_cast<int>(k)));
        m_links[k].m_solverBody = body->getCompanionId();
        m_proxyOf[body->getCompanionId()] = static_cast<int>(k);
        m_links[k].m_linearRemainder = remainder.m_linear;
        m_links[k].m_angularRemainder = remainder.m_angular;
    }
}

void SolverBodies::read(std::vector<RigidProxy>& rigidProxies)
{
    for (std::size_t k = 0; k < m_links.size(); ++k)
    {
        Link& link = m_links[k];
        if (link.m_solverBody < 0) continue;
        const btSolverBody& body = (*m_pool)[link.m_solverBody];
        link.m_linear = vec3(body.m_linearVelocity) + vec3(body.m_deltaLinearVelocity) +
                        vec3(body.m_externalForceImpulse) + link.m_linearRemainder;
        link.m_angular = vec3(body.m_angularVelocity) + vec3(body.m_deltaAngularVelocity) +
                         vec3(body.m_externalTorqueImpulse) + link.m_angularRemainder;
        rigidProxies[k].m_linearVelocity = link.m_linear;
        rigidProxies[k].m_angularVelocity = link.m_angular;
    }
    if (m_hasLinks) m_linkDeltas.read(rigidProxies);
}

void SolverBodies::write(const std::vector<RigidProxy>& rigidProxies)
{
    for (std::size_t k = 0; k < m_links.size(); ++k)
    {
        Link& link = m_links[k];
        if (link.m_solverBody < 0) continue;
        btSolverBody& body = (*m_pool)[link.m_solverBody];
        body.m_deltaLinearVelocity = addedExactly(
            body.m_deltaLinearVelocity, rigidProxies[k].m_linearVelocity - link.m_linear, link.m_linearRemainder);
        body.m_deltaAngularVelocity = addedExactly(
            body.m_deltaAngularVelocity, rigidProxies[k].m_angularVelocity - link.m_angular, link.m_angularRemainder);
    }
    if (m_hasLinks) m_linkDeltas.write(rigidProxies);
}

void SolverBodies::end(RigidProxies& rigid)
{
    for (std::size_t k = 0; k < m_links.size(); ++k)
    {
        if (m_links[k].m_solverBody < 0) continue;
        btSolverBody& body = (*m_pool)[m_links[k].m_solverBody];
        if (!isBelow(kFastest, vec3(body.m_deltaLinearVelocity)) ||
            !isBelow(kFastest, vec3(body.m_deltaAngularVelocity)))
        {
            body.m_deltaLinearVelocity.setZero();
            body.m_deltaAngularVelocity.setZero();
            m_links[k].m_linearRemainder = m_links[k].m_angularRemainder = {};
        }
        RigidHistory::Remainder& remainder = rigid.history().remainderOf(rigid.object(static_cast<int>(k)));
        remainder.m_linear = m_links[k].m_linearRemainder;
        remainder.m_angular = m_links[k].m_angularRemainder;
        remainder.m_used = true;
    }
}

}  // namespace bullet_fem
