// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/half_space_cull.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr double kProofFacingCosine = 0.01;  // largest cosine between a triangle's normal and the direction at which it
                                             // faces away
constexpr double kRoundingShare = 1e-9;      // relative rounding error of lengths

}  // namespace

HalfSpaceCull::HalfSpaceCull(const SoftSurface& surface, const Vec3& direction) : m_direction(direction)
{
    if (!surface.topology().isClosed()) return;
    const std::vector<Vec3>& x = surface.position();
    m_front = -VectorBounds::kInfinity;
    for (int i : surface.topology().vertices())
    {
        const double front = dot(direction, x[i]);
        if (!(front > m_front)) continue;
        m_front = front;
        m_foremost = x[i];
    }
    for (std::size_t t = 0; t < surface.topology().triangles().size(); ++t)
    {
        if (dot(direction, surface.faceNormal(static_cast<int>(t))) > kProofFacingCosine) continue;
        for (int i : surface.topology().triangles()[t]) m_back = std::max(m_back, dot(direction, x[i]));
    }
}

bool HalfSpaceCull::isFarOutside(const Vec3& x, double distance) const
{
    const double at = dot(m_direction, x), size = std::fabs(at) + std::fabs(m_front);
    if (!(at - m_front > distance + kRoundingShare * (distance + 1e-3 * size))) return false;
    const double farthest = norm(x - m_foremost);
    return at - farthest > m_back + kRoundingShare * (farthest + size);
}

}  // namespace bullet_fem
