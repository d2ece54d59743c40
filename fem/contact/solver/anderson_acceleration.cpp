// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/anderson_acceleration.h"

#include <algorithm>
#include <cmath>

#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

constexpr int kMixed = WorkingSet::kMixed;

// The first sweep drops all differences.
void noteDelta(const Vec3& value, int slot, bool first, Vec3& last, Vec3* deltas)
{
    if (first)
        std::fill_n(deltas, kMixed, Vec3());
    else
        deltas[slot] = value - last;
    last = value;
}

Vec3 mixed(const std::array<double, kMixed>& shares, const Vec3* deltas)
{
    Vec3 sum;
    for (int j = 0; j < kMixed; ++j) sum -= shares[j] * deltas[j];
    return sum;
}

}  // namespace

void AndersonAcceleration::begin()
{
    m_before.reserve(m_rows.rows().size());
    m_swept.reserve(m_rows.rows().size());
}

void AndersonAcceleration::start(const std::vector<int>& working)
{
    m_before.resize(working.size());
    m_swept.resize(working.size());
    m_square = 0;
    m_shares = {};
    m_slot = 0;
    m_trusted = true;
}

void AndersonAcceleration::mix(const std::vector<int>& working)
{
    addShares(working);
    for (std::size_t k = 0; k < working.size(); ++k) m_before[k] = m_rows.rows()[working[k]].m_impulse;
}

void AndersonAcceleration::addShares(const std::vector<int>& working)
{
    if (m_shares == std::array<double, kMixed>{}) return;
    for (std::size_t k = 0; k < working.size(); ++k)
        m_rows.pushAlong(m_rows.rows()[working[k]], mixed(m_shares, m_swept[k].m_afterDelta));
    m_rows.forEachContactBody(m_rows.threadsForCompliance(),
                              [this](int b) { m_rows.body(b).working().mixSweeps(m_shares); });
}

// Impulses of points with incompatible constraints grow by nearly equal amounts in every sweep: the weights of their
// small differences are large, and the mix is unreliable.
bool AndersonAcceleration::takeBack(const std::vector<int>& working)
{
    if (m_shares == std::array<double, kMixed>{}) return false;
    for (std::size_t k = 0; k < working.size(); ++k) m_rows.change(m_rows.rows()[working[k]], m_before[k]);
    for (double& share : m_shares) share = -share;
    addShares(working);
    m_shares = {};
    m_square = 0;
    m_trusted = false;
    return true;
}

// Restarts if a mix led to a larger change.
void AndersonAcceleration::note(const std::vector<int>& working)
{
    const double square = squareOfChanges(working);
    const bool first = !(m_square > 0 && square <= m_square);
    m_square = square;
    m_slot = (m_slot + 1) % kMixed;
    noteRows(working, first);
    m_rows.forEachContactBody(m_rows.threadsForCompliance(),
                              [&](int b) { m_rows.body(b).working().noteSweep(m_slot, first); });
    chooseShares(working);
}

double AndersonAcceleration::squareOfChanges(const std::vector<int>& working) const
{
    double sum = 0;
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        const ContactRow& row = m_rows.rows()[working[k]];
        const Vec3 change = row.m_impulse - m_before[k];
        sum += row.m_rowCompliance.x * dot(change, change);
    }
    return sum;
}

void AndersonAcceleration::noteRows(const std::vector<int>& working, bool first)
{
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        const Vec3 now = m_rows.rows()[working[k]].m_impulse;
        Swept& swept = m_swept[k];
        noteDelta(now, m_slot, first, swept.m_after, swept.m_afterDelta);
        noteDelta(now - m_before[k], m_slot, first, swept.m_change, swept.m_changeDelta);
    }
}

// Least squares: minimises the last change minus weighted differences from the changes before, each row weighted by its
// compliance. Falls back to one difference.
void AndersonAcceleration::chooseShares(const std::vector<int>& working)
{
    static_assert(kMixed == 2, "two equations are solved here");
    double own[2] = {0, 0}, both = 0, change[2] = {0, 0};
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        const double w = m_rows.rows()[working[k]].m_rowCompliance.x;
        const Swept& swept = m_swept[k];
        const Vec3* deltas = swept.m_changeDelta;
        both += w * dot(deltas[0], deltas[1]);
        for (int j = 0; j < 2; ++j)
        {
            own[j] += w * dot(deltas[j], deltas[j]);
            change[j] += w * dot(deltas[j], swept.m_change);
        }
    }
    m_shares = {};
    if (!m_trusted) return;
    const double determinant = own[0] * own[1] - both * both;
    if (determinant > 0)
        m_shares = {(change[0] * own[1] - change[1] * both) / determinant,
                    (change[1] * own[0] - change[0] * both) / determinant};
    else if (own[m_slot] > 0)
        m_shares[m_slot] = change[m_slot] / own[m_slot];
    const auto isNear = [](double share) { return std::abs(share) <= kMaxMixingWeight; };
    if (!std::all_of(m_shares.begin(), m_shares.end(), isNear)) m_shares = {};
}

}  // namespace bullet_fem
