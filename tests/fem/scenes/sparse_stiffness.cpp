// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/sparse_stiffness.h"

#include <vector>

#include "fem/factor/block_matrix.h"

namespace bullet_fem
{

Eigen::SparseMatrix<double> sparseStiffness(const RestShape& shape)
{
    const BlockMatrix blocks = assembleRestStiffness(shape);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < blocks.nodeCount(); ++i)
        for (int b = blocks.m_rowStart[i]; b < blocks.m_rowStart[i + 1]; ++b)
            for (int k = 0; k < 9; ++k)
                entries.emplace_back(3 * i + k / 3, 3 * blocks.m_column[b] + k % 3, blocks.m_block[b](k / 3, k % 3));
    Eigen::SparseMatrix<double> K(3 * blocks.nodeCount(), 3 * blocks.nodeCount());
    K.setFromTriplets(entries.begin(), entries.end());
    return K;
}

}  // namespace bullet_fem
