// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

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

/// forwardPanel() and backwardPanel() for kPanelLanes right-hand sides, interleaved as in forwardPanelLanes(). Each
/// result is bitwise equal to that of the single right-hand side, so the summation order differs from
/// forwardPanelLanes(), at a small cost. `scratch` has batchScratchOf(panel) entries. Uses the widest vectors that the
/// processor has.
void forwardPanelBatch(const Panel& panel, float* y, float* scratch);
void backwardPanelBatch(const Panel& panel, float* y, float* scratch);

/// Scratch entries: the rows, and partial sums of the columns of a chunk, of all right-hand sides.
inline std::size_t batchScratchOf(const Panel& panel)
{
    const std::size_t rows = panel.m_rowsBelow + panel.m_columns, parts = kPanelColumns * kPanelLanes / 2;
    return kPanelLanes * (rows + parts);
}

constexpr int kIsotropicColumns = 4;  ///< columns of a chunk of an isotropic panel; the last chunk has 1 to 4

/// The steps of a solve with an isotropic panel, which has one row and one column a node, applied to each of the node's
/// three directions: Panel's m_columns and m_rowsBelow count nodes, and a chunk has kIsotropicColumns columns. y has 3
/// entries per node, or 3 x 16 interleaved. `scratch` has 48 blocks() entries (times 16), aligned to 64 bytes. Uses the
/// widest vectors that the processor has.
void forwardIsotropic(const Panel& panel, float* y, float* scratch);
void backwardIsotropic(const Panel& panel, float* y, float* scratch);
void forwardIsotropicLanes(const Panel& panel, float* y, float* scratch);
void backwardIsotropicLanes(const Panel& panel, float* y, float* scratch);

}  // namespace bullet_fem
