// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemConstraintSolver.h"

#include <stdexcept>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/coupling/btFemIslandSolver.h"

btFemConstraintSolver::btFemConstraintSolver(btFemSoftBodySolver* fem)
{
    std::string why;
    if (!valid(fem, &why)) throw std::invalid_argument("btFemConstraintSolver: " + why);
    m_islandSolver = std::make_unique<btFemIslandSolver>(*fem);
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
    m_islandSolver->solveBatch(all, info, false, solve);
    return 0;
}

btScalar btFemConstraintSolver::solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                                                  btPersistentManifold** manifolds, int numManifolds,
                                                                  btTypedConstraint** constraints, int numConstraints,
                                                                  const btContactSolverInfo& info,
                                                                  btIDebugDraw* debugDrawer)
{
    if (!m_islandSolver->hasFem())
        return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
            bodies, numBodies, manifolds, numManifolds, constraints, numConstraints, info, debugDrawer);

    btFemIslandSolver::clearBadPushes(*this);
    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, manifolds, numManifolds, constraints,
                                                  numConstraints, info, debugDrawer);
    m_islandSolver->solveTogether(*this);
    return 0;
}
