// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

constexpr double kFarthest = 1e6;  ///< largest coordinate [m]; Bullet's broadphase fails beyond it
constexpr double kFastest = 1e6;   ///< largest velocity or change of it [m/s], [rad/s]; faster changes are ignored

/// True if all components are finite and their magnitudes are below the limit.
inline bool isBelow(double limit, const Vec3& x)
{
    return isFinite(x) && std::max({std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)}) < limit;
}

}  // namespace bullet_fem
