// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemDeformableConstraintSolver.h"

#include <algorithm>
#include <stdexcept>

#include "bullet_fem/btFemDeformableBodySolver.h"
#include "plugin/coupling/btFemIslands.h"
#include "plugin/coupling/btFemLinkRows.h"
#include "plugin/coupling/btFemSolveTogether.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"

btFemDeformableConstraintSolver::btFemDeformableConstraintSolver(btFemDeformableBodySolver* deformable)
    : m_deformable(deformable)
{
    std::string why;
    if (!valid(deformable, &why)) throw std::invalid_argument("btFemDeformableConstraintSolver: " + why);
    setDeformableSolver(deformable);
    m_islands = std::make_unique<btFemIslands>(deformable->fem());
}

btFemDeformableConstraintSolver::~btFemDeformableConstraintSolver() = default;

bool btFemDeformableConstraintSolver::valid(const btFemDeformableBodySolver* deformable, std::string* why)
{
    if (!deformable && why)
        *why = "the deformable body solver is null; give the btFemDeformableBodySolver of the world";
    return deformable != nullptr;
}

void btFemDeformableConstraintSolver::solveDeformableBodyGroup(
    btCollisionObject** bodies, int numBodies, btCollisionObject** deformableBodies, int numDeformableBodies,
    btPersistentManifold** manifolds, int numManifolds, btTypedConstraint** constraints, int numConstraints,
    btMultiBodyConstraint** multiBodyConstraints, int numMultiBodyConstraints, const btContactSolverInfo& info,
    btIDebugDraw* debugDrawer, btDispatcher* dispatcher)
{
    const btFemBatch all = {bodies,
                            numBodies,
                            manifolds,
                            numManifolds,
                            constraints,
                            numConstraints,
                            multiBodyConstraints,
                            numMultiBodyConstraints,
                            deformableBodies,
                            numDeformableBodies};
    const auto solve = [&](const btFemBatch& batch, const btContactSolverInfo& settings)
    {
        btDeformableMultiBodyConstraintSolver::solveDeformableBodyGroup(
            batch.m_bodies, batch.m_bodyCount, batch.m_softBodies, batch.m_softBodyCount, batch.m_manifolds,
            batch.m_manifoldCount, batch.m_constraints, batch.m_constraintCount, batch.m_multiBodyConstraints,
            batch.m_multiBodyConstraintCount, settings, debugDrawer, dispatcher);
    };
    solveBatch(m_deformable->fem(), *m_islands, all, info, true, m_group, solve);
}

bool btFemDeformableConstraintSolver::isFem(const btCollisionObject& body) const
{
    const btSoftBody* soft = btSoftBody::upcast(&body);
    const btFemBodyRecord* record = soft ? btFemCoupling::record(m_deformable->fem(), *soft) : nullptr;
    return record && record->isFem();
}

// Bullet's own soft bodies act on the velocities of rigid bodies, not on those of the solver's bodies.
btScalar btFemDeformableConstraintSolver::solveDeformableGroupIterations(
    btCollisionObject** bodies, int numBodies, btCollisionObject** deformableBodies, int numDeformableBodies,
    btPersistentManifold** manifolds, int numManifolds, btTypedConstraint** constraints, int numConstraints,
    const btContactSolverInfo& info, btIDebugDraw* debugDrawer)
{
    if (!m_group)
        return btDeformableMultiBodyConstraintSolver::solveDeformableGroupIterations(
            bodies, numBodies, deformableBodies, numDeformableBodies, manifolds, numManifolds, constraints,
            numConstraints, info, debugDrawer);

    pairDeformableAndSolverBody(bodies, numBodies, numDeformableBodies, info);
    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, deformableBodies, numDeformableBodies, manifolds,
                                                  numManifolds, constraints, numConstraints, info, debugDrawer);
    m_group->begin(m_tmpSolverBodyPool, &m_data.m_deltaVelocities);
    const bool others = !std::all_of(deformableBodies, deformableBodies + numDeformableBodies,
                                     [this](const btCollisionObject* body) { return isFem(*body); });
    const auto sweep = [&](int iteration)
    {
        const btScalar rigid = solveSingleIteration(iteration, bodies, numBodies, manifolds, numManifolds, constraints,
                                                    numConstraints, info, debugDrawer);
        if (!others) return rigid;
        solverBodyWriteBack(info);
        const btScalar soft = m_deformable->solveContactConstraints(deformableBodies, numDeformableBodies, info);
        writeToSolverBody(bodies, numBodies, info);
        return std::max(rigid, soft);
    };
    const btFemLinkRows rows = {
        m_tmpSolverBodyPool,
        {&m_tmpSolverNonContactConstraintPool, &m_tmpSolverContactConstraintPool,
         &m_tmpSolverContactFrictionConstraintPool, &m_tmpSolverContactRollingFrictionConstraintPool},
        {&m_multiBodyNonContactConstraints, &m_multiBodyNormalContactConstraints,
         &m_multiBodyFrictionContactConstraints, &m_multiBodyTorsionalFrictionContactConstraints,
         &m_multiBodySpinningFrictionContactConstraints},
        m_data};
    const auto note = [&] { rows.note(m_noted); };
    const auto back = [&] { rows.restoreBest(m_noted); };
    solveTogether(*m_group, info, btFemRigidRows<decltype(sweep), decltype(note), decltype(back)>{sweep, note, back});
    m_deformable->deformableBodyInternalWriteBack();
    return 0;
}
