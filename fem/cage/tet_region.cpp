// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/tet_region.h"

#include <algorithm>

namespace bullet_fem
{

TetRegion::TetRegion(const std::array<Vec3, 4>& tet, double slack) : m_low(tet[0]), m_high(tet[0])
{
    for (int i = 0; i < 4; ++i)
    {
        const Vec3 &a = tet[(i + 1) % 4], &b = tet[(i + 2) % 4], &c = tet[(i + 3) % 4];
        m_normals[i] = cross(b - a, c - a);
        const double inner = dot(m_normals[i], tet[i] - a);
        if (inner > 0) m_normals[i] = -m_normals[i];
        m_offsets[i] = dot(m_normals[i], a);
        if (slack > 0) m_offsets[i] += slack * norm(m_normals[i]);
        for (int axis = 0; axis < 3; ++axis)
        {
            m_low[axis] = std::min(m_low[axis], tet[i][axis]);
            m_high[axis] = std::max(m_high[axis], tet[i][axis]);
        }
    }
    m_low -= {slack, slack, slack};
    m_high += {slack, slack, slack};
}

bool TetRegion::mayMeet(const Vec3& low, const Vec3& high) const
{
    for (int a = 0; a < 3; ++a)
        if (low[a] > m_high[a] || high[a] < m_low[a]) return false;
    for (int i = 0; i < 4; ++i)
    {
        const Vec3& n = m_normals[i];
        const Vec3 deepest = {n.x > 0 ? low.x : high.x, n.y > 0 ? low.y : high.y, n.z > 0 ? low.z : high.z};
        if (dot(n, deepest) > m_offsets[i]) return false;
    }
    return true;
}

}  // namespace bullet_fem
