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

/// Bullet's rigid solver with the FEM bodies in it: contacts and joints of soft bodies are swept together with those
/// between rigid bodies, so stacks of rigid on soft on rigid converge within a step, rest, and sleep. Give it to the
/// world's constructor in place of btSequentialImpulseConstraintSolver, with the same btFemSoftBodySolver as soft body
/// solver; islands without FEM bodies are solved bit for bit as before. In those with FEM bodies Bullet's rigid rows
/// are warm-started fully, with friction in two fixed directions, and swept as often as the soft ones.
///
/// Without it the rigid bodies feel a step's soft contacts after they have moved: momentum is exact all the same, and
/// static supports are, but a rigid body at rest on a soft one reads a velocity of g h, and stacks in which the soft
/// bodies are as heavy as the rigid ones fall.
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
    /// Called by Bullet's solver for a group: its rows and the FEM bodies' in rounds. Returns 0.
    btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                               btPersistentManifold** manifolds, int numManifolds,
                                               btTypedConstraint** constraints, int numConstraints,
                                               const btContactSolverInfo& info, btIDebugDraw* debugDrawer) override;

private:
    friend class btFemIslandSolver;

    std::unique_ptr<btFemIslandSolver> m_islandSolver;
};
