// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "bullet_bridge/contact/soft/contact_prediction.h"
#include "bullet_bridge/contact/soft/soft_pair_memory.h"
#include "bullet_fem/btFemSolverInfo.h"
#include "bullet_fem/fem/batch/body_batches.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/stepping.h"
#include "plugin/record/btFemBodyRecord.h"

/// Clears the report of a body whose step is to be solved. True if its free motion is due. False if the body stands
/// still; then the report is final.
bool beginFreeMotion(btFemBodyRecord& record, double worldStep);

/// Free motion and the end of steps of independent bodies, in batches of equal meshes, on several threads. Keeps
/// scratch only.
class btFemFreeMotion
{
public:
    /// Called for each body whose free motion was solved, by any thread.
    using Note = std::function<void(btFemBodyRecord&, const bullet_fem::FreeMotion&)>;

    /// `threads` share the work. `memory` is for batches; null: bodies are solved one by one. Both must outlive this
    /// object.
    btFemFreeMotion(const btFemSolverInfo& info, const bullet_fem::Threads& threads, bullet_fem::BatchMemory* memory,
                    Note note)
        : m_info(info), m_threads(threads), m_batchMemory(memory), m_note(std::move(note))
    {
    }

    /// Solves the free motion of bodies for which beginFreeMotion() returned true; each once.
    void solve(const std::vector<btFemBodyRecord*>& due, const bullet_fem::SoftPairMemory& softPairs);

    /// Solves again, with the damping of contact, those of `touching` that were solved without it. `touching`: bodies
    /// of this step that have contacts.
    void dampTouching(const std::vector<btFemBodyRecord*>& touching);

    /// Ends the steps of bodies whose contact is solved, in batches: sets new positions and velocities, not yet written
    /// to the btSoftBody. A body whose new state is not finite stands still, with a flag.
    void finish(const std::vector<btFemBodyRecord*>& solved);

private:
    bullet_fem::StepSettings settingsOf(const btFemBodyRecord& record) const;
    void solveDue(bool isFirst);
    void solveBatch(const bullet_fem::Range& batch, bool isFirst);
    void prepare(btFemBodyRecord& record) const;
    bullet_fem::FreeMotion motionOf(btFemBodyRecord& record) const;
    void report(btFemBodyRecord& record, const bullet_fem::FreeMotion& motion) const;
    btFemBodyRecord& inBatches(int k) const { return *m_due[m_batches.order()[k]]; }

    const btFemSolverInfo m_info;
    const bullet_fem::Threads& m_threads;
    bullet_fem::BatchMemory* m_batchMemory;
    Note m_note;
    std::vector<btFemBodyRecord*> m_due;
    std::vector<const bullet_fem::Body*> m_bodies;  // bodies of m_due
    std::vector<bullet_fem::FemSoftBody*> m_fems;
    bullet_fem::BodyBatches m_batches;
    bullet_fem::ContactPrediction m_steady;
    std::vector<bullet_fem::FreeMotion> m_motions;  // in the order of the batches
    std::vector<bullet_fem::StepEnd> m_ends;        // in the order of the batches
    std::vector<unsigned char> m_isUsable;          // per body of finish()
};
