// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>

#include "BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btFemIslandSolver;
class btFemSoftBodySolver;

/// Bullet's rigid-body solver, which solves islands with FEM bodies as one problem: contacts and joints of FEM bodies
/// with Bullet's contacts, rolling friction and constraints, so that stacks of rigid on soft on rigid bodies converge
/// within a step, come to rest and sleep. Give it to the world's constructor in place of
/// btSequentialImpulseConstraintSolver, with the world's btFemSoftBodySolver. Islands without FEM bodies give bitwise
/// equal results. In islands with FEM bodies Bullet's contacts are fully warm-started, with friction in two fixed
/// directions within Coulomb's cone; constraints that override solveConstraintObsolete are not called.
///
/// Without it the soft body solver does this after Bullet's step, for islands that it can put back to its start, with
/// the default btContactSolverInfo.
class BULLETFEM_API btFemConstraintSolver : public btSequentialImpulseConstraintSolver
{
public:
    /// `fem` must be the world's soft body solver and outlive this one. Throws std::invalid_argument if it is null.
    explicit btFemConstraintSolver(btFemSoftBodySolver* fem);
    ~btFemConstraintSolver() override;

    /// True if the constructor takes it; else `why` (if given) has its message. For engines without exceptions.
    static bool valid(const btFemSoftBodySolver* fem, std::string* why = nullptr);

    /// Called by the world: as in Bullet.
    btScalar solveGroup(btCollisionObject** bodies, int numBodies, btPersistentManifold** manifolds, int numManifolds,
                        btTypedConstraint** constraints, int numConstraints, const btContactSolverInfo& info,
                        btIDebugDraw* debugDrawer, btDispatcher* dispatcher) override;

protected:
    /// Called by Bullet's solver for a group: sweeps its rows and those of the FEM bodies in outer iterations. Returns
    /// 0.
    btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                               btPersistentManifold** manifolds, int numManifolds,
                                               btTypedConstraint** constraints, int numConstraints,
                                               const btContactSolverInfo& info, btIDebugDraw* debugDrawer) override;

private:
    friend class btFemIslandSolver;

    std::unique_ptr<btFemIslandSolver> m_islandSolver;
};
