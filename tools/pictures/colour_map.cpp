// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/colour_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bullet_fem
{
namespace
{

constexpr int kSamples = 52;
// Every fifth of the 256 published colours (github.com/BIDS/colormap, option D); lines between them are off by 1/255 at
// most.
// clang-format off
constexpr unsigned char kViridis[kSamples][3] = {
    {68, 1, 84}, {70, 8, 92}, {71, 16, 99}, {72, 23, 105}, {72, 29, 111}, {72, 36, 117},
    {71, 42, 122}, {70, 48, 126}, {69, 55, 129}, {67, 61, 132}, {65, 66, 135}, {63, 72, 137},
    {61, 78, 138}, {58, 83, 139}, {56, 89, 140}, {53, 94, 141}, {51, 99, 141}, {49, 104, 142},
    {46, 109, 142}, {44, 113, 142}, {42, 118, 142}, {41, 123, 142}, {39, 128, 142}, {37, 132, 142},
    {35, 137, 142}, {33, 142, 141}, {32, 146, 140}, {31, 151, 139}, {30, 156, 137}, {31, 161, 136},
    {33, 165, 133}, {36, 170, 131}, {40, 174, 128}, {46, 179, 124}, {53, 183, 121}, {61, 188, 116},
    {70, 192, 111}, {80, 196, 106}, {90, 200, 100}, {101, 203, 94}, {112, 207, 87}, {124, 210, 80},
    {137, 213, 72}, {149, 216, 64}, {162, 218, 55}, {176, 221, 47}, {189, 223, 38}, {202, 225, 31},
    {216, 226, 25}, {229, 228, 25}, {241, 229, 29}, {253, 231, 37}};
// clang-format on

struct Prefix
{
    const char* m_name;
    double m_factor;
};
constexpr Prefix kPrefixes[] = {{"n", 1e-9}, {"µ", 1e-6}, {"m", 1e-3}, {"", 1},
                                {"k", 1e3},  {"M", 1e6},  {"G", 1e9},  {"T", 1e12}};

/// The largest prefix that leaves at least 1 before the unit at the larger end of the scale.
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
    std::replace(number.begin(), number.end(), ',', '.');  // whatever the locale
    return number;
}

}  // namespace

Colour viridis(double s)
{
    const double place = std::clamp(s, 0.0, 1.0) * (kSamples - 1);
    const int i = std::min(static_cast<int>(place), kSamples - 2);
    const auto part = [&](int c)
    { return (kViridis[i][c] + (place - i) * (kViridis[i + 1][c] - kViridis[i][c])) / 255; };
    return {part(0), part(1), part(2)};
}

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

}  // namespace bullet_fem
