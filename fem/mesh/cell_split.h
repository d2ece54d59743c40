// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

namespace bullet_fem
{

/// A tetrahedron by corners of a cube: corner c lies at (c & 1, c >> 1 & 1, c >> 2 & 1). Positively oriented.
using CornerTet = std::array<int, 4>;

/// Five tets of a cube: four at corners, then the middle one. [0] for cells with even i + j + k, [1], its mirror image,
/// for odd ones, so that the diagonals of shared faces match.
inline constexpr std::array<std::array<CornerTet, 5>, 2> kFiveTets = {
    {{{{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 5, 0, 6}, {7, 3, 5, 6}, {0, 3, 6, 5}}},
     {{{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}}}}};

/// Six tets of a cube around the diagonal from corner 0 to corner 7 [Kuhn 1960]: one for each order of the axes.
inline constexpr std::array<CornerTet, 6> kKuhnTets = {
    {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};

}  // namespace bullet_fem
