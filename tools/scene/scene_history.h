// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <deque>

#include "tools/scene/scene_state.h"

namespace bullet_fem
{

struct SceneHistorySettings
{
    int m_stepsBetween = 10;               ///< states, >= 1
    std::size_t m_maxBytes = 256u << 20u;  ///< for all states together [B]: the oldest go first
};

/// States of a scene that it can be put back to. It begins with the present one; memory grows up to the bound.
class SceneHistory
{
public:
    /// The world must live longer.
    explicit SceneHistory(SceneWorld& world, const SceneHistorySettings& settings = {});

    /// Makes a step of the world. If it was put back, what came later is forgotten, and what came before if a body
    /// splits, which cannot be whole again.
    void step();
    /// Puts the world back to the state before, or to the next one. False, and nothing changes, if there is none.
    bool earlier();
    bool later();
    /// Begins anew with the present: bodies or materials are others now.
    void clear();

    /// Of states.
    int count() const { return static_cast<int>(m_states.size()); }
    std::size_t bytes() const { return m_bytes; }          ///< of all states [B]
    double since() const;                                  ///< when the oldest one was [s]
    double until() const;                                  ///< when the newest one was, or now if that is later [s]
    bool isPast() const { return m_shown + 1 < count(); }  ///< it was put back and not stepped since
    const SceneHistorySettings& settings() const { return m_settings; }

private:
    bool show(int index);
    void keep();

    SceneWorld& m_world;
    SceneHistorySettings m_settings;
    std::deque<SceneState> m_states;  // by time
    std::size_t m_bytes = 0;
    int m_shown = -1;  // the newest state that is not later than the world
};

}  // namespace bullet_fem
