// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/steady_bodies.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/batch_memory.h"
#include "bullet_fem/fem/step/body_batches.h"
#include "bullet_fem/fem/step/stepping.h"
#include "plugin/bodies/btFemBodyRegistry.h"
#include "plugin/contact/btFemContactGroup.h"
#include "plugin/policy/btFemDetailChooser.h"
#include "plugin/policy/btFemRefactorPolicy.h"

/// One step of all FEM bodies of a world, in the places where Bullet calls its soft body solver: before collision
/// detection and after the rigid bodies have moved; and, with a btFemConstraintSolver, where it solves the rigid
/// bodies. Scratch only; what lasts is in the registry.
class btFemWorldStep
{
public:
    explicit btFemWorldStep(const btFemSolverInfo& info)
        : m_info(info),
          m_threads(info.m_threads),
          m_batchMemory(info.m_batchBodies ? std::make_unique<bullet_fem::BatchMemory>() : nullptr),
          m_refactorPolicy(info),
          m_group(info, m_threads, m_batchMemory.get())
    {
    }

    /// Who chooses the detail of bodies from now on: see btFemDetailChooser.
    void setInterest(btFemInterest* interest, const btFemDetailPolicy& policy)
    {
        m_detailChooser.setInterest(interest, policy);
    }

    /// Before collision detection: sets new bodies up, takes over what the user wrote, lets Bullet add wind and
    /// pressure to m_f, and gives the broad phase the bounds of the motion to come.
    void predict(btFemBodyRegistry& registry, double step);

    /// In collision detection: remembers a rigid body as it is before the rigid solver.
    void noteBeforeSolve(const btCollisionObject& object) { m_group.noteBeforeSolve(object); }

    /// See ArticulatedBodies::assumeForcesGiven.
    void assumeForcesGiven(const bullet_fem::Vec3& gravity) { m_group.assumeForcesGiven(gravity); }

    /// Within the rigid solver, before it sets up a group of islands: free motion of the FEM bodies among `bodies` and
    /// their contacts. Null if the rigid solver has nothing to do with them: none, or none that touches anything, or
    /// one that holds on to a rigid body of another group. `step` [s].
    btFemContactGroup* beginGroup(btFemBodyRegistry& registry, btCollisionObject* const* bodies, int count,
                                  double step);
    /// After the rigid bodies have moved: free motion, contact and correction of the bodies that were not in a group;
    /// the new positions of all. `step` [s].
    void solve(btFemBodyRegistry& registry, double step);

    /// As the step ends, what Bullet programs read of the bodies that are awake: normals, embedded surfaces, contacts.
    void updateSurfaces(btFemBodyRegistry& registry);

    const bullet_fem::Threads& threads() const { return m_threads; }
    btFemContactGroup& group() { return m_group; }
    const btFemContactGroup& group() const { return m_group; }

private:
    static bool isToBePredicted(btFemBodyRegistry& registry, btFemEntry& entry, double step);
    bool isDue(btFemEntry& entry, double worldStep) const;
    static void readBody(btFemEntry& entry);
    static void predictBody(btFemEntry& entry, double step);
    void renewFactor(btFemBodyRegistry& registry, btFemEntry& entry, double step);
    void readChanges(btFemEntry& entry);
    void solveFree();
    void solveFree(const bullet_fem::Range& batch);
    btFemEntry& inBatches(int k) const { return *m_due[m_batches.order()[k]]; }
    void prepareFree(btFemEntry& entry) const;
    bullet_fem::FreeMotion freeMotionOf(btFemEntry& entry) const;
    void noteFree(btFemEntry& entry, const bullet_fem::FreeMotion& motion) const;
    void finish(btFemEntry& entry) const;
    bullet_fem::StepSettings settingsOf(const btFemEntry& entry) const;

    btFemSolverInfo m_info;
    bullet_fem::Threads m_threads;
    std::unique_ptr<bullet_fem::BatchMemory> m_batchMemory;  // null: bodies one after another
    std::vector<btFemEntry*> m_due;     // they are to be predicted, or their free motion is to be solved
    std::vector<btFemEntry*> m_active;  // it is solved
    std::vector<const bullet_fem::Body*> m_dueBodies;
    bullet_fem::BodyBatches m_batches;  // of these
    bullet_fem::SteadyBodies m_steady;
    std::vector<bullet_fem::FemSoftBody*> m_dueFems;
    std::vector<bullet_fem::FreeMotion> m_motions;  // in the order of the batches
    std::vector<bullet_fem::Vec3> m_change;         // scratch [m/s]
    btFemDetailChooser m_detailChooser;
    btFemRefactorPolicy m_refactorPolicy;
    btFemContactGroup m_group;
};

/// True if a step [s] is one that bodies can be stepped with.
bool isUsableStep(double step);
