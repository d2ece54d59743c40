// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/packed_factor.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "fem/factor/isotropic_panel_kernels.h"
#include "fem/pieces.h"

namespace bullet_fem
{

namespace
{

// Rows of a panel, padded.
std::size_t paddedRows(const Supernode& s, NodeEntry entry)
{
    return (rowsOfNode(entry) * (static_cast<std::size_t>(s.m_columns) + s.m_rows) + kPanelLanes - 1) / kPanelLanes *
           kPanelLanes;
}

}  // namespace

std::size_t PackedFactor::bytesFor(const SupernodeTree& tree, NodeEntry entry)
{
    std::size_t floats = 0;
    for (const Supernode& s : tree.m_supernodes) floats += paddedRows(s, entry) * rowsOfNode(entry) * s.m_columns;
    return sizeof(float) * floats;
}

PackedFactor::PackedFactor(SupernodeTree tree, NodeEntry entry)
    : m_entry(entry), m_tree(std::move(tree)), m_division(m_tree), m_all(m_tree.m_supernodes.size())
{
    layOutPanels();
    const std::shared_ptr<AlignedFloats> own = std::make_shared<AlignedFloats>(allocateFloats(floatCount()));
    m_packing = own->get();
    std::fill(m_packing, m_packing + floatCount(), 0.f);
    m_panels = std::shared_ptr<const float>(own, m_packing);
}

PackedFactor::PackedFactor(SupernodeTree tree, NodeEntry entry, std::shared_ptr<const float> panels)
    : m_entry(entry),
      m_tree(std::move(tree)),
      m_division(m_tree),
      m_all(m_tree.m_supernodes.size()),
      m_panels(std::move(panels))
{
    layOutPanels();
}

void PackedFactor::layOutPanels()
{
    std::iota(m_all.begin(), m_all.end(), 0);
    m_panelStart.push_back(0);
    for (const Supernode& s : m_tree.m_supernodes)
    {
        m_panelStart.push_back(m_panelStart.back() + paddedRows(s, m_entry) * rowsOfNode(m_entry) * s.m_columns);
        m_scratchRows = std::max(m_scratchRows, paddedRows(s, m_entry));
    }
    layOutScratch();
}

Panel PackedFactor::panel(int supernode) const
{
    const Supernode& s = m_tree.m_supernodes[supernode];
    const int k = rowsOfNode(m_entry);
    return {m_panels.get() + m_panelStart[supernode], m_tree.m_row.data() + s.m_rowStart, s.m_first, k * s.m_columns,
            k * s.m_rows};
}

void PackedFactor::pack(int supernode, const double* S, const double* M)
{
    const Panel p = panel(supernode);
    float* out = m_packing + m_panelStart[supernode];
    const int chunkColumns = m_entry == NodeEntry::block ? kPanelColumns : kIsotropicColumns;
    for (int chunk = 0; chunk < p.m_columns; chunk += chunkColumns)
    {
        const int width = std::min(chunkColumns, p.m_columns - chunk);
        for (int block = 0; block < p.blocks(); ++block)
            for (int c = chunk; c < chunk + width; ++c)
                for (int r = block * kPanelLanes; r < (block + 1) * kPanelLanes; ++r, ++out)
                {
                    const int own = r - p.m_rowsBelow;
                    if (own < 0)
                        *out = static_cast<float>(M[r + static_cast<std::size_t>(c) * p.m_rowsBelow]);
                    else if (own < p.m_columns)
                        *out = static_cast<float>(S[own + static_cast<std::size_t>(c) * p.m_columns]);
                }
    }
}

// Every subtree has scratch of its own, and the top.
void PackedFactor::layOutScratch()
{
    for (const Subtree& subtree : m_division.m_subtrees)
    {
        std::size_t longest = 0;
        for (int s = subtree.m_begin; s < subtree.m_end; ++s)
            longest = std::max(longest, paddedRows(m_tree.m_supernodes[s], m_entry));
        m_scratchStart.push_back(m_scratchStart.back() + scratchOf(longest));
    }
    m_scratchStart.push_back(m_scratchStart.back() + scratchOf(m_scratchRows));
}

void PackedFactor::forward(const Panel& panel, const PanelGroup& group) const
{
    if (m_entry == NodeEntry::block && group.m_count > 1) return forwardPanelGroup(panel, group);
    const auto alone = m_entry == NodeEntry::block ? forwardPanel : forwardIsotropic;
    for (int k = 0; k < group.m_count; ++k) alone(panel, group.m_y[k], group.m_scratch[k]);
}

void PackedFactor::backward(const Panel& panel, const PanelGroup& group) const
{
    if (m_entry == NodeEntry::block && group.m_count > 1) return backwardPanelGroup(panel, group);
    const auto alone = m_entry == NodeEntry::block ? backwardPanel : backwardIsotropic;
    for (int k = 0; k < group.m_count; ++k) alone(panel, group.m_y[k], group.m_scratch[k]);
}

// The panel with a subtree's own rows in place of those above it.
Panel PackedFactor::forwardPanelOf(int supernode) const
{
    Panel p = panel(supernode);
    p.m_row = m_division.m_forwardRow.data() + m_tree.m_supernodes[supernode].m_rowStart;
    return p;
}

void PackedFactor::forwardSubtree(int t, const PanelGroup& group) const
{
    const Subtree& subtree = m_division.m_subtrees[t];
    const PanelGroup own = group.withScratchAt(m_scratchStart[t]);
    for (int k = 0; k < group.m_count; ++k)
        std::fill_n(group.m_y[k] + 3 * static_cast<std::size_t>(subtree.m_firstAbove),
                    3 * static_cast<std::size_t>(m_tree.m_supernodes[subtree.m_end - 1].m_rows), 0.f);
    for (int s = subtree.m_begin; s < subtree.m_end; ++s) forward(forwardPanelOf(s), own);
}

void PackedFactor::backwardSubtree(int t, const PanelGroup& group) const
{
    const Subtree& subtree = m_division.m_subtrees[t];
    const PanelGroup own = group.withScratchAt(m_scratchStart[t]);
    for (int s = subtree.m_end - 1; s >= subtree.m_begin; --s) backward(panel(s), own);
}

void PackedFactor::addRowsAbove(float* y) const
{
    for (const Subtree& subtree : m_division.m_subtrees)
    {
        const Supernode& root = m_tree.m_supernodes[subtree.m_end - 1];
        const float* own = y + 3 * static_cast<std::size_t>(subtree.m_firstAbove);
        for (int k = 0; k < root.m_rows; ++k, own += 3)
        {
            float* row = y + 3 * static_cast<std::size_t>(m_tree.m_row[root.m_rowStart + k]);
            for (int c = 0; c < 3; ++c) row[c] += own[c];
        }
    }
}

void PackedFactor::solve(float* y, float* scratch, const Threads* threads) const
{
    PanelGroup alone;
    alone.m_count = 1;
    alone.m_y[0] = y;
    alone.m_scratch[0] = scratch;
    solve(alone, threads);
}

void PackedFactor::solve(const PanelGroup& group, const Threads* threads) const
{
    const int count = static_cast<int>(m_division.m_subtrees.size());
    const PanelGroup top = group.withScratchAt(m_scratchStart[count]);
    runTasks(threads, count, [&](int t) { forwardSubtree(t, group); });
    for (int k = 0; k < group.m_count; ++k) addRowsAbove(group.m_y[k]);
    for (int s : m_division.m_top) forward(panel(s), top);
    for (auto s = m_division.m_top.rbegin(); s != m_division.m_top.rend(); ++s) backward(panel(*s), top);
    // The last subtree first: on one thread it is the one still in the caches.
    runTasks(threads, count, [&](int t) { backwardSubtree(count - 1 - t, group); });
}

void PackedFactor::solveLanes(const std::vector<int>& forward, const std::vector<int>& backward, float* y,
                              float* scratch) const
{
    const bool blocks = m_entry == NodeEntry::block;
    const auto up = blocks ? forwardPanelLanes : forwardIsotropicLanes;
    const auto down = blocks ? backwardPanelLanes : backwardIsotropicLanes;
    for (int s : forward) up(panel(s), y, scratch);
    for (auto s = backward.rbegin(); s != backward.rend(); ++s) down(panel(*s), y, scratch);
}

}  // namespace bullet_fem
