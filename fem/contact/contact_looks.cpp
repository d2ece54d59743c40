// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>

#include "fem/contact/contact_rows.h"

namespace bullet_fem
{
namespace
{

constexpr int kLongLife = 10;   // sweeps of a working set
constexpr int kShortLife = 2;   // where a share of its rows has just joined it
constexpr double kNews = 0.02;  // that share

}  // namespace

void ContactRows::forgetWorkingSet()
{
    m_lifeOfSet = -1;
    m_looked = false;
}

// Most points that were found near a surface carry nothing, and most of them never will: some sweeps go by without
// looking at them. What carries an impulse, wants one or is a joint works. Where that changes, it is looked at again
// soon.
void ContactRows::chooseWorkingSet()
{
    if (!m_looked) lookForWork();
    m_looked = false;
    m_working.clear();
    int joined = 0;
    for (std::size_t k = 0; k < m_rows.size(); ++k)
    {
        if (m_wants[k]) m_working.push_back(static_cast<int>(k));
        if (m_wants[k] && !m_works[k]) ++joined;
    }
    m_works.swap(m_wants);
    m_parts.sort(m_working);
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b) m_bodies[b].choose();
    for (int k : m_working)
        for (const RowEnd* end : {&m_rows[k].m_a, &m_rows[k].m_b})
            if (end->m_body >= 0) m_bodies[end->m_body].work(end->m_end);
    forEachTouchedBody(threadsForCompliance(), [this](int b) { m_bodies[b].startWork(); });
    if (joined > 0) m_subspace.m_tried = false;  // more work is to be expected
    m_lifeOfSet = joined > kNews * static_cast<double>(m_working.size()) ? kShortLife : kLongLife;
}

// True of a contact that carries nothing and wants nothing, as most do.
bool ContactRows::rests(const Row& row) const
{
    if (row.m_joint || dot(row.m_impulse, row.m_impulse) > 0) return false;
    return row.m_idle || !(row.m_target.x > dot(row.m_axes[0], velocity(row)));
}

void ContactRows::lookForWork()
{
    flush();
    forEachPieceOfRows(
        [this](int, Range rows)
        {
            for (int k = rows.m_begin; k < rows.m_end; ++k) m_wants[k] = !rests(m_rows[k]);
        });
    m_looked = true;
}

// If rows that rest are to change by more than the tolerance, the next sweep chooses another working set.
bool ContactRows::restIsDone(double tolerance)
{
    if (m_working.size() == m_rows.size()) return true;
    lookForWork();
    m_lifeOfSet = -1;
    m_subspace.m_tried = false;  // more work is to be expected
    double largest = 0;
    for (std::size_t k = 0; k < m_rows.size(); ++k)
        if (m_wants[k] && !m_works[k]) largest = std::max(largest, wantedSpeed(m_rows[k]));
    return share(largest) <= tolerance;
}

// The change of a row as a velocity: what it does to its own point.
double ContactRows::speedOf(const Row& row, const Vec3& difference)
{
    const Vec3& w = row.m_rowCompliance;
    return (row.m_joint ? std::max({w.x, w.y, w.z}) : w.x) * norm(difference);
}

double ContactRows::wantedSpeed(const Row& row) const
{
    return rests(row) ? 0 : speedOf(row, solveRow(row, row.m_impulse, velocity(row), 1) - row.m_impulse);
}

double ContactRows::largestChange()
{
    return largestOfRows([this](const Row& row) { return wantedSpeed(row); });
}

}  // namespace bullet_fem
