// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/coupling/btFemRewindSolver.h"

#include "bullet_bridge/body/rigid_dispatch.h"
#include "bullet_bridge/joints/soft_joints.h"
#include "bullet_bridge/rigid/enclosing_world.h"
#include "plugin/coupling/btFemIslandSolver.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/stages/btFemContactGroup.h"

using namespace bullet_fem;

// All FEM bodies of a solver are in one world.
void btFemRewindSolver::note(const btSoftBody* soft)
{
    m_awaitsWorld = soft && m_isEnabled;
    if (m_awaitsWorld)
        m_rewind.note(*soft);
    else
        m_rewind.forget();
}

void btFemRewindSolver::noteWorld(const btAlignedObjectArray<btSoftBody*>& softBodies)
{
    const btDispatcherInfo* info = dispatchInfoInUse();
    if (!info || !m_awaitsWorld) return;
    const std::lock_guard<std::mutex> lock(m_worldMutex);
    btDynamicsWorld* world = m_awaitsWorld ? enclosingWorld(softBodies, *info) : nullptr;
    if (!world) return;
    m_rewind.noteWorld(*world);
    m_awaitsWorld = false;
}

bool btFemRewindSolver::rewind(const std::vector<btFemBodyRecord*>& records, double step)
{
    m_awaitsWorld = false;
    bool can = m_rewind.begin(step) && m_isEnabled;
    const auto rewindIsland = [&](const btCollisionObject* object)
    {
        if (!can || !m_rewind.holds(object)) return;
        if (linkOf(*object) || (m_rewind.isNoted(*object) && !m_rewind.rewind(*object))) can = false;
    };
    for (const btFemBodyRecord* record : records)
    {
        for (const btCollisionObject* object : record->fem().m_overlaps.m_rigid) rewindIsland(object);
        forEachRigidEnd(record->fem(), rewindIsland);
    }
    if (!can) m_rewind.keepNone();
    return can;
}

void btFemRewindSolver::solve(btFemContactGroup& group, double step)
{
    RigidRewind& rewind = m_rewind;
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
    btFemIslandSolver::clearBadPushes(*this);
    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, manifolds, numManifolds, constraints,
                                                  numConstraints, info, debugDrawer);
    m_group->solveWith({m_tmpSolverBodyPool, m_tmpSolverNonContactConstraintPool, m_tmpSolverContactConstraintPool,
                        m_tmpSolverContactFrictionConstraintPool, m_tmpSolverContactRollingFrictionConstraintPool});
    return 0;
}
