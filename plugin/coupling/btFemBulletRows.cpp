// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/coupling/btFemBulletRows.h"

template <class Visit>
void btFemBulletRows::forEach(const Visit& visit) const
{
    for (btConstraintArray* rows :
         {&m_constraints.m_joints, &m_constraints.m_contacts, &m_constraints.m_friction, &m_constraints.m_torsions})
        for (int k = 0; k < rows->size(); ++k) visit((*rows)[k]);
    for (btMultiBodyConstraintArray* rows : m_links)
        for (int k = 0; k < rows->size(); ++k) visit((*rows)[k]);
}

void btFemBulletRows::note(std::vector<btScalar>& noted) const
{
    noted.clear();
    forEach([&noted](const auto& row) { noted.push_back(row.m_appliedImpulse); });
}

void btFemBulletRows::restoreBest(const std::vector<btScalar>& noted) const
{
    auto next = noted.begin();
    forEach(
        [&](auto& row)
        {
            const btScalar impulse = *next - btScalar(row.m_appliedImpulse);
            row.m_appliedImpulse = *next++;
            change(row, impulse);
        });
}

void btFemBulletRows::change(btSolverConstraint& row, btScalar impulse) const
{
    changeBody(row.m_solverBodyIdA, row.m_contactNormal1, row.m_angularComponentA, impulse);
    changeBody(row.m_solverBodyIdB, row.m_contactNormal2, row.m_angularComponentB, impulse);
}

void btFemBulletRows::change(btMultiBodySolverConstraint& row, btScalar impulse) const
{
    if (row.m_multiBodyA)
        changeLinks(*row.m_multiBodyA, row.m_jacAindex, row.m_deltaVelAindex, impulse);
    else
        changeBody(row.m_solverBodyIdA, row.m_contactNormal1, row.m_angularComponentA, impulse);
    if (row.m_multiBodyB)
        changeLinks(*row.m_multiBodyB, row.m_jacBindex, row.m_deltaVelBindex, impulse);
    else
        changeBody(row.m_solverBodyIdB, row.m_contactNormal2, row.m_angularComponentB, impulse);
}

void btFemBulletRows::changeBody(int body, const btVector3& linear, const btVector3& angular, btScalar impulse) const
{
    if (body < 0) return;
    btSolverBody& solverBody = m_constraints.m_bodies[body];
    solverBody.internalApplyImpulse(linear * solverBody.internalGetInvMass(), angular, impulse);
}

void btFemBulletRows::changeLinks(btMultiBody& body, int jacobian, int first, btScalar impulse) const
{
    body.applyDeltaVeeMultiDof2(&m_linkData.m_deltaVelocitiesUnitImpulse[jacobian], impulse);
    for (int k = 0; k < body.getNumDofs() + 6; ++k)
        m_linkData.m_deltaVelocities[first + k] += m_linkData.m_deltaVelocitiesUnitImpulse[jacobian + k] * impulse;
}
