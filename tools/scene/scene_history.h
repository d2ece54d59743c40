// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <deque>

#include "tools/scene/scene_state.h"

namespace bullet_fem
{

struct SceneHistorySettings
{
    int m_stepsBetween = 10;               ///< steps between stored states, >= 1
    std::size_t m_maxBytes = 256u << 20u;  ///< limit of all states together [B]; the oldest are dropped
};

/// Stored states of a scene for going back in time. It begins with the present state; memory grows up to the limit.
class SceneHistory
{
public:
    /// The world must outlive this object.
    explicit SceneHistory(SceneWorld& world, const SceneHistorySettings& settings = {});

    /// Makes a step of the world. After going back, later states are dropped; if a body splits, which cannot be undone,
    /// earlier states are dropped.
    void step();
    /// Restores the previous or the next state. Returns false without any change if there is none.
    bool earlier();
    bool later();
    /// Restarts from the present state, after changes of bodies or materials.
    void clear();

    /// Number of states.
    int count() const { return static_cast<int>(m_states.size()); }
    std::size_t bytes() const { return m_bytes; }  ///< of all states [B]
    double since() const;                          ///< time of the oldest state [s]
    double until() const;                          ///< time of the newest state or present time, whichever is later [s]
    bool isPast() const { return m_shown + 1 < count(); }  ///< an earlier state was restored and not stepped since
    const SceneHistorySettings& settings() const { return m_settings; }

private:
    bool show(int index);
    void keep();

    SceneWorld& m_world;
    SceneHistorySettings m_settings;
    std::deque<SceneState> m_states;  // by ascending time
    std::size_t m_bytes = 0;
    int m_shown = -1;  // newest state that is not later than the world
};

}  // namespace bullet_fem
