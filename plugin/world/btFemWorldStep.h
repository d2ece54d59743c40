// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/rigid/world_objects.h"
#include "bullet_fem/fem/batch/batch_memory.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/setup/btFemBodySetUp.h"
#include "plugin/stages/btFemContactGroup.h"
#include "plugin/stages/btFemDetailChooser.h"
#include "plugin/stages/btFemFreeMotion.h"
#include "plugin/stages/btFemRefactoring.h"
#include "plugin/stages/btFemSplitter.h"

/// One step of all FEM bodies of a world, in the places where Bullet calls its soft body solver: predict before
/// collision detection, solve after the rigid bodies have moved, publish at the end; and, with a btFemConstraintSolver,
/// beginGroup where it solves the rigid bodies. Scratch only; what lasts is in the records.
class btFemWorldStep
{
public:
    /// Registry and set-up must live as long.
    btFemWorldStep(const btFemSolverInfo& info, btFemBodyRegistry& registry, btFemBodySetUp& setUp);

    /// Who chooses the detail of bodies from now on: see btFemDetailChooser.
    void setInterest(btFemInterest* interest, const btFemDetailPolicy& policy)
    {
        m_detailChooser.setInterest(interest, policy);
    }

    /// Before collision detection. `step` of the world [s], as below.
    void predict(double step);

    /// In collision detection: remembers a rigid body as it is before the rigid solver.
    void noteBeforeSolve(const btCollisionObject& object) { m_group.noteBeforeSolve(object); }

    /// See ArticulatedBodies::assumeForcesGiven.
    void assumeForcesGiven(const bullet_fem::Vec3& gravity) { m_group.assumeForcesGiven(gravity); }

    /// Within the rigid solver, before it sets up a group of islands: free motion of the FEM bodies among `bodies` and
    /// their contacts. Null if the rigid solver has nothing to do with them: none, or none that touches anything, or
    /// one that holds on to a rigid body of another group, or, unless `linksToo`, to a link of a multibody.
    btFemContactGroup* beginGroup(btCollisionObject* const* bodies, int count, double step, bool linksToo);

    /// After the rigid bodies have moved: free motion, contact and correction of the bodies that were not in a group;
    /// the new positions of all.
    void solve(double step);

    /// As the step ends, what Bullet programs read of the bodies that are awake: normals, embedded surfaces, contacts;
    /// and who sleeps.
    void publish();

    /// After all else: bodies split that have a strength.
    void split();

    const bullet_fem::Threads& threads() const { return m_threads; }
    btFemContactGroup& group() { return m_group; }
    btFemSplitter& splitter() { return m_splitter; }

private:
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
    std::unique_ptr<bullet_fem::BatchMemory> m_batchMemory;  // null: bodies one after another
    bullet_fem::WorldObjects m_world;
    btFemDetailChooser m_detailChooser;
    btFemRefactorPolicy m_refactoring;
    btFemFreeMotion m_freeMotion;
    btFemContactGroup m_group;
    btFemSplitter m_splitter;
    std::vector<btFemBodyRecord*> m_due;     // they are to be predicted, or their free motion is to be solved
    std::vector<btFemBodyRecord*> m_active;  // it is solved
    std::vector<bullet_fem::Vec3> m_change;  // scratch [m/s]
};
