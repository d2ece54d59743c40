// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_history.h"

#include <algorithm>
#include <utility>

namespace bullet_fem
{

SceneHistory::SceneHistory(SceneWorld& world, const SceneHistorySettings& settings)
    : m_world(world), m_settings(settings)
{
    clear();
}

void SceneHistory::clear()
{
    m_states.clear();
    m_bytes = 0;
    m_shown = -1;
    keep();
}

void SceneHistory::step()
{
    for (; isPast(); m_states.pop_back()) m_bytes -= m_states.back().bytes();
    const int splits = m_world.fractures().count();
    m_world.step();
    if (m_world.fractures().count() > splits) return clear();
    if (m_world.steps() % m_settings.m_stepsBetween == 0) keep();
}

bool SceneHistory::earlier()
{
    // Keeps the present state as well, so that later() can return to it.
    if (!isPast() && (m_states.empty() || m_states.back().m_steps != m_world.steps())) keep();
    return show(m_shown - 1);
}

bool SceneHistory::later()
{
    return show(m_shown + 1);
}

bool SceneHistory::show(int index)
{
    if (index < 0 || index >= count()) return false;
    restore(m_states[static_cast<std::size_t>(index)], m_world);
    m_shown = index;
    return true;
}

void SceneHistory::keep()
{
    SceneState state = stateOf(m_world);
    m_bytes += state.bytes();
    m_states.push_back(std::move(state));
    for (; m_bytes > m_settings.m_maxBytes; m_states.pop_front()) m_bytes -= m_states.front().bytes();
    m_shown = count() - 1;
}

double SceneHistory::since() const
{
    return m_states.empty() ? m_world.time() : double(m_states.front().m_steps) * m_world.description().m_step;
}

double SceneHistory::until() const
{
    const double newest = m_states.empty() ? 0 : double(m_states.back().m_steps) * m_world.description().m_step;
    return std::max(newest, m_world.time());
}

}  // namespace bullet_fem
