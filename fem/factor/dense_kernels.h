// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

/// A symmetric dense matrix [A11 A21^T; A21 A22] in three blocks, each column by column without gaps, of which only
/// the lower halves of A11 and A22 are read. The upper halves are overwritten with anything.
struct DenseFront
{
    int m_pivots, m_rows;  ///< size of A11 and of A22 [scalars], >= 0
    double* m_A11;         ///< m_pivots x m_pivots
    double* m_A21;         ///< m_rows x m_pivots
    double* m_A22;         ///< m_rows x m_rows
};

/// Doubles of scratch that eliminatePivots() needs for fronts up to these sizes.
std::size_t eliminationScratch(int mostPivots, int mostRows);

/// Eliminates A11 from the rest: A11 <- A11^-1 (both halves), A21 <- A21 A11^-1, A22 <- A22 - A21 A11^-1 A21^T (lower
/// half). Returns -1, or the first pivot that is not positive (or not a number): A is then not positive definite, the
/// blocks hold nothing of use, and `pivotValue` is that pivot. Vectorised for the processor it runs on.
int eliminatePivots(const DenseFront& front, double* scratch, double& pivotValue);

/// C -= U V^T; U is m x k, V is n x k, C is m x n, all column by column with these distances between columns.
struct DenseProduct
{
    int m_m, m_n, m_k;
    const double *m_U, *m_V;
    double* m_C;
    int m_strideU, m_strideV, m_strideC;
    bool m_lowerOnly;  ///< skip tiles of C that lie wholly above its diagonal; entries above it are then undefined
};

/// Doubles of scratch that subtractProduct() needs.
std::size_t productScratch(int m, int n, int k);

/// The product above, vectorised for the processor it runs on.
void subtractProduct(const DenseProduct& product, double* scratch);

}  // namespace bullet_fem
