// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/node_set_factors.h"

#include <algorithm>

#include "fem/contact/compliance/compliance_cache.h"
#include "fem/factor/rest_modes.h"

namespace bullet_fem
{
namespace
{

// Memory of a set of this many nodes, with a full matrix and factor [B].
std::size_t bytesOfFactor(std::size_t nodes)
{
    return 2 * sizeof(double) * 9 * nodes * (nodes + 1) / 2;
}

// The block of A0^-1, rest modes included. Uses one of the two symmetric entries, independent of the order of the
// nodes.
Mat3 blockBetween(int a, int b, const ComplianceCache& columns)
{
    const BodyModel& model = columns.model();
    const Mat3 elastic = a >= b ? columns.block(a, b) : transpose(columns.block(b, a));
    return elastic + model.restModes().response(a, b);
}

std::shared_ptr<const EnvelopeFactor> factorBetween(const std::vector<int>& nodes, ComplianceCache& columns)
{
    columns.request(nodes);
    const int count = static_cast<int>(nodes.size());
    const auto factor = std::make_shared<EnvelopeFactor>();
    factor->reserve(nodes.size(), nodes.size() * (nodes.size() + 1) / 2);
    for (int k = 0; k < count; ++k) factor->addRow(0);
    for (int k = 0; k < count; ++k)
        for (int j = 0; j <= k; ++j) factor->set(k, j, blockBetween(nodes[k], nodes[j], columns));
    const std::vector<unsigned char> held(3 * nodes.size(), 0);
    factor->factor(held.data());
    return factor;
}

}  // namespace

std::shared_ptr<const EnvelopeFactor> NodeSetFactors::of(const std::vector<int>& nodes, ComplianceCache& columns)
{
    const auto found =
        std::find_if(m_kept.begin(), m_kept.end(), [&](const Kept& kept) { return kept.m_nodes == nodes; });
    if (found != m_kept.end())
        std::rotate(found, found + 1, m_kept.end());
    else
    {
        makeRoom(bytesOfFactor(nodes.size()));
        m_kept.push_back({nodes, factorBetween(nodes, columns)});
    }
    return m_kept.back().m_factor;
}

// Drops the least recently used sets.
void NodeSetFactors::makeRoom(std::size_t bytes)
{
    for (const Kept& kept : m_kept) bytes += bytesOfFactor(kept.m_nodes.size());
    while (!m_kept.empty() && bytes > kBudget)
    {
        bytes -= bytesOfFactor(m_kept.front().m_nodes.size());
        m_kept.erase(m_kept.begin());
    }
}

}  // namespace bullet_fem
