// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// State of a scene's world, on which its next steps depend.
struct SceneState
{
    long m_steps = 0;                    ///< steps made before this state
    std::vector<unsigned char> m_world;  ///< as btFemWorldState saves it

    /// Memory used [B].
    std::size_t bytes() const { return sizeof *this + m_world.capacity(); }
};

SceneState stateOf(SceneWorld& world);

/// Restores the state; the scene continues with equal bits. The world must have the bodies and materials of that state.
/// Throws std::invalid_argument, without any change, if it has not.
void restore(const SceneState& state, SceneWorld& world);

}  // namespace bullet_fem
