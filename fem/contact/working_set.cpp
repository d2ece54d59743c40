// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/working_set.h"

namespace bullet_fem
{

void WorkingSet::reset(int ends)
{
    m_ends.clear();
    m_packedEnds.clear();
    m_place.assign(ends, -1);
    for (std::vector<int>* indices : {&m_ends, &m_packedEnds}) indices->reserve(ends);
    for (std::vector<Vec3>* vectors : {&m_velocity, &m_probeImpulse, &m_probeVelocity}) vectors->reserve(ends);
    m_W.reserve(ends);
}

void WorkingSet::clear()
{
    for (int e : m_ends) m_place[e] = -1;
    m_ends.clear();
}

void WorkingSet::add(int e)
{
    if (has(e)) return;
    m_place[e] = static_cast<int>(m_ends.size());
    m_ends.push_back(e);
}

void WorkingSet::pack(const DenseCompliance& W, const std::vector<Vec3>& velocity)
{
    m_velocity.clear();
    for (int e : m_ends) m_velocity.push_back(velocity[e]);
    if (m_ends == m_packedEnds) return;
    m_packedEnds.assign(m_ends.begin(), m_ends.end());
    m_W.resize(static_cast<int>(m_ends.size()));
    for (std::size_t f = 0; f < m_ends.size(); ++f)
        for (std::size_t e = 0; e < m_ends.size(); ++e)
            m_W.setBlock(static_cast<int>(e), static_cast<int>(f), W.block(m_ends[e], m_ends[f]));
}

void WorkingSet::beginProbe()
{
    m_probeImpulse.assign(m_ends.size(), Vec3());
    m_probeVelocity.assign(m_ends.size(), Vec3());
}

void WorkingSet::respondToProbe()
{
    for (std::size_t k = 0; k < m_ends.size(); ++k)
        if (dot(m_probeImpulse[k], m_probeImpulse[k]) > 0)
            m_W.respond(static_cast<int>(k), m_probeImpulse[k], m_probeVelocity);
}

void WorkingSet::followProbe(double step)
{
    for (std::size_t k = 0; k < m_ends.size(); ++k) m_velocity[k] += step * m_probeVelocity[k];
}

}  // namespace bullet_fem
