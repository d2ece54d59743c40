// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cstddef>
#include <vector>

#include "fem/factor/isotropic_panel_kernels.h"

namespace bullet_fem
{
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

void scalar::forwardIsotropic(const Panel& panel, float* y, int lanes)
{
    const std::size_t size = 3 * static_cast<std::size_t>(lanes);
    for (int r = 0; r < panel.m_rowsBelow; ++r)
        for (int c = 0; c < panel.m_columns; ++c)
            for (std::size_t l = 0; l < size; ++l)
                y[nodeOf(panel, r) * size + l] -= isotropicEntry(panel, r, c) * y[(panel.m_firstNode + c) * size + l];
}

void scalar::backwardIsotropic(const Panel& panel, float* y, int lanes)
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

}  // namespace bullet_fem
