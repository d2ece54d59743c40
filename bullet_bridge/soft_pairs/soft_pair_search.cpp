// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/soft_pairs/soft_pair_search.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/rigid_obstacles.h"
#include "bullet_fem/fem/threads.h"

namespace bullet_fem
{
namespace
{

bool touches(const FemSoftBody& fem, const FemSoftBody& other)
{
    const auto& list = fem.m_touchingSoft;
    return std::find(list.begin(), list.end(), other.m_softBody) != list.end();
}

}  // namespace

SoftPairSearch::SoftPairSearch(const Threads& threads) : m_threads(threads), m_parts(kParts, Part(m_memory)) {}

void SoftPairSearch::find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts)
{
    listPairs(bodies);
    m_steady.sumImpulses(bodies, m_memory);
    m_threads.run(static_cast<int>(m_paired.size()),
                  [&](int k)
                  {
                      const int b = m_paired[k];
                      FemSoftBody& fem = *bodies[b];
                      fem.updateSkin();
                      const bool steady = !fem.m_skin && m_steady.isSteady(fem, b, step);
                      const std::vector<Vec3>& velocity = steady ? fem.m_body.m_state.m_v : fem.surfaceVelocity();
                      fem.m_surface.update(fem.surfacePosition(), velocity, step);
                  });
    m_threads.run(kParts, [&](int part) { findPairs(bodies, maxContacts, part); });
    m_contacts.clear();
    m_origins.clear();
    for (const Part& part : m_parts)
    {
        m_contacts.insert(m_contacts.end(), part.m_contacts.begin(), part.m_contacts.end());
        m_origins.insert(m_origins.end(), part.m_origins.begin(), part.m_origins.end());
    }
    m_limited.assign(bodies.size(), 0);
    for (const Pair& pair : m_pairs)
        if (pair.m_limited) m_limited[pair.m_first] = 1;
}

// The first of a pair is the one that came into the world first.
void SoftPairSearch::listPairs(const std::vector<FemSoftBody*>& bodies)
{
    const int count = static_cast<int>(bodies.size());
    m_pairs.clear();
    m_paired.clear();
    m_isPaired.assign(bodies.size(), 0);
    for (int a = 0; a < count; ++a)
        for (int b = a; b < count; ++b)
        {
            if (!touches(*bodies[a], *bodies[b]) && !touches(*bodies[b], *bodies[a])) continue;
            m_isPaired[a] = m_isPaired[b] = 1;
            const bool inOrder = broadphaseId(*bodies[a]->m_softBody) <= broadphaseId(*bodies[b]->m_softBody);
            m_pairs.push_back({inOrder ? a : b, inOrder ? b : a, false});
        }
    for (int b = 0; b < count; ++b)
        if (m_isPaired[b]) m_paired.push_back(b);
}

void SoftPairSearch::findPairs(const std::vector<FemSoftBody*>& bodies, int maxContacts, int part)
{
    Part& p = m_parts[part];
    p.m_contacts.clear();
    p.m_origins.clear();
    const std::size_t begin = m_pairs.size() * part / kParts, end = m_pairs.size() * (part + 1) / kParts;
    for (std::size_t k = begin; k < end; ++k)
    {
        Pair& pair = m_pairs[k];
        const SoftPairReport found =
            p.m_finder.find({*bodies[pair.m_first], pair.m_first}, {*bodies[pair.m_second], pair.m_second}, maxContacts,
                            p.m_contacts, p.m_origins);
        pair.m_limited = found.m_limited;
    }
}

}  // namespace bullet_fem
