// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/rest_matrix.h"

#include <algorithm>
#include <utility>

namespace bullet_fem
{

RestMatrix::RestMatrix(const BlockMatrix& A, const std::vector<int>& order, const std::vector<int>& position)
{
    // An upper bound of the entries if nodes are left out.
    const std::size_t half = (A.m_column.size() + order.size()) / 2;
    m_rowStart.reserve(order.size() + 1);
    m_column.reserve(half);
    m_values.reserve(9 * half);
    std::vector<std::pair<int, int>> row;  // column, block of A
    for (std::size_t k = 0; k < order.size(); ++k)
    {
        row.clear();
        for (int b = A.m_rowStart[order[k]]; b < A.m_rowStart[order[k] + 1]; ++b)
        {
            const int column = position[A.m_column[b]];
            if (column >= 0 && column <= static_cast<int>(k)) row.emplace_back(column, b);
        }
        std::sort(row.begin(), row.end());
        for (const auto& [column, b] : row)
        {
            m_column.push_back(column);
            for (int i = 0; i < 9; ++i) m_values.push_back(static_cast<float>(A.m_block[b](i / 3, i % 3)));
        }
        m_rowStart.push_back(static_cast<int>(m_column.size()));
    }
    m_column.shrink_to_fit();
    m_values.shrink_to_fit();
}

std::size_t RestMatrix::byteCount() const
{
    return sizeof(int) * (m_rowStart.size() + m_column.size()) + sizeof(float) * m_values.size();
}

}  // namespace bullet_fem
