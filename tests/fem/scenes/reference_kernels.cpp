// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/reference_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace bullet_fem
{

int reference::eliminatePivots(const DenseFront& front, double& pivotValue)
{
    const int p = front.m_pivots, r = front.m_rows, size = p + r;
    // The lower half of the whole front, by its blocks.
    const auto at = [&](int i, int j) -> double&
    {
        if (j >= p) return front.m_A22[(i - p) + static_cast<std::size_t>(j - p) * r];
        if (i >= p) return front.m_A21[(i - p) + static_cast<std::size_t>(j) * r];
        return front.m_A11[i + static_cast<std::size_t>(j) * p];
    };
    const auto symmetric = [&](int i, int j) -> double& { return i >= j ? at(i, j) : at(j, i); };
    for (int k = 0; k < p; ++k)
    {
        const double pivot = pivotValue = at(k, k);
        if (!(pivot > 0 && std::isfinite(pivot))) return k;
        for (int j = 0; j < size; ++j)
            for (int i = j; i < size; ++i)
                if (i != k && j != k) at(i, j) -= symmetric(i, k) * symmetric(j, k) / pivot;
        for (int i = 0; i < size; ++i) symmetric(i, k) /= pivot;
        at(k, k) = -1 / pivot;
    }
    for (int j = 0; j < p; ++j)
        for (int i = j; i < p; ++i) at(i, j) = front.m_A11[j + static_cast<std::size_t>(i) * p] = -at(i, j);
    return -1;
}

void reference::subtractProduct(const DenseProduct& p)
{
    for (int j = 0; j < p.m_n; ++j)
        for (int i = p.m_lowerOnly ? j : 0; i < p.m_m; ++i)
            for (int k = 0; k < p.m_k; ++k)
                p.m_C[i + static_cast<std::ptrdiff_t>(j) * p.m_strideC] -=
                    p.m_U[i + static_cast<std::ptrdiff_t>(k) * p.m_strideU] *
                    p.m_V[j + static_cast<std::ptrdiff_t>(k) * p.m_strideV];
}

namespace
{

float isotropicEntry(const Panel& panel, int row, int column)
{
    const int chunk = column / kIsotropicColumns * kIsotropicColumns;
    const int width = std::min(kIsotropicColumns, panel.m_columns - chunk);
    const std::size_t block = row / kPanelLanes;
    return panel
        .m_values[(static_cast<std::size_t>(chunk) * panel.blocks() + block * width + column - chunk) * kPanelLanes +
                  row % kPanelLanes];
}

// The node of a row of the panel.
int nodeOf(const Panel& panel, int row)
{
    return row < panel.m_rowsBelow ? panel.m_row[row] : panel.m_firstNode + row - panel.m_rowsBelow;
}

}  // namespace

void reference::forwardIsotropic(const Panel& panel, float* y, int lanes)
{
    const std::size_t size = 3 * static_cast<std::size_t>(lanes);
    for (int r = 0; r < panel.m_rowsBelow; ++r)
        for (int c = 0; c < panel.m_columns; ++c)
            for (std::size_t l = 0; l < size; ++l)
                y[nodeOf(panel, r) * size + l] -= isotropicEntry(panel, r, c) * y[(panel.m_firstNode + c) * size + l];
}

void reference::backwardIsotropic(const Panel& panel, float* y, int lanes)
{
    const std::size_t size = 3 * static_cast<std::size_t>(lanes);
    const float* own = y + panel.m_firstNode * size;
    const std::vector<float> before(own, own + panel.m_columns * size);
    for (int c = 0; c < panel.m_columns; ++c)
        for (std::size_t l = 0; l < size; ++l)
        {
            float sum = 0;
            for (int r = 0; r < panel.m_rowsBelow; ++r)
                sum -= isotropicEntry(panel, r, c) * y[nodeOf(panel, r) * size + l];
            for (int r = 0; r < panel.m_columns; ++r)
                sum += isotropicEntry(panel, panel.m_rowsBelow + r, c) * before[r * size + l];
            y[(panel.m_firstNode + c) * size + l] = sum;
        }
}

namespace
{

float entry(const Panel& panel, int row, int column)
{
    const int chunk = column / kPanelColumns * kPanelColumns;
    const int width = std::min(kPanelColumns, panel.m_columns - chunk);
    const std::size_t block = row / kPanelLanes;
    return panel
        .m_values[(static_cast<std::size_t>(chunk) * panel.blocks() + block * width + column - chunk) * kPanelLanes +
                  row % kPanelLanes];
}

// Place in y of a row of the panel.
std::size_t place(const Panel& panel, int row)
{
    if (row >= panel.m_rowsBelow) return 3 * static_cast<std::size_t>(panel.m_firstNode) + row - panel.m_rowsBelow;
    return 3 * static_cast<std::size_t>(panel.m_row[row / 3]) + row % 3;
}

}  // namespace

void reference::forwardPanel(const Panel& panel, float* y, int lanes)
{
    for (int r = 0; r < panel.m_rowsBelow; ++r)
        for (int c = 0; c < panel.m_columns; ++c)
            for (int l = 0; l < lanes; ++l)
                y[place(panel, r) * lanes + l] -=
                    entry(panel, r, c) * y[place(panel, panel.m_rowsBelow + c) * lanes + l];
}

void reference::backwardPanel(const Panel& panel, float* y, int lanes)
{
    const float* own = y + 3 * static_cast<std::size_t>(panel.m_firstNode) * lanes;
    const std::vector<float> before(own, own + static_cast<std::size_t>(panel.m_columns) * lanes);
    for (int c = 0; c < panel.m_columns; ++c)
        for (int l = 0; l < lanes; ++l)
        {
            float sum = 0;
            for (int r = 0; r < panel.m_rowsBelow; ++r) sum -= entry(panel, r, c) * y[place(panel, r) * lanes + l];
            for (int r = 0; r < panel.m_columns; ++r)
                sum += entry(panel, panel.m_rowsBelow + r, c) * before[static_cast<std::size_t>(r) * lanes + l];
            y[place(panel, panel.m_rowsBelow + c) * lanes + l] = sum;
        }
}

}  // namespace bullet_fem
