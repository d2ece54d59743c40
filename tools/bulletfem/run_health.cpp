// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/run_health.h"

#include <algorithm>
#include <cstddef>
#include <map>

namespace bullet_fem
{
namespace
{

constexpr std::size_t kShownBodies = 10;  // listed per flag in the table

/// Lines of text: for each flag its explanation, then its bodies.
std::vector<std::string> linesOf(const std::vector<SceneFlag>& flags)
{
    std::map<int, std::vector<std::string>> bodies;  // lines of the bodies by flag
    for (const SceneFlag& flag : flags)
        bodies[flag.m_text->m_flag].push_back("  " + flag.m_body + ": " + flag.when() +
                                              (flag.m_message.empty() ? "" : "; " + flag.m_message));
    std::vector<std::string> lines;
    for (const auto& [flag, all] : bodies)
    {
        const btFemFlagText& text = *btFemFlagText::find(flag);
        lines.push_back(std::string(text.m_title) + " (" + text.m_name + "): " + text.m_explanation);
        const std::size_t shown = std::min(all.size(), kShownBodies);
        lines.insert(lines.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(shown));
        if (shown < all.size()) lines.push_back("  and " + std::to_string(all.size() - shown) + " more: see --json");
    }
    return lines;
}

}  // namespace

void tellFlags(Figures& figures, const std::vector<SceneFlag>& flags)
{
    nlohmann::json list = nlohmann::json::array();
    for (const SceneFlag& flag : flags)
        list.push_back({{"body", flag.m_body},
                        {"flag", flag.m_text->m_name},
                        {"title", flag.m_text->m_title},
                        {"first", flag.m_first},
                        {"last", flag.m_last},
                        {"steps", flag.m_steps},
                        {"explanation", flag.explanation()}});
    figures.addList("flags", list, linesOf(flags));
}

void tellFaults(Figures& figures, const std::vector<SceneFault>& faults)
{
    nlohmann::json list = nlohmann::json::array();
    std::vector<std::string> lines;
    for (const SceneFault& fault : faults)
    {
        nlohmann::json entry = {{"body", fault.m_body}, {"sentence", fault.sentence()}};
        if (fault.m_other.empty())
            entry.update({{"what", "insideOut"}, {"elements", fault.m_elements}});
        else
            entry.update(
                {{"what", "inside"}, {"other", fault.m_other}, {"depth", fault.m_depth}, {"share", fault.m_share}});
        list.push_back(entry);
        lines.push_back(fault.sentence());
    }
    figures.addList("faults", list, lines);
}

}  // namespace bullet_fem
