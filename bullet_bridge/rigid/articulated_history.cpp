// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/articulated_history.h"

#include <algorithm>
#include <cmath>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "bullet_bridge/rigid/multibody_dynamics.h"

namespace bullet_fem
{
namespace
{

// A velocity change differs from that by forces by rounding, and because accelerations are known at the end of the
// step, when joints have turned: shares of the change by forces, and of the speeds before and after [-].
constexpr double kOfForces = 0.1, kOfSpeeds = 1e-3;

}  // namespace

void ArticulatedHistory::beginStep()
{
    m_before.clear();
    m_beforeVelocity.clear();
    for (Memory& memory : m_memories)
    {
        if (!memory.m_used) memory.m_body = nullptr;
        memory.m_used = false;
    }
}

void ArticulatedHistory::noteBeforeSolve(const btMultiBody& body)
{
    for (const Before& known : m_before)
        if (known.m_body == &body) return;
    m_before.push_back({&body, m_beforeVelocity.size()});
    const btScalar* velocity = body.getVelocityVector();
    m_beforeVelocity.insert(m_beforeVelocity.end(), velocity, velocity + kBaseCoordinates + body.getNumDofs());
}

void ArticulatedHistory::reserve(const btMultiBody& body, std::size_t bodies, std::size_t coordinates)
{
    m_before.reserve(bodies);
    m_beforeVelocity.reserve(coordinates);
    m_rounded.reserve(kBaseCoordinates + body.getNumDofs());
    memoryOf(body);
}

bool ArticulatedHistory::addSupport(const btMultiBody& body, double step, const std::vector<double>& acceleration,
                                    const double* velocity, double* freeVelocity)
{
    const auto before =
        std::find_if(m_before.begin(), m_before.end(), [&](const Before& b) { return b.m_body == &body; });
    if (before == m_before.end()) return false;
    const double* noted = &m_beforeVelocity[before->m_first];
    const Memory& memory = memoryOf(body);
    const auto needed = [&](int k) { return -(step * acceleration[k] + memory.m_given[k]); };
    bool isFree = true;
    const auto support = [&](int first, int count)
    {
        double done = 0, whole = 0;
        for (int k = first; k < first + count; ++k)
        {
            const double byForces = m_forcesGiven ? 0 : step * acceleration[k], byBullet = velocity[k] - noted[k];
            const double speeds = std::abs(velocity[k]) + std::abs(noted[k]);
            isFree = isFree && std::abs(byBullet - byForces) <= kOfForces * std::abs(byForces) + kOfSpeeds * speeds;
            done += (byBullet - byForces) * needed(k);
            whole += needed(k) * needed(k);
        }
        if (!(whole > 0)) return;
        const double share = std::clamp(done / whole, 0.0, 1.0);
        for (int k = first; k < first + count; ++k) freeVelocity[k] += share * needed(k);
    };
    support(0, 3);
    support(3, 3);
    for (int k = kBaseCoordinates; k < kBaseCoordinates + body.getNumDofs(); ++k) support(k, 1);
    return isFree;
}

void ArticulatedHistory::addVelocity(btMultiBody& body, const std::vector<btScalar>& change)
{
    Memory& memory = memoryOf(body);
    memory.m_used = true;
    const btScalar* now = body.getVelocityVector();
    const btScalar fastest = body.getMaxCoordinateVelocity();
    m_rounded.resize(change.size());
    for (std::size_t k = 0; k < change.size(); ++k)
    {
        const double exact = double(now[k]) + memory.m_remainder[k] + double(change[k]);
        m_rounded[k] = std::clamp(static_cast<btScalar>(exact), -fastest, fastest);
        memory.m_remainder[k] = std::abs(exact) < double(fastest) ? exact - double(m_rounded[k]) : 0;
    }
    setVelocity(body, m_rounded);
}

void ArticulatedHistory::noteGiven(const btMultiBody& body, const std::vector<btScalar>& change)
{
    memoryOf(body).m_given.assign(change.begin(), change.end());
}

ArticulatedHistory::Memory& ArticulatedHistory::memoryOf(const btMultiBody& body)
{
    const std::size_t coordinates = kBaseCoordinates + body.getNumDofs();
    const auto find = [this](const btMultiBody* wanted)
    {
        return std::find_if(m_memories.begin(), m_memories.end(),
                            [wanted](const Memory& m) { return m.m_body == wanted; });
    };
    auto memory = find(&body);
    if (memory != m_memories.end() && memory->m_given.size() == coordinates) return *memory;
    if (memory == m_memories.end()) memory = find(nullptr);
    if (memory == m_memories.end()) memory = m_memories.insert(m_memories.end(), Memory());
    memory->m_body = &body;
    memory->m_given.assign(coordinates, 0);
    memory->m_remainder.assign(coordinates, 0);
    return *memory;
}

}  // namespace bullet_fem
