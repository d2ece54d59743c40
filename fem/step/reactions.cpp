// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/reactions.h"

#include "fem/body/step_scratch.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{

const std::vector<NodeReaction>* reactions(const Body& body)
{
    const StepScratch& scratch = body.m_workspace.scratch();
    SupportReactions& found = scratch.m_reactions;
    if (!found.isKnown(*body.m_model)) return nullptr;
    if (!found.isFound())
    {
        found.product().resize(found.change().size());
        WarpedSystem(body).applyUnconstrained(found.change(), found.product());
        found.find(scratch.m_elements.m_scaledMass, body.m_loads);
    }
    return &found.reactions();
}

}  // namespace bullet_fem
