// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/contact/soft/soft_pair_memory.h"

namespace bullet_fem
{

class Threads;

/// Which bodies will go on as they move, rather than as they would freely: their nodes move as one, and what contact
/// pushed in the last step balances their loads. The impulses of that are expected again, and are part of their free
/// motion: without them, what is pressed together springs apart by up to half an edge a step, and nothing of it comes
/// true. Grows, never shrinks.
class SteadyBodies
{
public:
    /// Before solveFreeMotion: sums up in m_predicted what contact pushed every body with in the last step. `memory`
    /// has the contacts between soft bodies of that. Each body once.
    void sumImpulses(const std::vector<FemSoftBody*>& bodies, const SoftPairMemory& memory, const Threads& threads);

    /// Empties m_predicted unless contact pushed the body, and it will be within a quarter of the contact band of where
    /// its velocities take it in a step [s], if contact pushes as it did. Loads must have been read. May be called by
    /// several threads at once, for different bodies.
    static void judge(FemSoftBody& fem, double step);

private:
    struct Numbered
    {
        int m_id;
        FemSoftBody* m_fem;
    };
    std::vector<Numbered> m_byId;
};

}  // namespace bullet_fem
