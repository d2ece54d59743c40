// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/coupling/btFemRewindSolver.h"

#include "plugin/coupling/btFemIslandSolver.h"
#include "plugin/stages/btFemContactGroup.h"

void btFemRewindSolver::solve(btFemContactGroup& group, bullet_fem::RigidRewind& rewind, double step)
{
    if (rewind.bodies().empty()) return group.solve();
    m_group = &group;
    btContactSolverInfo info;
    info.m_timeStep = btScalar(step);
    const auto count = [](const auto& values) { return static_cast<int>(values.size()); };
    solveGroup(rewind.bodies().data(), count(rewind.bodies()), rewind.manifolds().data(), count(rewind.manifolds()),
               rewind.constraints().data(), count(rewind.constraints()), settingsWithFem(info), nullptr, nullptr);
    group.moveRigid();
    rewind.move();
}

btScalar btFemRewindSolver::solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                                              btPersistentManifold** manifolds, int numManifolds,
                                                              btTypedConstraint** constraints, int numConstraints,
                                                              const btContactSolverInfo& info,
                                                              btIDebugDraw* debugDrawer)
{
    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, manifolds, numManifolds, constraints,
                                                  numConstraints, info, debugDrawer);
    m_group->solveWith({m_tmpSolverBodyPool, m_tmpSolverNonContactConstraintPool, m_tmpSolverContactConstraintPool,
                        m_tmpSolverContactFrictionConstraintPool, m_tmpSolverContactRollingFrictionConstraintPool});
    return 0;
}
