// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_flags.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bullet_fem/btFemReports.h"

namespace bullet_fem
{
namespace
{

constexpr int kFlagsWithMessage = BT_FEM_REJECTED | BT_FEM_BAD_SURFACE | BT_FEM_NOT_SPLIT;

}  // namespace

std::string SceneFlag::when() const
{
    char text[96];
    if (m_steps == 1)
        std::snprintf(text, sizeof text, "%.4g s", m_first);
    else
        std::snprintf(text, sizeof text, "%.4g s to %.4g s, in %ld steps", m_first, m_last, m_steps);
    return text;
}

std::string SceneFlag::explanation() const
{
    const std::string text = m_text->m_explanation;
    return m_message.empty() ? text : text + " The message: " + m_message;
}

void SceneFlags::look(const SceneWorld& world)
{
    const double step = world.description().m_step;
    if (world.time() < m_time + 0.5 * step) forgetAfter(world.time() - step, step);
    m_time = world.time();
    for (int i = 0; i < world.softCount(); ++i)
    {
        const int flags = world.fem().stepReport(&world.soft(i)).m_flags;
        for (int bit = 0; bit < std::numeric_limits<int>::digits; ++bit)
            if (flags & 1 << bit) note(world, i, 1 << bit);
    }
}

void SceneFlags::note(const SceneWorld& world, int body, int flag)
{
    const btFemFlagText* const text = btFemFlagText::find(flag);
    if (!text) return;
    const auto [place, isNew] = m_flags.try_emplace({body, flag});
    SceneFlag& noted = place->second;
    if (isNew)
    {
        noted.m_body = world.description().m_softBodies[body].m_name;
        noted.m_text = text;
        noted.m_first = m_time;
        if (flag & kFlagsWithMessage) noted.m_message = world.fem().stepReport(&world.soft(body)).m_message;
    }
    noted.m_last = m_time;
    ++noted.m_steps;
}

// The steps with a flag are not stored. After the cut their number is at most that of all steps since the first one.
void SceneFlags::forgetAfter(double time, double step)
{
    for (auto at = m_flags.begin(); at != m_flags.end();)
    {
        SceneFlag& flag = at->second;
        if (flag.m_first > time + 0.5 * step)
        {
            at = m_flags.erase(at);
            continue;
        }
        flag.m_last = std::min(flag.m_last, time);
        flag.m_steps = std::min(flag.m_steps, std::lround((flag.m_last - flag.m_first) / step) + 1);
        ++at;
    }
}

std::vector<SceneFlag> SceneFlags::all() const
{
    std::vector<SceneFlag> flags;
    for (const auto& [key, flag] : m_flags) flags.push_back(flag);
    std::stable_sort(flags.begin(), flags.end(),
                     [](const SceneFlag& a, const SceneFlag& b) { return a.m_first < b.m_first; });
    return flags;
}

}  // namespace bullet_fem
