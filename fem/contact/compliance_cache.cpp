// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance_cache.h"

#include <algorithm>
#include <utility>

#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

// Of columns on the low-memory path, see LaneGradients. At 1e-2 stiff bodies (1 GPa) bounced higher than they fell.
constexpr double kColumnTolerance = 1e-3;

// Adds a supernode and its ancestors to a marked set.
void markToRoot(const SupernodeTree& tree, int supernode, std::vector<unsigned char>& marked)
{
    for (int s = supernode; s >= 0 && !marked[s]; s = tree.m_supernodes[s].m_parent) marked[s] = 1;
}

void listMarked(const std::vector<unsigned char>& marked, std::vector<int>& list)
{
    list.clear();
    for (std::size_t s = 0; s < marked.size(); ++s)
        if (marked[s]) list.push_back(static_cast<int>(s));
}

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
      m_slotOfNode(m_model->nodeCount(), -1),
      m_supernodeOfPosition(m_model->factor().freeNodeCount()),
      m_marked(m_model->factor().lower().tree().m_supernodes.size()),
      m_rightSide(allocateFloats(static_cast<std::size_t>(m_model->factor().lower().size()) * kPanelLanes)),
      m_scratch(allocateFloats(m_model->factor().lower().laneScratchSize()))
{
    const SupernodeTree& tree = m_model->factor().lower().tree();
    for (std::size_t s = 0; s < tree.m_supernodes.size(); ++s)
        for (int c = 0; c < tree.m_supernodes[s].m_columns; ++c)
            m_supernodeOfPosition[tree.m_supernodes[s].m_first + c] = static_cast<int>(s);

    for (std::size_t k = 0; k < m_nodes.size(); ++k)
    {
        m_placeOfNode[m_nodes[k]] = static_cast<int>(k);
        markNode(m_nodes[k]);
    }
    m_reach.reserve(m_marked.size());
    m_newNodes.reserve(m_nodes.size());
    listMarked(m_marked, m_nodeSupernodes);
}

void ComplianceCache::markNode(int node)
{
    const int position = m_model->factor().position(node);
    if (position >= 0) markToRoot(m_model->factor().lower().tree(), m_supernodeOfPosition[position], m_marked);
}

// The slot used longest ago. The caller has made sure that one is not in use by the current request.
int ComplianceCache::claimSlot()
{
    const auto oldest = std::min_element(m_lastUse.begin(), m_lastUse.end());
    const int slot = static_cast<int>(oldest - m_lastUse.begin());
    if (m_nodeOfSlot[slot] >= 0) m_slotOfNode[m_nodeOfSlot[slot]] = -1;
    return slot;
}

// For twice as many columns as are needed now, or all that the budget allows. What is not written takes no memory yet.
void ComplianceCache::makeRoom(std::size_t columns)
{
    const std::size_t all = m_nodes.size(), columnSize = 9 * all;
    const std::size_t affordable = m_budget / (sizeof(float) * columnSize);
    const std::size_t room = std::max(std::min(all, std::max(2 * columns, affordable)), m_columns.size());
    while (m_columns.size() < room) m_columns.push_back(allocateFloats(columnSize));
    m_nodeOfSlot.resize(room, -1);
    m_lastUse.resize(room, 0);
    if (!m_gradients && m_model->factorReport().m_path == FactorPath::lowMemory)
        m_gradients = std::make_unique<LaneGradients>(*m_model);
}

void ComplianceCache::request(const std::vector<int>& nodes)
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
    // Neighbours in the factor share most of their way to the root.
    const RestFactor& factor = m_model->factor();
    std::sort(m_newNodes.begin(), m_newNodes.end(),
              [&factor](int a, int b) { return std::pair(factor.position(a), a) < std::pair(factor.position(b), b); });
    const std::size_t columns = 3 * m_newNodes.size();
    for (std::size_t first = 0; first < columns; first += kPanelLanes)
        solveColumns(first, std::min<std::size_t>(first + kPanelLanes, columns));
}

// Three columns a new node, one a lane. Scaled by the diagonal, so that single precision sees numbers of order one
// whatever the body weighs.
void ComplianceCache::solveColumns(std::size_t first, std::size_t end)
{
    const RestFactor& factor = m_model->factor();
    std::fill(m_marked.begin(), m_marked.end(), static_cast<unsigned char>(0));
    std::fill(m_rightSide.get(), m_rightSide.get() + static_cast<std::size_t>(factor.lower().size()) * kPanelLanes,
              0.f);
    for (std::size_t column = first; column < end; ++column)
    {
        const int node = m_newNodes[column / 3], position = factor.position(node);
        if (position < 0) continue;
        markNode(node);
        m_rightSide[(3 * static_cast<std::size_t>(position) + column % 3) * kPanelLanes + column - first] =
            static_cast<float>(factor.diagonal(node));
    }
    listMarked(m_marked, m_reach);
    if (m_gradients)
        m_gradients->solve(kColumnTolerance, m_rightSide.get(), m_scratch.get());
    else
        factor.lower().solveLanes(m_reach, m_nodeSupernodes, m_rightSide.get(), m_scratch.get());
    copyColumns(first, end);
}

void ComplianceCache::copyColumns(std::size_t first, std::size_t end)
{
    const RestFactor& factor = m_model->factor();
    float* out[kPanelLanes];
    float scale[kPanelLanes];
    const std::size_t count = end - first;
    for (std::size_t lane = 0; lane < count; ++lane)
    {
        const int node = m_newNodes[(first + lane) / 3];
        out[lane] = m_columns[m_slotOfNode[node]].get() + (first + lane) % 3;
        scale[lane] = factor.position(node) < 0 ? 0.f : 1 / static_cast<float>(factor.diagonal(node));
    }
    for (std::size_t k = 0; k < m_nodes.size(); ++k)
    {
        const int position = factor.position(m_nodes[k]);
        for (std::size_t i = 0; i < 3; ++i)
        {
            const float* row =
                position < 0 ? nullptr : &m_rightSide[(3 * static_cast<std::size_t>(position) + i) * kPanelLanes];
            for (std::size_t lane = 0; lane < count; ++lane)
                out[lane][9 * k + 3 * i] = row ? scale[lane] * row[lane] : 0.f;
        }
    }
}

Mat3 ComplianceCache::block(int i, int j) const
{
    const float* c = &m_columns[m_slotOfNode[j]][9 * static_cast<std::size_t>(m_placeOfNode[i])];
    return {{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}}};
}

}  // namespace bullet_fem
