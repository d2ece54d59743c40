// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/colour_map.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{

namespace
{

constexpr int kSamples = 52;
// Every fifth of the 256 published colours (github.com/BIDS/colormap, option D); linear interpolation between them is
// off by 1/255 at most. clang-format off
constexpr unsigned char kViridis[kSamples][3] = {
    {68, 1, 84},    {70, 8, 92},    {71, 16, 99},   {72, 23, 105},  {72, 29, 111},  {72, 36, 117},  {71, 42, 122},
    {70, 48, 126},  {69, 55, 129},  {67, 61, 132},  {65, 66, 135},  {63, 72, 137},  {61, 78, 138},  {58, 83, 139},
    {56, 89, 140},  {53, 94, 141},  {51, 99, 141},  {49, 104, 142}, {46, 109, 142}, {44, 113, 142}, {42, 118, 142},
    {41, 123, 142}, {39, 128, 142}, {37, 132, 142}, {35, 137, 142}, {33, 142, 141}, {32, 146, 140}, {31, 151, 139},
    {30, 156, 137}, {31, 161, 136}, {33, 165, 133}, {36, 170, 131}, {40, 174, 128}, {46, 179, 124}, {53, 183, 121},
    {61, 188, 116}, {70, 192, 111}, {80, 196, 106}, {90, 200, 100}, {101, 203, 94}, {112, 207, 87}, {124, 210, 80},
    {137, 213, 72}, {149, 216, 64}, {162, 218, 55}, {176, 221, 47}, {189, 223, 38}, {202, 225, 31}, {216, 226, 25},
    {229, 228, 25}, {241, 229, 29}, {253, 231, 37}};
// clang-format on

}  // namespace

Vec3 viridis(double share)
{
    const double place = share > 0 ? std::fmin(share, 1) * (kSamples - 1) : 0;
    const int k = std::min(static_cast<int>(place), kSamples - 2);
    Vec3 colour;
    for (int i = 0; i < 3; ++i)
        colour[i] = (kViridis[k][i] + (place - k) * (kViridis[k + 1][i] - kViridis[k][i])) / 255;
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
