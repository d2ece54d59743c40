// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/rest_factor.h"

#include <algorithm>

#include "fem/factor/block_matrix.h"

namespace bullet_fem
{
namespace
{

// A0 = (1 + h alpha) M + (h^2 + h beta) K.
BlockMatrix assembleA0(const RestShape& shape, const FactorInput& input)
{
    const double h = input.m_step, alpha = shape.m_material.m_massDamping, beta = shape.m_material.m_stiffnessDamping;
    BlockMatrix A0 = assembleRestStiffness(shape);
    for (Mat3& block : A0.m_block) block *= h * h + h * beta;
    for (int i = 0; i < A0.nodeCount(); ++i) A0.at(i, i) += Mat3::diagonal((1 + h * alpha) * input.m_mass[i]);
    return A0;
}

// The lower triangle of the block pattern, with nodes renumbered; position -1 leaves a node out.
SparseLower blockPattern(const BlockMatrix& A, const std::vector<int>& nodeAt, const std::vector<int>& position)
{
    SparseLower pattern;
    pattern.m_size = static_cast<int>(nodeAt.size());
    pattern.m_columnStart.push_back(0);
    for (int c = 0; c < pattern.m_size; ++c)
    {
        const int node = nodeAt[c];
        const auto columnBegin = pattern.m_rowIndex.size();
        for (int k = A.m_rowStart[node]; k < A.m_rowStart[node + 1]; ++k)
            if (position[A.m_column[k]] >= c) pattern.m_rowIndex.push_back(position[A.m_column[k]]);
        std::sort(pattern.m_rowIndex.begin() + columnBegin, pattern.m_rowIndex.end());
        pattern.m_columnStart.push_back(static_cast<int>(pattern.m_rowIndex.size()));
    }
    return pattern;
}

// The lower triangle of A in the factor's order, by scalars.
SparseLower permutedLower(const BlockMatrix& A, const std::vector<int>& nodeAt, const std::vector<int>& position)
{
    const SparseLower blocks = blockPattern(A, nodeAt, position);
    SparseLower lower;
    lower.m_size = 3 * blocks.m_size;
    lower.m_columnStart.push_back(0);
    for (int c = 0; c < lower.m_size; ++c)
    {
        for (int k = blocks.m_columnStart[c / 3]; k < blocks.m_columnStart[c / 3 + 1]; ++k)
        {
            const int blockRow = blocks.m_rowIndex[k];
            const Mat3& block = A.at(nodeAt[blockRow], nodeAt[c / 3]);
            for (int i = 0; i < 3; ++i)
            {
                if (3 * blockRow + i < c) continue;
                lower.m_rowIndex.push_back(3 * blockRow + i);
                lower.m_value.push_back(block(i, c % 3));
            }
        }
        lower.m_columnStart.push_back(static_cast<int>(lower.m_rowIndex.size()));
    }
    return lower;
}

}  // namespace

RestFactor::RestFactor(const RestShape& shape, const FactorInput& input, FactorReport& report)
{
    const BlockMatrix A0 = assembleA0(shape, input);
    const int n = shape.m_mesh.nodeCount();
    std::vector<int> freeNodes;
    m_position.assign(n, -1);
    m_diagonal.resize(n);
    for (int i = 0; i < n; ++i)
    {
        m_diagonal[i] = trace(A0.at(i, i)) / 3;
        if (input.m_fixed[i]) continue;
        m_position[i] = static_cast<int>(freeNodes.size());
        freeNodes.push_back(i);
    }
    report.m_backend = sparseCholeskyBackend();
    if (freeNodes.empty()) return;

    const char* ordering = "";
    const std::vector<int> order = fillReducingOrder(blockPattern(A0, freeNodes, m_position), ordering);
    std::vector<int> nodeAt(order.size());
    for (std::size_t k = 0; k < order.size(); ++k)
    {
        nodeAt[k] = freeNodes[order[k]];
        m_position[nodeAt[k]] = static_cast<int>(k);
    }
    m_lower = SupernodalFactor(choleskyFactor(permutedLower(A0, nodeAt, m_position)));
    report.m_ordering = ordering;
    report.m_entries = m_lower.entryCount();
    report.m_supernodes = m_lower.supernodeCount();
}

}  // namespace bullet_fem
