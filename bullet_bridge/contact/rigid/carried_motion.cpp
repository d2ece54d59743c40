// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/carried_motion.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr int kRounds = 3;  // sweeps over a vertex's carriers: enforcing one may violate another

}  // namespace

void CarriedMotion::begin(int vertexCount, double lift)
{
    m_lift = lift;
    m_first.assign(vertexCount, -1);
    m_carriers.clear();
}

void CarriedMotion::add(int vertex, const Carrier& carrier)
{
    m_carriers.push_back(carrier);
    m_carriers.back().m_next = m_first[vertex];
    m_first[vertex] = static_cast<int>(m_carriers.size()) - 1;
}

Vec3 CarriedMotion::allowed(int vertex, const Vec3& way, int exceptSurface) const
{
    Vec3 result = way;
    for (int round = 0; round < kRounds; ++round)
        forEach(vertex,
                [&](const Carrier& c)
                {
                    const double into = dot(c.m_normal, c.m_way - result) - std::max(c.m_gap, 0.0);
                    if (into > 0 && c.m_surface != exceptSurface) result += into * c.m_normal;
                });
    return result;
}

Vec3 CarriedMotion::liftOf(int vertex) const
{
    Vec3 lift;
    forEach(vertex,
            [&](const Carrier& c)
            {
                const double missing = m_lift - std::max(c.m_gap, 0.0) - dot(c.m_normal, lift);
                if (missing > 0) lift += missing * c.m_normal;
            });
    return lift;
}

}  // namespace bullet_fem
