// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

constexpr int kPanelLanes = 16;    ///< rows side by side in a panel, and right-hand sides of a batch
constexpr int kPanelColumns = 12;  ///< columns of a chunk; the last chunk of a panel has 3, 6, 9 or 12

/// The dense panel of a supernode. Its rows are those of M, then those of S, padded with zeros to blocks of 16. Memory
/// layout: chunk of columns, block of rows, column, row.
struct Panel
{
    const float* m_values;  // aligned to 64 bytes
    const int* m_row;       // node of every three rows of M
    int m_firstNode;        // node of the first column
    int m_columns;          // a multiple of 3
    int m_rowsBelow;        // rows of M, a multiple of 3

    int blocksBelow() const { return (m_rowsBelow + kPanelLanes - 1) / kPanelLanes; }
    int blocks() const { return (m_rowsBelow + m_columns + kPanelLanes - 1) / kPanelLanes; }
};

/// The steps of a solve with a panel; y has 3 entries per node, or 3 x 16 interleaved (Lanes). `scratch` has 16
/// blocks() entries (times 16), aligned to 64 bytes. Uses the widest vectors that the processor has.
void forwardPanel(const Panel& panel, float* y, float* scratch);
void backwardPanel(const Panel& panel, float* y, float* scratch);
void forwardPanelLanes(const Panel& panel, float* y, float* scratch);
void backwardPanelLanes(const Panel& panel, float* y, float* scratch);

}  // namespace bullet_fem
