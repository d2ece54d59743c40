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

/// The btFemConstraintSolver of btSoftMultiBodyDynamicsWorld: Bullet's solver of rigid bodies and multibodies with the
/// FEM bodies in it. Contacts and joints of soft bodies are swept together with those between rigid bodies and links,
/// with motors, limits and loops of multibodies, so a gripper of links presses with what its motors give, and at once.
/// Give it to the world's constructor in place of btMultiBodyConstraintSolver, with the same btFemSoftBodySolver as
/// soft body solver; islands without FEM bodies are solved bit for bit as before. In those with FEM bodies Bullet's
/// rows are warm-started fully, with friction in two fixed directions, and swept as often as the soft ones.
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
    /// Called by Bullet's solver for a group: its rows and the FEM bodies' in rounds. Returns 0.
    btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                               btPersistentManifold** manifolds, int numManifolds,
                                               btTypedConstraint** constraints, int numConstraints,
                                               const btContactSolverInfo& info, btIDebugDraw* debugDrawer) override;

private:
    friend class btFemIslandSolver;

    std::unique_ptr<btFemIslandSolver> m_islandSolver;
};
