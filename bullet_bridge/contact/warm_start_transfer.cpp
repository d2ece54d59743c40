// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/warm_start_transfer.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr double kAlikeNormals = 0.7;  // smallest cosine between the normals
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

void WarmStartTransfer::addHeir(ContactPoint& contact, double sign)
{
    m_transfer.push_back({&contact, sign, !isZero(contact.m_impulse)});
}

WarmStartTransfer::Heir* WarmStartTransfer::nearestHeir(const Lost& lost, double reach)
{
    Heir* nearest = nullptr;
    double best = 2 * reach;  // contacts that have an impulse count as farther than all that have none
    for (Heir& heir : m_transfer)
    {
        const double distance = norm(heir.m_contact->m_point - lost.m_point);
        const double cost =
            distance + kFarPerGap * std::max(heir.m_contact->m_gap, 0.0) + (heir.m_hasImpulse ? reach : 0);
        if (!(distance < reach) || !(cost < best)) continue;
        if (heir.m_sign * dot(heir.m_contact->m_normal, lost.m_normal) < kAlikeNormals) continue;
        best = cost;
        nearest = &heir;
    }
    return nearest;
}

void WarmStartTransfer::settle(double reach)
{
    for (const Lost& lost : m_lost)
        if (Heir* heir = nearestHeir(lost, reach))
        {
            heir->m_contact->m_impulse += heir->m_sign * lost.m_impulse;
            heir->m_hasImpulse = true;
        }
}

}  // namespace bullet_fem
