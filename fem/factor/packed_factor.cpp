// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/packed_factor.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "fem/common/chunks.h"
#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

namespace
{

// Number of rows of a panel, padded.
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

// Every subtree, and the top, has its own scratch.
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

// The panel with a subtree's own rows instead of those above it.
Panel PackedFactor::forwardPanelOf(int supernode) const
{
    Panel p = panel(supernode);
    p.m_row = m_division.m_forwardRow.data() + m_tree.m_supernodes[supernode].m_rowStart;
    return p;
}

/// Panel kernels for one vector, or for several interleaved ones.
struct PackedFactor::Kernels
{
    void (*m_forward)(const Panel& panel, float* y, float* scratch);
    void (*m_backward)(const Panel& panel, float* y, float* scratch);
    std::size_t m_node;  // floats per node in y
    bool m_ownScratch;   // every subtree has its own
};

PackedFactor::Kernels PackedFactor::kernels() const
{
    const bool blocks = m_entry == NodeEntry::block;
    return {blocks ? forwardPanel : forwardIsotropic, blocks ? backwardPanel : backwardIsotropic, 3, true};
}

void PackedFactor::addRowsAbove(const Kernels& kernels, float* y) const
{
    for (const Subtree& subtree : m_division.m_subtrees)
    {
        const Supernode& root = m_tree.m_supernodes[subtree.m_end - 1];
        const float* own = y + kernels.m_node * subtree.m_firstAbove;
        for (int k = 0; k < root.m_rows; ++k, own += kernels.m_node)
        {
            float* row = y + kernels.m_node * m_tree.m_row[root.m_rowStart + k];
            for (std::size_t c = 0; c < kernels.m_node; ++c) row[c] += own[c];
        }
    }
}

void PackedFactor::solve(const Kernels& kernels, float* y, float* scratch, const Threads* threads) const
{
    const int count = static_cast<int>(m_division.m_subtrees.size());
    const auto scratchOfSubtree = [&](int t) { return kernels.m_ownScratch ? scratch + m_scratchStart[t] : scratch; };
    const auto forward = [&](int t)
    {
        const Subtree& subtree = m_division.m_subtrees[t];
        std::fill_n(y + kernels.m_node * subtree.m_firstAbove,
                    kernels.m_node * m_tree.m_supernodes[subtree.m_end - 1].m_rows, 0.f);
        for (int s = subtree.m_begin; s < subtree.m_end; ++s)
            kernels.m_forward(forwardPanelOf(s), y, scratchOfSubtree(t));
    };
    const auto backward = [&](int t)
    {
        const Subtree& subtree = m_division.m_subtrees[t];
        for (int s = subtree.m_end - 1; s >= subtree.m_begin; --s) kernels.m_backward(panel(s), y, scratchOfSubtree(t));
    };
    runTasks(threads, count, forward);
    addRowsAbove(kernels, y);
    float* const top = scratchOfSubtree(count);
    for (int s : m_division.m_top) kernels.m_forward(panel(s), y, top);
    for (auto s = m_division.m_top.rbegin(); s != m_division.m_top.rend(); ++s) kernels.m_backward(panel(*s), y, top);
    // In reverse order: on one thread the last subtree is still in the caches.
    runTasks(threads, count, [&](int t) { backward(count - 1 - t); });
}

void PackedFactor::solve(float* y, float* scratch, const Threads* threads) const
{
    solve(kernels(), y, scratch, threads);
}

void PackedFactor::solveBatch(float* y, float* scratch) const
{
    solve({forwardPanelBatch, backwardPanelBatch, 3 * kPanelLanes, false}, y, scratch, nullptr);
}

std::size_t PackedFactor::batchScratchSize() const
{
    std::size_t most = 0;
    for (int s : m_all) most = std::max(most, batchScratchOf(panel(s)));
    return most;
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
