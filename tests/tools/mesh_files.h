// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>
#include <fstream>
#include <string>

namespace bullet_fem
{

/// Writes an OFF file of a closed, outward ball around the origin, of `bands` bands from pole to pole and twice as many
/// around.
inline void writeBall(const std::string& path, double radius, int bands)
{
    const double pi = 3.14159265358979323846;
    const int around = 2 * bands;
    std::ofstream file(path);
    file << "OFF\n" << (bands - 1) * around + 2 << " " << 2 * around * (bands - 1) << " 0\n";
    file << "0 " << radius << " 0\n";
    for (int i = 1; i < bands; ++i)
        for (int j = 0; j < around; ++j)
        {
            const double down = pi * i / bands, turn = 2 * pi * j / around;
            file << radius * std::sin(down) * std::cos(turn) << " " << radius * std::cos(down) << " "
                 << -radius * std::sin(down) * std::sin(turn) << "\n";
        }
    file << "0 " << -radius << " 0\n";
    const auto at = [&](int i, int j) {
        return i == 0 ? 0 : i == bands ? (bands - 1) * around + 1 : 1 + (i - 1) * around + j % around;
    };
    for (int i = 0; i < bands; ++i)
        for (int j = 0; j < around; ++j)
        {
            if (i < bands - 1) file << "3 " << at(i, j) << " " << at(i + 1, j) << " " << at(i + 1, j + 1) << "\n";
            if (i > 0) file << "3 " << at(i, j) << " " << at(i + 1, j + 1) << " " << at(i, j + 1) << "\n";
        }
}

}  // namespace bullet_fem
