// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/noted_place.h"

namespace bullet_fem
{

void NotedPlace::note(const std::vector<Vec3>& x)
{
    for (std::size_t k = 0; k < m_vertices.size(); ++k) m_positions[k] = x[m_vertices[k]];
    m_isNoted = true;
}

bool NotedPlace::isStill(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h, double reach) const
{
    if (!m_isNoted) return false;
    for (std::size_t k = 0; k < m_vertices.size(); ++k)
    {
        const int i = m_vertices[k];
        if (!(norm(x[i] - m_positions[k]) + h * norm(v[i]) <= reach)) return false;
    }
    return true;
}

void NotedPlace::restore(const std::vector<Vec3>& positions)
{
    m_isNoted = positions.size() == m_positions.size();
    if (m_isNoted) m_positions.assign(positions.begin(), positions.end());
}

}  // namespace bullet_fem
