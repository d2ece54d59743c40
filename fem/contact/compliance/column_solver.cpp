// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/column_solver.h"

#include <algorithm>

#include "fem/factor/rest_factor.h"
#include "fem/factor/rest_modes.h"

namespace bullet_fem
{
namespace
{

// Tolerance of columns on the low-memory path, see LaneGradients. At 1e-2 stiff bodies (1 GPa) bounced higher than
// their initial height.
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

ColumnSolver::ColumnSolver(const BodyModel& model, const std::vector<int>& nodes)
    : m_model(model),
      m_nodes(nodes),
      m_supernodeOfPosition(model.factor().freeNodeCount()),
      m_marked(model.factor().lower().tree().m_supernodes.size()),
      m_rightSide(allocateFloats(static_cast<std::size_t>(model.factor().lower().size()) * kPanelLanes)),
      m_scratch(allocateFloats(model.factor().lower().laneScratchSize()))
{
    const SupernodeTree& tree = model.factor().lower().tree();
    for (std::size_t s = 0; s < tree.m_supernodes.size(); ++s)
        for (int c = 0; c < tree.m_supernodes[s].m_columns; ++c)
            m_supernodeOfPosition[tree.m_supernodes[s].m_first + c] = static_cast<int>(s);
    for (int node : nodes) markNode(node);
    m_reach.reserve(m_marked.size());
    listMarked(m_marked, m_nodeSupernodes);
    if (model.restModes().any()) m_rigid = std::make_unique<RigidLanes>(model);
    m_rigidShare = 1 / massScale(model);
}

void ColumnSolver::markNode(int node)
{
    const int position = m_model.factor().position(node);
    if (position >= 0) markToRoot(m_model.factor().lower().tree(), m_supernodeOfPosition[position], m_marked);
}

// One column per lane, scaled by the diagonal, so that numbers are of order one in single precision whatever the body's
// mass.
void ColumnSolver::solve(const Column* columns, int count)
{
    const RestFactor& factor = m_model.factor();
    const std::size_t size = static_cast<std::size_t>(factor.lower().size()) * kPanelLanes;
    std::fill(m_marked.begin(), m_marked.end(), static_cast<unsigned char>(0));
    std::fill(m_rightSide.get(), m_rightSide.get() + size, 0.f);
    for (int lane = 0; lane < count; ++lane)
    {
        const int position = factor.position(columns[lane].m_node);
        if (position < 0) continue;
        markNode(columns[lane].m_node);
        m_rightSide[static_cast<std::size_t>(3 * position + columns[lane].m_axis) * kPanelLanes + lane] =
            static_cast<float>(factor.diagonal(columns[lane].m_node));
    }
    if (m_model.factorReport().m_path == FactorPath::lowMemory)
    {
        if (!m_gradients) m_gradients = std::make_unique<LaneGradients>(m_model);
        m_gradients->solve(kColumnTolerance, m_rightSide.get(), m_scratch.get());
    }
    else
    {
        listMarked(m_marked, m_reach);
        if (m_rigid) m_rigid->remember(m_rightSide.get());
        factor.lower().solveLanes(m_reach, m_nodeSupernodes, m_rightSide.get(), m_scratch.get());
        if (m_rigid) m_rigid->removeStored(m_rigidShare, m_rightSide.get());
    }
    writeColumns(columns, count);
}

void ColumnSolver::writeColumns(const Column* columns, int count)
{
    const RestFactor& factor = m_model.factor();
    float* out[kPanelLanes];
    float scale[kPanelLanes];
    for (int lane = 0; lane < count; ++lane)
    {
        const int node = columns[lane].m_node;
        out[lane] = columns[lane].m_out + columns[lane].m_axis;
        scale[lane] = factor.position(node) < 0 ? 0.f : 1 / static_cast<float>(factor.diagonal(node));
    }
    for (std::size_t k = 0; k < m_nodes.size(); ++k)
    {
        const int position = factor.position(m_nodes[k]);
        for (std::size_t i = 0; i < 3; ++i)
        {
            const float* row =
                position < 0 ? nullptr : &m_rightSide[(3 * static_cast<std::size_t>(position) + i) * kPanelLanes];
            for (int lane = 0; lane < count; ++lane) out[lane][9 * k + 3 * i] = row ? scale[lane] * row[lane] : 0.f;
        }
    }
}

}  // namespace bullet_fem
