// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemConstraintSolver.h"

#include <stdexcept>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/coupling/btFemIslands.h"
#include "plugin/coupling/btFemSolveTogether.h"

btFemConstraintSolver::btFemConstraintSolver(btFemSoftBodySolver* fem) : m_fem(fem)
{
    std::string why;
    if (!valid(fem, &why)) throw std::invalid_argument("btFemConstraintSolver: " + why);
    m_islands = std::make_unique<btFemIslands>(*fem);
}

btFemConstraintSolver::~btFemConstraintSolver() = default;

bool btFemConstraintSolver::valid(const btFemSoftBodySolver* fem, std::string* why)
{
    if (!fem && why) *why = "the FEM solver is null; give the btFemSoftBodySolver of the world";
    return fem != nullptr;
}

btScalar btFemConstraintSolver::solveGroup(btCollisionObject** bodies, int numBodies, btPersistentManifold** manifolds,
                                           int numManifolds, btTypedConstraint** constraints, int numConstraints,
                                           const btContactSolverInfo& info, btIDebugDraw* debugDrawer,
                                           btDispatcher* dispatcher)
{
    const btFemBatch all = {bodies, numBodies, manifolds, numManifolds, constraints, numConstraints};
    const auto solve = [&](const btFemBatch& batch, const btContactSolverInfo& settings)
    {
        btSequentialImpulseConstraintSolver::solveGroup(batch.m_bodies, batch.m_bodyCount, batch.m_manifolds,
                                                        batch.m_manifoldCount, batch.m_constraints,
                                                        batch.m_constraintCount, settings, debugDrawer, dispatcher);
    };
    solveBatch(*m_fem, *m_islands, all, info, false, m_group, solve);
    return 0;
}

btScalar btFemConstraintSolver::solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                                                  btPersistentManifold** manifolds, int numManifolds,
                                                                  btTypedConstraint** constraints, int numConstraints,
                                                                  const btContactSolverInfo& info,
                                                                  btIDebugDraw* debugDrawer)
{
    if (!m_group)
        return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
            bodies, numBodies, manifolds, numManifolds, constraints, numConstraints, info, debugDrawer);

    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, manifolds, numManifolds, constraints,
                                                  numConstraints, info, debugDrawer);
    m_group->begin(m_tmpSolverBodyPool);
    const auto sweep = [&](int iteration)
    {
        return solveSingleIteration(iteration, bodies, numBodies, manifolds, numManifolds, constraints, numConstraints,
                                    info, debugDrawer);
    };
    const auto note = [this] { noteImpulses(); };
    const auto restoreBest = [this] { restoreNoted(); };
    solveTogether(*m_group, info,
                  btFemRigidRows<decltype(sweep), decltype(note), decltype(restoreBest)>{sweep, note, restoreBest});
    return 0;
}

template <class Visit>
void btFemConstraintSolver::forEachRigidRow(Visit visit)
{
    for (btConstraintArray* rows :
         {&m_tmpSolverNonContactConstraintPool, &m_tmpSolverContactConstraintPool,
          &m_tmpSolverContactFrictionConstraintPool, &m_tmpSolverContactRollingFrictionConstraintPool})
        for (int k = 0; k < rows->size(); ++k) visit((*rows)[k]);
}

void btFemConstraintSolver::noteImpulses()
{
    m_noted.clear();
    forEachRigidRow([this](const btSolverConstraint& row) { m_noted.push_back(row.m_appliedImpulse); });
}

// The velocities of the solver bodies follow, as in Bullet's own rows.
void btFemConstraintSolver::restoreNoted()
{
    auto noted = m_noted.begin();
    forEachRigidRow(
        [&](btSolverConstraint& row)
        {
            const btScalar change = *noted - btScalar(row.m_appliedImpulse);
            row.m_appliedImpulse = *noted++;
            btSolverBody &a = m_tmpSolverBodyPool[row.m_solverBodyIdA], &b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
            a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, change);
            b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, change);
        });
}
