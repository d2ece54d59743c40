// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "LinearMath/btTransform.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// Where a scene's bodies are and how they move.
struct SceneState
{
    /// Of a rigid body.
    struct Rigid
    {
        btTransform m_pose;
        btVector3 m_velocity, m_spin;
        int m_activation = 0;
        btScalar m_stillFor = 0;  ///< [s]
    };
    long m_steps = 0;  ///< made until then
    std::vector<unsigned char> m_soft;
    std::vector<Rigid> m_rigid;

    /// Memory that it takes [B].
    std::size_t bytes() const { return sizeof *this + m_soft.capacity() + m_rigid.capacity() * sizeof(Rigid); }
};

SceneState stateOf(const SceneWorld& world);

/// Puts the bodies back: soft ones to the bit; contacts between rigid ones begin anew. The world must have the bodies
/// and materials of then. Throws std::invalid_argument if it has not, and changes nothing then.
void restore(const SceneState& state, SceneWorld& world);

}  // namespace bullet_fem
