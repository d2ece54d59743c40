// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/factor/lower_matrix.h"

#include <algorithm>
#include <utility>

namespace bullet_fem
{

LowerMatrix lowerMatrix(const BlockMatrix& A, const std::vector<int>& order)
{
    std::vector<int> place(A.nodeCount(), -1);
    for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
    LowerMatrix lower;
    lower.m_size = 3 * static_cast<int>(order.size());
    lower.m_columnStart.push_back(0);
    std::vector<std::pair<int, const Mat3*>> blocks;
    for (std::size_t k = 0; k < order.size(); ++k)
    {
        // A is symmetric: the blocks of the column are the transposed blocks of the row.
        blocks.clear();
        for (int a = A.m_rowStart[order[k]]; a < A.m_rowStart[order[k] + 1]; ++a)
            if (place[A.m_column[a]] >= static_cast<int>(k)) blocks.push_back({place[A.m_column[a]], &A.m_block[a]});
        std::sort(blocks.begin(), blocks.end());
        for (int c = 0; c < 3; ++c)
        {
            for (const auto& [row, block] : blocks)
                for (int r = row == static_cast<int>(k) ? c : 0; r < 3; ++r)
                {
                    lower.m_row.push_back(3 * row + r);
                    lower.m_value.push_back((*block)(c, r));
                }
            lower.m_columnStart.push_back(static_cast<int>(lower.m_row.size()));
        }
    }
    return lower;
}

}  // namespace bullet_fem
