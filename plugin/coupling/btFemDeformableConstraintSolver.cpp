// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemDeformableConstraintSolver.h"

#include <algorithm>
#include <stdexcept>

#include "bullet_fem/btFemDeformableBodySolver.h"
#include "plugin/coupling/btFemIslandSolver.h"

btFemDeformableConstraintSolver::btFemDeformableConstraintSolver(btFemDeformableBodySolver* deformable)
    : m_deformable(deformable)
{
    std::string why;
    if (!valid(deformable, &why)) throw std::invalid_argument("btFemDeformableConstraintSolver: " + why);
    setDeformableSolver(deformable);
    m_islandSolver = std::make_unique<btFemIslandSolver>(deformable->fem());
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
    m_islandSolver->solveBatch(all, info, true, solve);
}

// Bullet's own soft bodies act on the velocities of rigid bodies, not on those of the solver's bodies.
btScalar btFemDeformableConstraintSolver::solveDeformableGroupIterations(
    btCollisionObject** bodies, int numBodies, btCollisionObject** deformableBodies, int numDeformableBodies,
    btPersistentManifold** manifolds, int numManifolds, btTypedConstraint** constraints, int numConstraints,
    const btContactSolverInfo& info, btIDebugDraw* debugDrawer)
{
    if (!m_islandSolver->hasFem())
        return btDeformableMultiBodyConstraintSolver::solveDeformableGroupIterations(
            bodies, numBodies, deformableBodies, numDeformableBodies, manifolds, numManifolds, constraints,
            numConstraints, info, debugDrawer);

    pairDeformableAndSolverBody(bodies, numBodies, numDeformableBodies, info);
    btFemIslandSolver::clearBadPushes(*this);
    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, deformableBodies, numDeformableBodies, manifolds,
                                                  numManifolds, constraints, numConstraints, info, debugDrawer);
    const auto isFem = [this](const btCollisionObject* body)
    { return m_deformable->fem().isFem(btSoftBody::upcast(body)); };
    const auto sweep = [&](int iteration)
    {
        const btScalar rigid = solveSingleIteration(iteration, bodies, numBodies, manifolds, numManifolds, constraints,
                                                    numConstraints, info, debugDrawer);
        solverBodyWriteBack(info);
        const btScalar soft = m_deformable->solveContactConstraints(deformableBodies, numDeformableBodies, info);
        writeToSolverBody(bodies, numBodies, info);
        return std::max(rigid, soft);
    };
    if (std::all_of(deformableBodies, deformableBodies + numDeformableBodies, isFem))
        m_islandSolver->solveTogether(*this);
    else
        m_islandSolver->solveInTurn(*this, info, sweep);
    m_deformable->deformableBodyInternalWriteBack();
    return 0;
}
