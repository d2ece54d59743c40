// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/packed_factor.h"

#include <algorithm>
#include <numeric>

namespace bullet_fem
{

namespace
{

// Rows of a panel, padded.
std::size_t paddedRows(const Supernode& s)
{
    return (3 * (static_cast<std::size_t>(s.m_columns) + s.m_rows) + kPanelLanes - 1) / kPanelLanes * kPanelLanes;
}

}  // namespace

std::size_t PackedFactor::bytesFor(const SupernodeTree& tree)
{
    std::size_t floats = 0;
    for (const Supernode& s : tree.m_supernodes) floats += paddedRows(s) * 3 * s.m_columns;
    return sizeof(float) * floats;
}

PackedFactor::PackedFactor(SupernodeTree tree) : m_tree(std::move(tree)), m_all(m_tree.m_supernodes.size())
{
    std::iota(m_all.begin(), m_all.end(), 0);
    m_panelStart.push_back(0);
    for (const Supernode& s : m_tree.m_supernodes)
    {
        m_panelStart.push_back(m_panelStart.back() + paddedRows(s) * 3 * s.m_columns);
        m_scratchRows = std::max(m_scratchRows, paddedRows(s));
    }
    m_panels = allocateFloats(m_panelStart.back());
    std::fill(m_panels.get(), m_panels.get() + m_panelStart.back(), 0.f);
}

Panel PackedFactor::panel(int supernode) const
{
    const Supernode& s = m_tree.m_supernodes[supernode];
    return {m_panels.get() + m_panelStart[supernode], m_tree.m_row.data() + s.m_rowStart, s.m_first, 3 * s.m_columns,
            3 * s.m_rows};
}

void PackedFactor::pack(int supernode, const double* S, const double* M)
{
    const Panel p = panel(supernode);
    float* out = m_panels.get() + m_panelStart[supernode];
    for (int chunk = 0; chunk < p.m_columns; chunk += kPanelColumns)
    {
        const int width = std::min(kPanelColumns, p.m_columns - chunk);
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

void PackedFactor::solve(float* y, float* scratch) const
{
    for (int s : m_all) forwardPanel(panel(s), y, scratch);
    for (auto s = m_all.rbegin(); s != m_all.rend(); ++s) backwardPanel(panel(*s), y, scratch);
}

void PackedFactor::solveLanes(const std::vector<int>& forward, const std::vector<int>& backward, float* y,
                              float* scratch) const
{
    for (int s : forward) forwardPanelLanes(panel(s), y, scratch);
    for (auto s = backward.rbegin(); s != backward.rend(); ++s) backwardPanelLanes(panel(*s), y, scratch);
}

}  // namespace bullet_fem
