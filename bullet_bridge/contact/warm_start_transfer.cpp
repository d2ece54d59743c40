// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/warm_start_transfer.h"

#include <algorithm>

#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{
namespace
{

constexpr double kFarPerGap = 30;  // distance that counts for a gap, over the gap: an open contact carries no load yet

bool isZero(const Vec3& v)
{
    return dot(v, v) == 0;
}

}  // namespace

void WarmStartTransfer::clear(std::size_t lost)
{
    m_lost.clear();
    m_lost.reserve(lost);
    m_transfer.clear();
}

void WarmStartTransfer::addLost(const Vec3& point, const Vec3& normal, const Vec3& impulse)
{
    if (!isZero(impulse)) m_lost.push_back({point, normal, impulse});
}

void WarmStartTransfer::addCandidate(ContactPoint& contact, double sign)
{
    m_transfer.push_back({&contact, sign, !isZero(contact.m_impulse)});
}

WarmStartTransfer::Candidate* WarmStartTransfer::nearestCandidate(const Lost& lost, double reach)
{
    Candidate* nearest = nullptr;
    double best = 2 * reach;  // contacts that have an impulse count as farther than all that have none
    for (Candidate& candidate : m_transfer)
    {
        const double distance = norm(candidate.m_contact->m_point - lost.m_point);
        const double cost =
            distance + kFarPerGap * std::max(candidate.m_contact->m_gap, 0.0) + (candidate.m_hasImpulse ? reach : 0);
        if (!(distance < reach) || !(cost < best)) continue;
        if (candidate.m_sign * dot(candidate.m_contact->m_normal, lost.m_normal) < kCarrierCosine) continue;
        best = cost;
        nearest = &candidate;
    }
    return nearest;
}

void WarmStartTransfer::assign(double reach)
{
    for (const Lost& lost : m_lost)
        if (Candidate* candidate = nearestCandidate(lost, reach))
        {
            candidate->m_contact->m_impulse += candidate->m_sign * lost.m_impulse;
            candidate->m_hasImpulse = true;
        }
}

}  // namespace bullet_fem
