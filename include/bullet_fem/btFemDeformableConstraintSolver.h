// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>

#include "BulletSoftBody/btDeformableMultiBodyConstraintSolver.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btFemDeformableBodySolver;
class btFemIslandSolver;

/// The counterpart of btFemConstraintSolver for btDeformableMultiBodyDynamicsWorld (see
/// btFemMultiBodyConstraintSolver): give it to the world's constructor in place of
/// btDeformableMultiBodyConstraintSolver. Cloth and other bodies of Bullet's own solver that share an island with FEM
/// bodies are solved with it in every sweep, as Bullet does in each of its iterations.
class BULLETFEM_API btFemDeformableConstraintSolver : public btDeformableMultiBodyConstraintSolver
{
public:
    BT_DECLARE_ALIGNED_ALLOCATOR();

    /// `deformable` must be the world's deformable body solver and outlive this one; it need not be given to
    /// setDeformableSolver. Throws std::invalid_argument if it is null.
    explicit btFemDeformableConstraintSolver(btFemDeformableBodySolver* deformable);
    ~btFemDeformableConstraintSolver() override;

    /// True if the constructor takes it; else `why` (if given) has its message. For engines without exceptions.
    static bool valid(const btFemDeformableBodySolver* deformable, std::string* why = nullptr);

    /// Called by the world: as in Bullet.
    void solveDeformableBodyGroup(btCollisionObject** bodies, int numBodies, btCollisionObject** deformableBodies,
                                  int numDeformableBodies, btPersistentManifold** manifolds, int numManifolds,
                                  btTypedConstraint** constraints, int numConstraints,
                                  btMultiBodyConstraint** multiBodyConstraints, int numMultiBodyConstraints,
                                  const btContactSolverInfo& info, btIDebugDraw* debugDrawer,
                                  btDispatcher* dispatcher) override;

protected:
    /// Called by Bullet's solver for a group: sweeps its rows and those of the FEM bodies in outer iterations. Returns
    /// 0.
    btScalar solveDeformableGroupIterations(btCollisionObject** bodies, int numBodies,
                                            btCollisionObject** deformableBodies, int numDeformableBodies,
                                            btPersistentManifold** manifolds, int numManifolds,
                                            btTypedConstraint** constraints, int numConstraints,
                                            const btContactSolverInfo& info, btIDebugDraw* debugDrawer) override;

private:
    friend class btFemIslandSolver;

    btFemDeformableBodySolver* m_deformable;
    std::unique_ptr<btFemIslandSolver> m_islandSolver;
};
