// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_state.h"

#include "bullet_fem/btFemWorldState.h"

namespace bullet_fem
{

SceneState stateOf(SceneWorld& world)
{
    SceneState state;
    state.m_steps = world.steps();
    btFemWorldState::save(world.world(), world.fem(), state.m_world);
    return state;
}

void restore(const SceneState& state, SceneWorld& world)
{
    btFemWorldState::restore(world.world(), world.fem(), state.m_world.data(), state.m_world.size());
    world.setSteps(state.m_steps);
}

}  // namespace bullet_fem
