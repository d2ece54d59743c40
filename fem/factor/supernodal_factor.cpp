// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/supernodal_factor.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

// Column j + 1 continues the supernode of column j if its pattern is that of column j without the row j itself.
bool continues(const SparseLower& L, int j)
{
    const int start = L.m_columnStart[j], count = L.m_columnStart[j + 1] - start;
    const int nextCount = L.m_columnStart[j + 2] - L.m_columnStart[j + 1];
    return count > 1 && L.m_rowIndex[start + 1] == j + 1 && nextCount == count - 1;
}

}  // namespace

SupernodalFactor::SupernodalFactor(const SparseLower& L)
    : m_size(L.m_size), m_entryCount(static_cast<long>(L.m_rowIndex.size()))
{
    for (int first = 0; first < m_size;)
    {
        int last = first;
        while (last + 1 < m_size && continues(L, last)) ++last;
        Supernode s;
        s.m_firstColumn = first;
        s.m_columns = last - first + 1;
        s.m_rowStart = static_cast<int>(m_rowIndex.size());
        s.m_rows = L.m_columnStart[last + 1] - L.m_columnStart[last] - 1;
        s.m_panelStart = m_panel.size();
        const int* rows = &L.m_rowIndex[L.m_columnStart[last]] + 1;
        m_rowIndex.insert(m_rowIndex.end(), rows, rows + s.m_rows);

        for (int j = first; j <= last; ++j) m_panel.push_back(static_cast<float>(1 / L.m_value[L.m_columnStart[j]]));
        for (int j = first; j <= last; ++j)
            for (int i = j + 1; i <= last; ++i)
                m_panel.push_back(static_cast<float>(L.m_value[L.m_columnStart[j] + i - j]));
        for (int j = first; j <= last; ++j)
            for (int i = 0; i < s.m_rows; ++i)
                m_panel.push_back(static_cast<float>(L.m_value[L.m_columnStart[j] + last - j + 1 + i]));
        m_maxRows = std::max(m_maxRows, s.m_rows);
        m_supernodes.push_back(s);
        first = last + 1;
    }
}

// y_block <- L_block^-1 y_block, then y_below <- y_below - L_below y_block.
template <int Lanes>
void SupernodalFactor::forward(const Supernode& s, float* y, float* scratch) const
{
    const float* inverseDiagonal = &m_panel[s.m_panelStart];
    const float* block = inverseDiagonal + s.m_columns;
    float* yb = y + static_cast<std::size_t>(s.m_firstColumn) * Lanes;
    for (int j = 0; j < s.m_columns; ++j)
    {
        for (int l = 0; l < Lanes; ++l) yb[j * Lanes + l] *= inverseDiagonal[j];
        for (int i = j + 1; i < s.m_columns; ++i, ++block)
            for (int l = 0; l < Lanes; ++l) yb[i * Lanes + l] -= *block * yb[j * Lanes + l];
    }
    if (s.m_rows == 0) return;

    const float* below = block;
    std::fill(scratch, scratch + static_cast<std::size_t>(s.m_rows) * Lanes, 0.f);
    int j = 0;
    for (; j + 3 <= s.m_columns; j += 3, below += 3 * static_cast<std::size_t>(s.m_rows))
    {
        const float *c0 = below, *c1 = c0 + s.m_rows, *c2 = c1 + s.m_rows, *x = yb + j * Lanes;
        for (int i = 0; i < s.m_rows; ++i)
            for (int l = 0; l < Lanes; ++l)
                scratch[i * Lanes + l] += c0[i] * x[l] + c1[i] * x[Lanes + l] + c2[i] * x[2 * Lanes + l];
    }
    for (; j < s.m_columns; ++j, below += s.m_rows)
        for (int i = 0; i < s.m_rows; ++i)
            for (int l = 0; l < Lanes; ++l) scratch[i * Lanes + l] += below[i] * yb[j * Lanes + l];
    const int* row = &m_rowIndex[s.m_rowStart];
    for (int i = 0; i < s.m_rows; ++i)
        for (int l = 0; l < Lanes; ++l) y[static_cast<std::size_t>(row[i]) * Lanes + l] -= scratch[i * Lanes + l];
}

// y_block <- L_block^-T (y_block - L_below^T y_below).
template <int Lanes>
void SupernodalFactor::backward(const Supernode& s, float* y, float* scratch) const
{
    const float* inverseDiagonal = &m_panel[s.m_panelStart];
    const float* block = inverseDiagonal + s.m_columns;
    float* yb = y + static_cast<std::size_t>(s.m_firstColumn) * Lanes;
    if (s.m_rows > 0)
    {
        const float* below = block + s.m_columns * (s.m_columns - 1) / 2;
        const int* row = &m_rowIndex[s.m_rowStart];
        for (int i = 0; i < s.m_rows; ++i)
            for (int l = 0; l < Lanes; ++l) scratch[i * Lanes + l] = y[static_cast<std::size_t>(row[i]) * Lanes + l];
        for (int j = 0; j < s.m_columns; ++j, below += s.m_rows)
        {
            // Several partial sums, so that the compiler may keep them in one register without reordering a sum.
            constexpr int kPartial = Lanes == 1 ? 8 : 2;
            float sum[kPartial][Lanes] = {};
            int i = 0;
            for (; i + kPartial <= s.m_rows; i += kPartial)
                for (int k = 0; k < kPartial; ++k)
                    for (int l = 0; l < Lanes; ++l) sum[k][l] += below[i + k] * scratch[(i + k) * Lanes + l];
            for (; i < s.m_rows; ++i)
                for (int l = 0; l < Lanes; ++l) sum[0][l] += below[i] * scratch[i * Lanes + l];
            for (int k = 0; k < kPartial; ++k)
                for (int l = 0; l < Lanes; ++l) yb[j * Lanes + l] -= sum[k][l];
        }
    }
    const float* blockEnd = block + s.m_columns * (s.m_columns - 1) / 2;
    for (int j = s.m_columns - 1; j >= 0; --j)
    {
        blockEnd -= s.m_columns - 1 - j;
        for (int i = j + 1; i < s.m_columns; ++i)
            for (int l = 0; l < Lanes; ++l) yb[j * Lanes + l] -= blockEnd[i - j - 1] * yb[i * Lanes + l];
        for (int l = 0; l < Lanes; ++l) yb[j * Lanes + l] *= inverseDiagonal[j];
    }
}

template <int Lanes>
void SupernodalFactor::solve(float* y, float* scratch) const
{
    for (const Supernode& s : m_supernodes) forward<Lanes>(s, y, scratch);
    for (auto s = m_supernodes.rbegin(); s != m_supernodes.rend(); ++s) backward<Lanes>(*s, y, scratch);
}

template void SupernodalFactor::solve<1>(float*, float*) const;
template void SupernodalFactor::solve<4>(float*, float*) const;

}  // namespace bullet_fem
