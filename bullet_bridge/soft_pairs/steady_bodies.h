// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/fem_soft_body.h"
#include "bullet_bridge/soft_pairs/soft_pair_memory.h"

namespace bullet_fem
{

/// Which bodies will go on as they move, rather than as they would freely: their nodes move as one, and what contact
/// pushed in the last step balances their loads. Freely, what is pressed together springs apart by up to half an edge a
/// step; a search by that motion finds crowds of contacts that carry nothing, and nothing of it comes true. Grows,
/// never shrinks.
class SteadyBodies
{
public:
    /// Once a step, after the search for rigid contacts: whose impulses are those that were taken over. `memory` has
    /// the contacts between soft bodies of the last step.
    void sumImpulses(const std::vector<FemSoftBody*>& bodies, const SoftPairMemory& memory);

    /// True if contact pushed a body, by its index then, and it will be within a quarter of the contact band of where
    /// its velocities take it in a step [s], if contact pushes as it did. May be called by several threads at once.
    bool isSteady(const FemSoftBody& fem, int body, double step) const;

private:
    struct Numbered
    {
        int m_id, m_body;
    };
    std::vector<Numbered> m_byId;
    std::vector<Vec3> m_impulse;  // per body, of all contacts [N s]
};

}  // namespace bullet_fem
