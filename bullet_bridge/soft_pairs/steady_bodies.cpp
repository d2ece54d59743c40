// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/soft_pairs/steady_bodies.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/rigid_obstacles.h"

namespace bullet_fem
{
namespace
{

constexpr double kSteady = 0.0125;  // of a mean edge, in a step: a quarter of the contact band

}  // namespace

void SteadyBodies::sumImpulses(const std::vector<FemSoftBody*>& bodies, const SoftPairMemory& memory)
{
    m_impulse.assign(bodies.size(), Vec3());
    m_byId.clear();
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        m_byId.push_back({broadphaseId(*bodies[b]->m_softBody), static_cast<int>(b)});
        for (const ContactPoint& contact : bodies[b]->m_contacts) m_impulse[b] += contact.m_impulse;
    }
    const auto before = [](const Numbered& a, const Numbered& b) { return a.m_id < b.m_id; };
    std::sort(m_byId.begin(), m_byId.end(), before);
    const auto add = [&](int id, const Vec3& impulse)
    {
        const auto at = std::lower_bound(m_byId.begin(), m_byId.end(), Numbered{id, 0}, before);
        if (at != m_byId.end() && at->m_id == id) m_impulse[at->m_body] += impulse;
    };
    const SoftPairMemory::Last last = memory.last();
    for (std::size_t k = 0; k < last.m_count; ++k)
    {
        const SoftPairOrigin& origin = last.m_origins[k];
        const Vec3 ofFirst = (origin.m_kind == SoftPairKind::nodeOfSecond ? -1.0 : 1.0) * last.m_contacts[k].m_impulse;
        add(origin.m_firstId, ofFirst);
        add(origin.m_secondId, -ofFirst);
    }
}

bool SteadyBodies::isSteady(const FemSoftBody& fem, int body, double step) const
{
    const BodyState& state = fem.m_body.m_state;
    Vec3 balance = m_impulse[body], momentum;
    if (dot(balance, balance) == 0) return false;
    double mass = 0;
    for (std::size_t i = 0; i < state.m_v.size(); ++i)
    {
        balance += step * fem.m_body.m_loads.m_force[i];
        momentum += state.m_mass[i] * state.m_v[i];
        mass += state.m_mass[i];
    }
    const double most = kSteady * fem.m_surface.meanEdge() / step;  // [m/s]
    if (!(mass > 0) || !(norm(balance) <= most * mass)) return false;
    const Vec3 mean = (1 / mass) * momentum;
    return std::all_of(state.m_v.begin(), state.m_v.end(), [&](const Vec3& v) { return norm(v - mean) <= most; });
}

}  // namespace bullet_fem
