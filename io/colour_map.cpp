// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/colour_map.h"

#include <cmath>

namespace bullet_fem
{

Vec3 heatColour(double share)
{
    constexpr int kLast = 4;
    constexpr double colours[kLast + 1][3] = {
        {0.16, 0.27, 0.75}, {0.10, 0.66, 0.85}, {0.25, 0.75, 0.35}, {0.97, 0.85, 0.20}, {0.82, 0.12, 0.10}};
    const double place = share > 0 ? std::fmin(share, 1) * kLast : 0;
    const int k = place < kLast ? static_cast<int>(place) : kLast - 1;
    Vec3 colour;
    for (int i = 0; i < 3; ++i) colour[i] = colours[k][i] + (place - k) * (colours[k + 1][i] - colours[k][i]);
    return colour;
}

// The transfer function of IEC 61966-2-1.
Vec3 linearColour(const Vec3& screenColour)
{
    Vec3 light;
    for (int i = 0; i < 3; ++i)
    {
        const double c = screenColour[i];
        light[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    return light;
}

}  // namespace bullet_fem
