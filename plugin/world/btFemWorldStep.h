// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/rigid/world_objects.h"
#include "bullet_fem/fem/batch/batch_memory.h"
#include "plugin/coupling/btFemRewindSolver.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/setup/btFemBodySetUp.h"
#include "plugin/stages/btFemContactGroup.h"
#include "plugin/stages/btFemDetailChooser.h"
#include "plugin/stages/btFemFreeMotion.h"
#include "plugin/stages/btFemKinematicSweeps.h"
#include "plugin/stages/btFemRefactoring.h"
#include "plugin/stages/btFemSplitter.h"

/// One step of all FEM bodies of a world, in the stages in which Bullet calls its soft body solver: predict before
/// collision detection, solve after the rigid bodies have moved, publish at the end; with a btFemConstraintSolver also
/// beginGroup within the rigid solver. Scratch only; persistent state is in the records.
class btFemWorldStep
{
public:
    /// Registry and set-up must outlive it.
    btFemWorldStep(const btFemSolverInfo& info, btFemBodyRegistry& registry, btFemBodySetUp& setUp);

    /// Sets the interest that chooses the detail of bodies: see btFemDetailChooser.
    void setInterest(btFemInterest* interest, const btFemDetailPolicy& policy)
    {
        m_detailChooser.setInterest(interest, policy);
    }

    /// Call before collision detection. `step` of the world [s], as below.
    void predict(double step);

    /// Call in collision detection: stores the state of a rigid body before the rigid solver.
    void noteBeforeSolve(const btCollisionObject& object) { m_group.noteBeforeSolve(object); }

    /// Call during collision detection, with the world's soft bodies: notes its constraints. By any thread.
    void noteWorld(const btAlignedObjectArray<btSoftBody*>& softBodies) { m_rewindSolver.noteWorld(softBodies); }

    /// See ArticulatedBodies::assumeForcesGiven.
    void assumeForcesGiven(const bullet_fem::Vec3& gravity)
    {
        m_rewindSolver.disable();  // forces are in the velocities already
        m_group.assumeForcesGiven(gravity);
    }

    /// Call within the rigid solver, before it sets up a group of islands: solves the free motion of the FEM bodies
    /// in `island`, and collects their contacts. Returns null if the group cannot be solved together: there are no
    /// FEM bodies, none is in contact, or one is joined to a rigid body of another group or, unless `linksToo`, to a
    /// link of a multibody.
    btFemContactGroup* beginGroup(const btFemIsland& island, double step, bool linksToo);

    /// Call after the rigid bodies have moved: free motion, contact and correction of the bodies that were not in a
    /// group; new positions of all bodies.
    void solve(double step);

    /// Call at the end of the step: publishes the data that Bullet programs read of awake bodies (normals, embedded
    /// surfaces, contacts), and decides who sleeps.
    void publish();

    /// Call last: splits bodies with a tensile strength.
    void split();

    const bullet_fem::Threads& threads() const { return m_threads; }
    btFemContactGroup& group() { return m_group; }
    btFemSplitter& splitter() { return m_splitter; }

private:
    void listSweeps(double step);
    void selectMoving(double step);
    void selectUnsolved(double step);
    void finishMotions(double step);
    void readChanges(btFemBodyRecord& record);
    template <class Task>
    void runOn(const std::vector<btFemBodyRecord*>& records, const Task& task) const
    {
        m_threads.run(static_cast<int>(records.size()), [&](int k) { task(*records[k]); });
    }

    btFemBodyRegistry& m_registry;
    btFemBodySetUp& m_setUp;
    bullet_fem::Threads m_threads;
    std::unique_ptr<bullet_fem::BatchMemory> m_batchMemory;  // null: bodies are solved one by one
    bullet_fem::WorldObjects m_world;
    btFemKinematicSweeps m_kinematicSweeps;
    btFemDetailChooser m_detailChooser;
    btFemRefactorPolicy m_refactoring;
    btFemFreeMotion m_freeMotion;
    btFemContactGroup m_group;
    btFemSplitter m_splitter;
    btFemRewindSolver m_rewindSolver;
    std::vector<btFemBodyRecord*> m_due;     // bodies whose prediction or free motion is due
    std::vector<btFemBodyRecord*> m_active;  // bodies whose free motion is solved
    std::vector<bullet_fem::Vec3> m_change;  // scratch [m/s]
};
