// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/contact/soft/soft_pair_memory.h"
#include "bullet_bridge/rigid/sorted_index.h"

namespace bullet_fem
{

class Threads;

/// Predicts which bodies keep their motion: their nodes move at one velocity, and the contact impulses of the last step
/// balance their loads. These impulses become part of the free motion. Without them the predicted free motion of a
/// pressed stack springs apart by up to half an edge a step, which does not happen. Grows, never shrinks.
class ContactPrediction
{
public:
    /// Call before solveFreeMotion: sums up in m_predicted, per node [N s], the contact impulses of the last step on
    /// each body. `memory` has the contacts between soft bodies. `bodies` has each body once.
    void sumImpulses(const std::vector<FemSoftBody*>& bodies, const SoftPairMemory& memory, const Threads& threads);

    /// Empties m_predicted unless contact pushed the body and, pushing as before, keeps it within a quarter of the
    /// contact band of where its velocities take it within `step` [s]. Loads must be up to date. May be called by
    /// several threads at once for different bodies.
    static void accept(FemSoftBody& fem, double step);

private:
    SortedIndex<int> m_byId;  // bodies with noted places
};

}  // namespace bullet_fem
