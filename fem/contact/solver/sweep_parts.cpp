// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/sweep_parts.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace bullet_fem
{

void SweepParts::clear(int movers)
{
    m_rows.clear();
    m_movers.assign(movers, Mover());
}

void SweepParts::add(int a, int b, const Vec3& at)
{
    m_rows.push_back({a, b});
    for (int mover : {a, b})
    {
        if (mover < 0) continue;
        m_movers[mover].m_at += at;
        ++m_movers[mover].m_rows;
    }
}

void SweepParts::divide(bool many)
{
    m_levels = 1;
    const int rows = static_cast<int>(m_rows.size());
    while (many && m_levels < kMaxLevels && rows >> m_levels >= kRowsOfPart) ++m_levels;
    m_order.clear();
    m_order.reserve(m_movers.size());
    for (std::size_t k = 0; k < m_movers.size(); ++k)
    {
        Mover& mover = m_movers[k];
        if (mover.m_rows == 0) continue;
        mover.m_at *= 1.0 / mover.m_rows;
        m_order.push_back(static_cast<int>(k));
    }
    m_smallest.assign(m_movers.size(), 1);
    cut({0, static_cast<int>(m_order.size())}, 1, m_levels - 1);
    m_part.clear();
    for (const Row& row : m_rows) m_part.push_back(partOf(row));
    m_first.assign(parts() + 1, 0);
    m_unsorted.reserve(m_rows.size());
}

// Part k is divided into 2k and 2k + 1.
void SweepParts::cut(Range movers, int part, int levels)
{
    if (levels == 0)
    {
        for (int k = movers.m_begin; k < movers.m_end; ++k) m_smallest[m_order[k]] = part;
        return;
    }
    const int axis = longestAxis(movers);
    const auto before = [&](int a, int b)
    { return std::make_tuple(m_movers[a].m_at[axis], a) < std::make_tuple(m_movers[b].m_at[axis], b); };
    std::sort(m_order.begin() + movers.m_begin, m_order.begin() + movers.m_end, before);
    const int end = middle(movers);
    cut({movers.m_begin, end}, 2 * part, levels - 1);
    cut({end, movers.m_end}, 2 * part + 1, levels - 1);
}

int SweepParts::longestAxis(Range movers) const
{
    int longest = 0;
    double most = -1;
    for (int axis = 0; axis < 3; ++axis)
    {
        double low = 0, high = 0;
        for (int k = movers.m_begin; k < movers.m_end; ++k)
        {
            const double x = m_movers[m_order[k]].m_at[axis];
            low = k == movers.m_begin ? x : std::min(low, x);
            high = k == movers.m_begin ? x : std::max(high, x);
        }
        if (!(high - low > most)) continue;
        most = high - low;
        longest = axis;
    }
    return longest;
}

// Splits where the movers before have half of the rows.
int SweepParts::middle(Range movers) const
{
    long all = 0, before = 0;
    for (int k = movers.m_begin; k < movers.m_end; ++k) all += m_movers[m_order[k]].m_rows;
    int k = movers.m_begin;
    for (; k < movers.m_end && 2 * before < all; ++k) before += m_movers[m_order[k]].m_rows;
    return k;
}

int SweepParts::partOf(const Row& row) const
{
    if (row.m_a < 0 && row.m_b < 0) return 1;
    int a = m_smallest[row.m_a >= 0 ? row.m_a : row.m_b], b = m_smallest[row.m_b >= 0 ? row.m_b : row.m_a];
    while (a != b)
    {
        a /= 2;
        b /= 2;
    }
    return a;
}

void SweepParts::sort(std::vector<int>& rows)
{
    m_first.assign(parts() + 1, 0);
    m_first[parts()] = static_cast<int>(rows.size());
    if (m_levels == 1)
    {
        m_first[1] = 0;
        return;
    }
    for (int row : rows) ++m_first[m_part[row]];
    int sum = 0;
    for (int part = 0; part < parts(); ++part) sum += std::exchange(m_first[part], sum);
    m_unsorted.assign(rows.begin(), rows.end());
    for (int row : m_unsorted) rows[m_first[m_part[row]]++] = row;
    for (int part = parts(); part-- > 1;) m_first[part] = m_first[part - 1];
    m_first[0] = 0;
}

}  // namespace bullet_fem
