// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemMultiBodyConstraintSolver.h"

#include <stdexcept>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/coupling/btFemIslandSolver.h"

btFemMultiBodyConstraintSolver::btFemMultiBodyConstraintSolver(btFemSoftBodySolver* fem)
{
    std::string why;
    if (!valid(fem, &why)) throw std::invalid_argument("btFemMultiBodyConstraintSolver: " + why);
    m_islandSolver = std::make_unique<btFemIslandSolver>(*fem);
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
    m_islandSolver->solveBatch(all, info, true, solve);
}

btScalar btFemMultiBodyConstraintSolver::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int numBodies, btPersistentManifold** manifolds, int numManifolds,
    btTypedConstraint** constraints, int numConstraints, const btContactSolverInfo& info, btIDebugDraw* debugDrawer)
{
    if (!m_islandSolver->hasFem())
        return btMultiBodyConstraintSolver::solveGroupCacheFriendlyIterations(
            bodies, numBodies, manifolds, numManifolds, constraints, numConstraints, info, debugDrawer);

    btFemIslandSolver::clearBadPushes(*this);
    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, manifolds, numManifolds, constraints,
                                                  numConstraints, info, debugDrawer);
    m_islandSolver->solveTogether(*this);
    return 0;
}
