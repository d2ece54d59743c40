// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <atomic>
#include <mutex>
#include <vector>

#include "BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h"
#include "bullet_bridge/rigid/rigid_rewind.h"

class btFemContactGroup;
class btFemIslandSolver;
struct btFemBodyRecord;

/// The swap's coupling: puts rigid bodies that Bullet has solved and moved without soft bodies back to the start of the
/// step, solves them with the FEM bodies of a group, and moves them. Bullet sets its rows up, the group solves them
/// with its own.
class btFemRewindSolver : private btSequentialImpulseConstraintSolver
{
public:
    /// Call before collision detection; `soft`: a FEM body of the world, null if none moves.
    void note(const btSoftBody* soft);

    /// Call after note(), during collision detection, for constraints that no body refers to; `softBodies`: the array
    /// of the world. May be called by several threads.
    void noteWorld(const btAlignedObjectArray<btSoftBody*>& softBodies);

    /// Call once if bodies cannot be put back: the world's rigid solver solves FEM bodies, or forces are no longer on
    /// the rigid bodies.
    void disable() { m_isEnabled = false; }

    /// Call after Bullet has moved the rigid bodies: puts back those that these FEM bodies may touch or hold. False if
    /// some cannot be put back, and none is. `step` [s].
    bool rewind(const std::vector<btFemBodyRecord*>& records, double step);

    /// The islands that were put back.
    bullet_fem::RigidRewind& islands() { return m_rewind; }

    /// Call after the group's collect() in phase `solving`, with these islands. `step` [s].
    void solve(btFemContactGroup& group, double step);

private:
    friend class btFemIslandSolver;

    btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                               btPersistentManifold** manifolds, int numManifolds,
                                               btTypedConstraint** constraints, int numConstraints,
                                               const btContactSolverInfo& info, btIDebugDraw* debugDrawer) override;

    bullet_fem::RigidRewind m_rewind;
    bool m_isEnabled = true;
    std::atomic<bool> m_awaitsWorld{false};  // the constraints of the world may still be noted in this step
    std::mutex m_worldMutex;                 // guards m_rewind.noteWorld()
    btFemContactGroup* m_group = nullptr;
};
