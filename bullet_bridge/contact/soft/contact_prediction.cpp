// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/contact_prediction.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{
namespace
{

constexpr double kSteady = 0.0125;  // largest velocity error of a steady body times the step, over the mean edge: a
                                    // quarter of the contact band

// Largest sum of contact impulses over that of the load impulses. The solver's tolerance is relative to the impulses,
// so its error must remain small against the loads. For jammed or deeply overlapping bodies, the last step's impulses
// predict little anyway.
constexpr double kMaxCarried = 30;

void spread(const SurfacePoint& point, const Vec3& impulse, std::vector<Vec3>& nodeImpulses)
{
    for (int a = 0; a < point.m_count; ++a) nodeImpulses[point.m_nodes[a]] += point.m_weights[a] * impulse;
}

bool isSteady(const FemSoftBody& fem, double step)
{
    const BodyState& state = fem.m_body.m_state;
    Vec3 pushed, loads, momentum;
    double mass = 0, allPushed = 0, allLoads = 0;
    for (std::size_t i = 0; i < state.m_v.size(); ++i)
    {
        const Vec3 load = step * fem.m_body.m_loads.m_force[i];
        pushed += fem.m_memory.m_predicted[i];
        loads += load;
        allPushed += norm(fem.m_memory.m_predicted[i]);
        allLoads += norm(load);
        momentum += state.m_mass[i] * state.m_v[i];
        mass += state.m_mass[i];
    }
    const double most = kSteady * fem.m_surface.meanEdge() / step;  // largest velocity error [m/s]
    if (!(allPushed > 0 && allPushed <= kMaxCarried * allLoads)) return false;
    if (!(norm(pushed + loads) <= most * mass)) return false;
    const Vec3 mean = (1 / mass) * momentum;
    return std::all_of(state.m_v.begin(), state.m_v.end(),
                       [&](const Vec3& v) { return dot(v - mean, v - mean) <= most * most; });
}

}  // namespace

// Bodies whose nodes or attachments have changed since have no noted positions, and get no impulses of soft pairs.
void ContactPrediction::sumImpulses(const std::vector<FemSoftBody*>& bodies, const SoftPairMemory& memory,
                                    const Threads& threads)
{
    threads.run(static_cast<int>(bodies.size()),
                [&](int b)
                {
                    FemSoftBody& fem = *bodies[b];
                    fem.m_memory.m_predicted.assign(fem.m_body.m_state.m_x.size(), Vec3());
                    for (const ContactPoint& contact : fem.m_memory.m_contacts)
                        spread(contact.m_soft, contact.m_impulse, fem.m_memory.m_predicted);
                });
    m_byId.clear();
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (bodies[b]->m_memory.m_place.isNoted()) m_byId.add(broadphaseId(*bodies[b]->m_softBody), b);
    const auto add = [&](int id, const SurfacePoint& point, const Vec3& impulse)
    {
        const int b = m_byId.find(id);
        if (b >= 0) spread(point, impulse, bodies[b]->m_memory.m_predicted);
    };
    const SoftPairMemory::Last last = memory.last();
    for (std::size_t k = 0; k < last.m_count; ++k)
    {
        const SoftPairOrigin& origin = last.m_origins[k];
        const ContactPoint& contact = last.m_contacts[k];
        const bool ofSecond = origin.m_kind == SoftPairKind::nodeOfSecond;
        add(ofSecond ? origin.m_secondId : origin.m_firstId, contact.m_soft, contact.m_impulse);
        add(ofSecond ? origin.m_firstId : origin.m_secondId, contact.m_other, -contact.m_impulse);
    }
}

void ContactPrediction::accept(FemSoftBody& fem, double step)
{
    if (fem.m_body.m_loads.m_frameDamping > 0 || !isSteady(fem, step)) fem.m_memory.m_predicted.clear();
}

}  // namespace bullet_fem
