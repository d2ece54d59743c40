// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "LinearMath/btTransform.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// Positions and velocities of a scene's bodies.
struct SceneState
{
    /// State of a rigid body.
    struct Rigid
    {
        btTransform m_pose;
        btVector3 m_velocity, m_spin;
        int m_activation = 0;
        btScalar m_stillFor = 0;  ///< deactivation time [s]
    };
    long m_steps = 0;  ///< steps made before this state
    std::vector<unsigned char> m_soft;
    std::vector<Rigid> m_rigid;

    /// Memory used [B].
    std::size_t bytes() const { return sizeof *this + m_soft.capacity() + m_rigid.capacity() * sizeof(Rigid); }
};

SceneState stateOf(const SceneWorld& world);

/// Restores the state: soft bodies bitwise; contacts between rigid bodies lose their warm start. The world must have
/// the bodies and materials of that state. Throws std::invalid_argument, without any change, if it has not.
void restore(const SceneState& state, SceneWorld& world);

}  // namespace bullet_fem
