// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/compliance_cache.h"

#include <algorithm>
#include <utility>

#include "fem/common/chunks.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

constexpr int kMaxSolvers = 4;  // each needs scratch of the size of 16 vectors, on the low-memory path of 64

}  // namespace

ComplianceCache::ComplianceCache(std::shared_ptr<const BodyModel> model, std::size_t budget)
    : ComplianceCache(model, model->mesh().surfaceNodes(), budget)
{
}

ComplianceCache::ComplianceCache(std::shared_ptr<const BodyModel> model, std::vector<int> nodes, std::size_t budget)
    : m_model(std::move(model)),
      m_budget(budget),
      m_nodes(std::move(nodes)),
      m_placeOfNode(m_model->nodeCount(), -1),
      m_slotOfNode(m_model->nodeCount(), -1)
{
    for (std::size_t k = 0; k < m_nodes.size(); ++k) m_placeOfNode[m_nodes[k]] = static_cast<int>(k);
    m_newNodes.reserve(m_nodes.size());
    m_newColumns.reserve(3 * m_nodes.size());
    m_solvers.push_back(std::make_unique<ColumnSolver>(*m_model, m_nodes));
}

// The slot used longest ago. The caller has made sure that one is not in use by the current request.
int ComplianceCache::claimSlot()
{
    const auto oldest = std::min_element(m_lastUse.begin(), m_lastUse.end());
    const int slot = static_cast<int>(oldest - m_lastUse.begin());
    if (m_nodeOfSlot[slot] >= 0) m_slotOfNode[m_nodeOfSlot[slot]] = -1;
    return slot;
}

// Reserves twice as many columns as are needed now, or all that the budget allows. Unwritten pages take no memory yet.
void ComplianceCache::makeRoom(std::size_t columns)
{
    const std::size_t all = m_nodes.size(), columnSize = 9 * all;
    const std::size_t affordable = m_budget / (sizeof(float) * columnSize);
    const std::size_t room = std::max(std::min(all, std::max(2 * columns, affordable)), m_columns.size());
    while (m_columns.size() < room) m_columns.push_back(allocateFloats(columnSize));
    m_nodeOfSlot.resize(room, -1);
    m_lastUse.resize(room, 0);
}

void ComplianceCache::request(const std::vector<int>& nodes, const Threads* threads)
{
    ++m_requestCount;
    if (nodes.size() > m_columns.size()) makeRoom(nodes.size());
    for (int node : nodes)
        if (m_slotOfNode[node] >= 0) m_lastUse[m_slotOfNode[node]] = m_requestCount;
    m_newNodes.clear();
    for (int node : nodes)
    {
        if (m_slotOfNode[node] >= 0) continue;
        const int slot = claimSlot();
        m_slotOfNode[node] = slot;
        m_nodeOfSlot[slot] = node;
        m_lastUse[slot] = m_requestCount;
        m_newNodes.push_back(node);
    }
    m_solvedColumns += static_cast<long>(m_newNodes.size());
    if (!m_newNodes.empty()) solveNewColumns(threads);
}

// Sorted so that neighbours in the factor are solved together.
void ComplianceCache::solveNewColumns(const Threads* threads)
{
    const RestFactor& factor = m_model->factor();
    std::sort(m_newNodes.begin(), m_newNodes.end(),
              [&factor](int a, int b) { return std::pair(factor.position(a), a) < std::pair(factor.position(b), b); });
    m_newColumns.clear();
    for (int node : m_newNodes)
        for (int axis = 0; axis < 3; ++axis) m_newColumns.push_back({node, axis, m_columns[m_slotOfNode[node]].get()});
    const int columns = static_cast<int>(m_newColumns.size()), batches = (columns + kPanelLanes - 1) / kPanelLanes;
    const int solvers = threads ? std::min({threads->count(), batches, kMaxSolvers}) : 1;
    while (static_cast<int>(m_solvers.size()) < solvers)
        m_solvers.push_back(std::make_unique<ColumnSolver>(*m_model, m_nodes));
    runTasks(solvers > 1 ? threads : nullptr, solvers,
             [&](int s)
             {
                 for (int first = s * kPanelLanes; first < columns; first += solvers * kPanelLanes)
                     m_solvers[s]->solve(&m_newColumns[first], std::min(columns - first, kPanelLanes));
             });
}

Mat3 ComplianceCache::block(int i, int j) const
{
    const float* c = &m_columns[m_slotOfNode[j]][9 * static_cast<std::size_t>(m_placeOfNode[i])];
    return {{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}}};
}

}  // namespace bullet_fem
