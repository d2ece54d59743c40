// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h"
#include "bullet_bridge/rigid/rigid_rewind.h"

class btFemContactGroup;

/// Solves rigid bodies that were put back to the start of the step (see bullet_fem::RigidRewind) with the FEM bodies of
/// a group, and moves them: Bullet sets its rows up, the group solves them with its own.
class btFemRewindSolver : private btSequentialImpulseConstraintSolver
{
public:
    /// `rewind` after keepOnly(); the group after collect() in phase `solving`. `step` [s].
    void solve(btFemContactGroup& group, bullet_fem::RigidRewind& rewind, double step);

private:
    btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                               btPersistentManifold** manifolds, int numManifolds,
                                               btTypedConstraint** constraints, int numConstraints,
                                               const btContactSolverInfo& info, btIDebugDraw* debugDrawer) override;

    btFemContactGroup* m_group = nullptr;
};
