// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>

#include "BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btFemIslandSolver;
class btFemSoftBodySolver;

/// The counterpart of btFemConstraintSolver for btSoftMultiBodyDynamicsWorld: Bullet's solver of rigid bodies and
/// multibodies, with contacts and joints of FEM bodies solved together with those between rigid bodies and links and
/// with motors, limits and loops of multibodies. A gripper made of links presses with the force of its motors within
/// the step. Give it to the world's constructor in place of btMultiBodyConstraintSolver, with the world's
/// btFemSoftBodySolver. Islands without FEM bodies give bitwise equal results. In islands with FEM bodies Bullet's rows
/// are fully warm-started, with friction in two fixed directions, and get as many sweeps as the soft rows.
class BULLETFEM_API btFemMultiBodyConstraintSolver : public btMultiBodyConstraintSolver
{
public:
    BT_DECLARE_ALIGNED_ALLOCATOR();

    /// `fem` must be the world's soft body solver and outlive this one. Throws std::invalid_argument if it is null.
    explicit btFemMultiBodyConstraintSolver(btFemSoftBodySolver* fem);
    ~btFemMultiBodyConstraintSolver() override;

    /// True if the constructor takes it; else `why` (if given) has its message. For engines without exceptions.
    static bool valid(const btFemSoftBodySolver* fem, std::string* why = nullptr);

    /// Called by the world: as in Bullet.
    void solveMultiBodyGroup(btCollisionObject** bodies, int numBodies, btPersistentManifold** manifolds,
                             int numManifolds, btTypedConstraint** constraints, int numConstraints,
                             btMultiBodyConstraint** multiBodyConstraints, int numMultiBodyConstraints,
                             const btContactSolverInfo& info, btIDebugDraw* debugDrawer,
                             btDispatcher* dispatcher) override;

protected:
    /// Called by Bullet's solver for a group: solves its rows and those of the FEM bodies as one problem. Returns
    /// 0.
    btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                               btPersistentManifold** manifolds, int numManifolds,
                                               btTypedConstraint** constraints, int numConstraints,
                                               const btContactSolverInfo& info, btIDebugDraw* debugDrawer) override;

private:
    friend class btFemIslandSolver;

    std::unique_ptr<btFemIslandSolver> m_islandSolver;
};
