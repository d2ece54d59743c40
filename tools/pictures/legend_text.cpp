// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/legend_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bullet_fem
{
namespace
{

struct Prefix
{
    const char* m_name;
    double m_factor;
};
constexpr Prefix kPrefixes[] = {{"n", 1e-9}, {"µ", 1e-6}, {"m", 1e-3}, {"", 1},
                                {"k", 1e3},  {"M", 1e6},  {"G", 1e9},  {"T", 1e12}};

/// The largest prefix in which the larger absolute limit of the scale is at least 1.
Prefix prefix(const PictureColourScale& scale)
{
    const auto units = {"Pa", "N", "J", "W", "m", "s"};
    if (std::find(units.begin(), units.end(), scale.m_unit) == units.end()) return {"", 1};
    const double largest = std::max(std::abs(scale.m_low), std::abs(scale.m_high));
    Prefix chosen = kPrefixes[0];
    for (const Prefix& p : kPrefixes)
        if (largest >= p.m_factor * (1 - 1e-9)) chosen = p;
    return chosen;
}

std::string shortNumber(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    std::string number = text;
    std::replace(number.begin(), number.end(), ',', '.');  // independent of the locale
    return number;
}

PictureColourScale scaleOf(const PictureArrows& arrows)
{
    return {0, arrows.m_longest > 0 ? arrows.m_longest : 1, arrows.m_title, arrows.m_unit, true};
}

}  // namespace

std::vector<LegendLabel> legendLabels(const PictureColourScale& scale)
{
    std::vector<LegendLabel> labels;
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
    {
        const double value = scale.m_low * (1 - share) + scale.m_high * share;
        labels.push_back({share, shortNumber(value / prefix(scale).m_factor)});
    }
    return labels;
}

std::string legendTitle(const PictureColourScale& scale)
{
    if (scale.m_unit.empty()) return scale.m_title;
    return scale.m_title + (scale.m_title.empty() ? "[" : " [") + prefix(scale).m_name + scale.m_unit + "]";
}

std::string legendTitle(const PictureArrows& arrows)
{
    return legendTitle(scaleOf(arrows));
}

std::string legendRange(const PictureArrows& arrows)
{
    if (!(arrows.m_longest > 0)) return "none yet";
    return "0 to " + shortNumber(arrows.m_longest / prefix(scaleOf(arrows)).m_factor);
}

}  // namespace bullet_fem
