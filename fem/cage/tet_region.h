// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Half spaces and box of a tet: what is certainly outside of either does not meet it.
class TetRegion
{
public:
    /// The tet of either orientation, grown by `slack` on every side.
    explicit TetRegion(const std::array<Vec3, 4>& tet, double slack = 0);

    /// False only for boxes that do not meet the tet.
    bool mayMeet(const Vec3& low, const Vec3& high) const;

private:
    Vec3 m_low, m_high;
    std::array<Vec3, 4> m_normals;
    std::array<double, 4> m_offsets = {};
};

}  // namespace bullet_fem
