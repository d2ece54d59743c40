// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/contact_reduction.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace bullet_fem
{
namespace
{

constexpr double kFine = 0.6;        // a skin is fine if its mean edge over the tetrahedra's is smaller [-]
constexpr double kCell = 0.5;        // width of a cell over the tetrahedra's mean edge [-]
constexpr int kMaxAlike = 8;         // contacts kept in a cell that pushed in the last step and have similar normals
constexpr double kSameNormal = 0.9;  // cosine up to which normals count as different

}  // namespace

double ContactReduction::cellOf(const FemSoftBody& fem)
{
    const double edge = fem.m_body.m_model->mesh().meanEdgeLength();
    return fem.m_skin && fem.m_surface.meanEdge() < kFine * edge ? kCell * edge : 0;
}

void ContactReduction::clear(double cell)
{
    m_cell = cell;
    m_candidates.clear();
}

void ContactReduction::add(const Given& given)
{
    std::array<int, 3> cell;
    for (int c = 0; c < 3; ++c) cell[c] = static_cast<int>(std::floor(given.m_restPoint[c] / m_cell));
    const int index = static_cast<int>(m_candidates.size());
    m_candidates.push_back({given.m_objectId, cell, !given.m_held, given.m_gapThen, given.m_contact.m_slop, index,
                            given.m_contact.m_normal});
}

void ContactReduction::choose()
{
    const auto key = [](const Candidate& c) { return std::tie(c.m_objectId, c.m_cell, c.m_isNew, c.m_gap, c.m_index); };
    std::sort(m_candidates.begin(), m_candidates.end(),
              [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
    m_kept.assign(m_candidates.size(), 0);
    for (std::size_t first = 0, k = 0; k < m_candidates.size(); ++k)
    {
        if (!m_candidates[k].isInCellOf(m_candidates[first])) first = k;
        m_kept[m_candidates[k].m_index] = isNeeded(k, first);
    }
}

bool ContactReduction::isNeeded(std::size_t candidate, std::size_t firstOfCell) const
{
    const Candidate& c = m_candidates[candidate];
    int alike = 0;
    bool deeper = true;
    for (std::size_t k = firstOfCell; k < candidate; ++k)
    {
        const Candidate& other = m_candidates[k];
        if (!m_kept[other.m_index] || dot(other.m_normal, c.m_normal) < kSameNormal) continue;
        ++alike;
        deeper = deeper && c.m_gap < other.m_gap - c.m_slop;
    }
    return alike == 0 || (c.m_isNew ? deeper : alike < kMaxAlike);
}

}  // namespace bullet_fem
