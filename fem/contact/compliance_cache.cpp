// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance_cache.h"

#include <algorithm>

#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{
constexpr int kLanes = 4;  // three directions of a node and one idle lane, so that a row is one register
}

ComplianceCache::ComplianceCache(std::shared_ptr<const BodyModel> model)
    : m_model(std::move(model)),
      m_surfaceIndex(m_model->nodeCount(), -1),
      m_slotOfNode(m_model->nodeCount(), -1),
      m_rightSide(static_cast<std::size_t>(m_model->factor().lower().size()) * kLanes),
      m_scratch(static_cast<std::size_t>(m_model->factor().lower().scratchSize()) * kLanes)
{
    const std::vector<int>& surface = m_model->mesh().surfaceNodes();
    for (std::size_t k = 0; k < surface.size(); ++k) m_surfaceIndex[surface[k]] = static_cast<int>(k);
}

// The slot used longest ago. The caller has made sure that one is not in use by the current request.
int ComplianceCache::claimSlot()
{
    const auto oldest = std::min_element(m_lastUse.begin(), m_lastUse.end());
    const int slot = static_cast<int>(oldest - m_lastUse.begin());
    if (m_nodeOfSlot[slot] >= 0) m_slotOfNode[m_nodeOfSlot[slot]] = -1;
    return slot;
}

void ComplianceCache::request(const std::vector<int>& nodes)
{
    ++m_requestCount;
    if (nodes.size() > m_columns.size())
    {
        const std::size_t room = std::min(m_model->mesh().surfaceNodes().size(), 2 * nodes.size());
        const std::size_t columnSize = 9 * m_model->mesh().surfaceNodes().size();
        m_columns.resize(std::max(room, m_columns.size()));
        for (std::vector<float>& column : m_columns) column.resize(columnSize);
        m_nodeOfSlot.resize(m_columns.size(), -1);
        m_lastUse.resize(m_columns.size(), 0);
    }
    for (int node : nodes)
        if (m_slotOfNode[node] >= 0) m_lastUse[m_slotOfNode[node]] = m_requestCount;
    for (int node : nodes)
    {
        if (m_slotOfNode[node] >= 0) continue;
        const int slot = claimSlot();
        m_slotOfNode[node] = slot;
        m_nodeOfSlot[slot] = node;
        m_lastUse[slot] = m_requestCount;
        solveColumn(node, m_columns[slot].data());
    }
}

void ComplianceCache::solveColumn(int node, float* column)
{
    const RestFactor& factor = m_model->factor();
    const std::vector<int>& surface = m_model->mesh().surfaceNodes();
    const int position = factor.position(node);
    if (position < 0)
    {
        std::fill(column, column + 9 * surface.size(), 0.f);
        return;
    }
    // Scaled by the diagonal, so that single precision sees numbers of order one whatever the body weighs.
    const float scale = static_cast<float>(factor.diagonal(node));
    std::fill(m_rightSide.begin(), m_rightSide.end(), 0.f);
    for (int c = 0; c < 3; ++c) m_rightSide[(3 * static_cast<std::size_t>(position) + c) * kLanes + c] = scale;
    factor.lower().solve<kLanes>(m_rightSide.data(), m_scratch.data());
    for (std::size_t k = 0; k < surface.size(); ++k)
    {
        const int row = factor.position(surface[k]);
        for (int i = 0; i < 3; ++i)
            for (int c = 0; c < 3; ++c)
                column[9 * k + 3 * i + c] =
                    row < 0 ? 0.f : m_rightSide[(3 * static_cast<std::size_t>(row) + i) * kLanes + c] / scale;
    }
}

Mat3 ComplianceCache::block(int i, int j) const
{
    const float* c = &m_columns[m_slotOfNode[j]][9 * static_cast<std::size_t>(m_surfaceIndex[i])];
    return {{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}}};
}

}  // namespace bullet_fem
