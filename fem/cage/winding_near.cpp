// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/winding_near.h"

#include <cmath>

namespace bullet_fem
{

SurfaceWinding::SurfaceWinding(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, bool closed)
    : m_number(vertices, triangles)
{
    if (closed && !triangles.empty()) m_closed.emplace(vertices, triangles);
}

double WindingNear::at(const Vec3& p)
{
    constexpr double kSure = 0.25;  // maximum distance of a computed winding number from its integer
    if (m_knows && norm(p - m_point) <= m_reach) return m_atPoint - m_winding.m_closed->crossings(m_point, p);
    const double winding = m_winding.m_number.at(p);
    if (m_winding.m_closed && std::abs(winding - std::round(winding)) < kSure)
    {
        m_knows = true;
        m_point = p;
        m_atPoint = std::round(winding);
    }
    return winding;
}

}  // namespace bullet_fem
