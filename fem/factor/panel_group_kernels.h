// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

constexpr int kPanelGroup = 4;  ///< right-hand sides that share a pass over a panel: more do not fit into the registers

/// Right-hand sides of a group, and the scratch of each, as forwardPanel() takes them: arrays of their own.
struct PanelGroup
{
    int m_count = 0;  ///< in [1, kPanelGroup]
    float* m_y[kPanelGroup] = {};
    float* m_scratch[kPanelGroup] = {};  ///< aligned to 64 bytes

    /// The same vectors with scratch that begins `floats` later.
    PanelGroup withScratchAt(std::size_t floats) const
    {
        PanelGroup moved = *this;
        for (int k = 0; k < m_count; ++k) moved.m_scratch[k] += floats;
        return moved;
    }
};

/// forwardPanel() and backwardPanel() of every vector of the group, with the same bits: an entry of the panel is read
/// once for all of them. Run on the widest vectors that the processor has.
void forwardPanelGroup(const Panel& panel, const PanelGroup& group);
void backwardPanelGroup(const Panel& panel, const PanelGroup& group);

}  // namespace bullet_fem
