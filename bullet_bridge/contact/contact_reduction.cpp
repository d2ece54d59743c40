// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/contact_reduction.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{
namespace
{

constexpr double kFine = 0.6;   // a skin is fine if its mean edge over the tetrahedra's is smaller [-]
constexpr double kCell = 0.5;   // width of a cell over the tetrahedra's mean edge [-]
constexpr double kWider = 1.4;  // growth of a cell until contacts are few enough: half as many on a surface [-]

}  // namespace

double ContactReduction::cellOf(const FemSoftBody& fem)
{
    const double edge = fem.m_body.m_model->mesh().meanEdgeLength();
    return fem.m_skin && fem.m_surface.meanEdge() < kFine * edge ? kCell * edge : 0;
}

double ContactReduction::smallestCellOf(const FemSoftBody& fem)
{
    return kCell * fem.m_surface.meanEdge();
}

void ContactReduction::clear(double cell)
{
    m_cell = cell;
    m_candidates.clear();
}

void ContactReduction::add(const Given& given)
{
    const int index = static_cast<int>(m_candidates.size());
    m_candidates.push_back({given.m_objectId,
                            given.m_restPoint,
                            {},
                            !given.m_held,
                            given.m_gapThen,
                            given.m_contact.m_slop,
                            index,
                            given.m_contact.m_normal});
}

void ContactReduction::choose(int maxAlike)
{
    for (Candidate& candidate : m_candidates)
        for (int c = 0; c < 3; ++c)
            candidate.m_cell[c] = static_cast<int>(std::floor(candidate.m_restPoint[c] / m_cell));
    const auto key = [](const Candidate& c) { return std::tie(c.m_objectId, c.m_cell, c.m_isNew, c.m_gap, c.m_index); };
    std::sort(m_candidates.begin(), m_candidates.end(),
              [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
    m_kept.assign(m_candidates.size(), 0);
    for (std::size_t first = 0, k = 0; k < m_candidates.size(); ++k)
    {
        if (!m_candidates[k].isInCellOf(m_candidates[first])) first = k;
        m_kept[m_candidates[k].m_index] = isNeeded(k, first, maxAlike);
    }
}

void ContactReduction::chooseAbout(int most)
{
    double size = 0;
    for (const Candidate& candidate : m_candidates)
        size = std::max(size, norm(candidate.m_restPoint - m_candidates.front().m_restPoint));
    for (;; m_cell *= kWider)
    {
        choose(1);
        int objects = 1;
        for (std::size_t k = 1; k < m_candidates.size(); ++k)
            objects += m_candidates[k].m_objectId != m_candidates[k - 1].m_objectId;
        keepFewOf(most / objects);
        const auto kept = std::count(m_kept.begin(), m_kept.end(), 1);
        if (kept <= most || m_cell > size) return;
    }
}

// Keeps all contacts of the objects that have at most `share`; the candidates are in order of the objects.
void ContactReduction::keepFewOf(int share)
{
    for (std::size_t first = 0, end = 0; first < m_candidates.size(); first = end)
    {
        while (end < m_candidates.size() && m_candidates[end].m_objectId == m_candidates[first].m_objectId) ++end;
        if (static_cast<int>(end - first) > share) continue;
        for (std::size_t k = first; k < end; ++k) m_kept[m_candidates[k].m_index] = 1;
    }
}

bool ContactReduction::isNeeded(std::size_t candidate, std::size_t firstOfCell, int maxAlike) const
{
    const Candidate& c = m_candidates[candidate];
    int alike = 0;
    bool deeper = true;
    for (std::size_t k = firstOfCell; k < candidate; ++k)
    {
        const Candidate& other = m_candidates[k];
        if (!m_kept[other.m_index] || dot(other.m_normal, c.m_normal) < kSameNormalCosine) continue;
        ++alike;
        deeper = deeper && c.m_gap < other.m_gap - c.m_slop;
    }
    return alike == 0 || (maxAlike > 1 && (c.m_isNew ? deeper : alike < maxAlike));
}

}  // namespace bullet_fem
