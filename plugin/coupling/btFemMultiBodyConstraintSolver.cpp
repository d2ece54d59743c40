// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemMultiBodyConstraintSolver.h"

#include <stdexcept>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/coupling/btFemIslands.h"
#include "plugin/coupling/btFemLinkRows.h"
#include "plugin/coupling/btFemSolveTogether.h"

btFemMultiBodyConstraintSolver::btFemMultiBodyConstraintSolver(btFemSoftBodySolver* fem) : m_fem(fem)
{
    std::string why;
    if (!valid(fem, &why)) throw std::invalid_argument("btFemMultiBodyConstraintSolver: " + why);
    m_islands = std::make_unique<btFemIslands>(*fem);
}

btFemMultiBodyConstraintSolver::~btFemMultiBodyConstraintSolver() = default;

bool btFemMultiBodyConstraintSolver::valid(const btFemSoftBodySolver* fem, std::string* why)
{
    if (!fem && why) *why = "the FEM solver is null; give the btFemSoftBodySolver of the world";
    return fem != nullptr;
}

void btFemMultiBodyConstraintSolver::solveMultiBodyGroup(btCollisionObject** bodies, int numBodies,
                                                         btPersistentManifold** manifolds, int numManifolds,
                                                         btTypedConstraint** constraints, int numConstraints,
                                                         btMultiBodyConstraint** multiBodyConstraints,
                                                         int numMultiBodyConstraints, const btContactSolverInfo& info,
                                                         btIDebugDraw* debugDrawer, btDispatcher* dispatcher)
{
    const btFemBatch all = {bodies,
                            numBodies,
                            manifolds,
                            numManifolds,
                            constraints,
                            numConstraints,
                            multiBodyConstraints,
                            numMultiBodyConstraints};
    const auto solve = [&](const btFemBatch& batch, const btContactSolverInfo& settings)
    {
        btMultiBodyConstraintSolver::solveMultiBodyGroup(
            batch.m_bodies, batch.m_bodyCount, batch.m_manifolds, batch.m_manifoldCount, batch.m_constraints,
            batch.m_constraintCount, batch.m_multiBodyConstraints, batch.m_multiBodyConstraintCount, settings,
            debugDrawer, dispatcher);
    };
    solveBatch(*m_fem, *m_islands, all, info, true, m_group, solve);
}

btScalar btFemMultiBodyConstraintSolver::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int numBodies, btPersistentManifold** manifolds, int numManifolds,
    btTypedConstraint** constraints, int numConstraints, const btContactSolverInfo& info, btIDebugDraw* debugDrawer)
{
    if (!m_group)
        return btMultiBodyConstraintSolver::solveGroupCacheFriendlyIterations(
            bodies, numBodies, manifolds, numManifolds, constraints, numConstraints, info, debugDrawer);

    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, manifolds, numManifolds, constraints,
                                                  numConstraints, info, debugDrawer);
    m_group->begin(m_tmpSolverBodyPool, &m_data.m_deltaVelocities);
    const auto sweep = [&](int iteration)
    {
        return solveSingleIteration(iteration, bodies, numBodies, manifolds, numManifolds, constraints, numConstraints,
                                    info, debugDrawer);
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
    return 0;
}
