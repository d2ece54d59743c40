// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cstddef>
#include <vector>

#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{
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

void scalar::forwardPanel(const Panel& panel, float* y, int lanes)
{
    for (int r = 0; r < panel.m_rowsBelow; ++r)
        for (int c = 0; c < panel.m_columns; ++c)
            for (int l = 0; l < lanes; ++l)
                y[place(panel, r) * lanes + l] -=
                    entry(panel, r, c) * y[place(panel, panel.m_rowsBelow + c) * lanes + l];
}

void scalar::backwardPanel(const Panel& panel, float* y, int lanes)
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
