// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

/// A symmetric dense matrix [A11 A21^T; A21 A22] in three column-major blocks without gaps. Only the lower halves of
/// A11 and A22 are read; the upper halves are overwritten with unspecified values.
struct DenseFront
{
    int m_pivots, m_rows;  ///< sizes of A11 and A22 [scalars], >= 0
    double* m_A11;         ///< m_pivots x m_pivots
    double* m_A21;         ///< m_rows x m_pivots
    double* m_A22;         ///< m_rows x m_rows
};

/// Scratch entries [doubles] of eliminatePivots() for fronts up to these sizes.
std::size_t eliminationScratch(int maxPivots, int maxRows);

/// Partial elimination of A11: A11 <- A11^-1 (both halves), A21 <- A21 A11^-1, A22 <- A22 - A21 A11^-1 A21^T (lower
/// half). Returns -1, or the index of the first pivot that is not positive (or NaN): A is then not positive definite,
/// the blocks are unspecified, and `pivotValue` is that pivot. Vectorised for the present processor.
int eliminatePivots(const DenseFront& front, double* scratch, double& pivotValue);

/// C -= U V^T; U is m x k, V is n x k, C is m x n, all column-major with these column strides.
struct DenseProduct
{
    int m_m, m_n, m_k;
    const double *m_U, *m_V;
    double* m_C;
    int m_strideU, m_strideV, m_strideC;
    bool m_lowerOnly;  ///< skip tiles entirely above the diagonal of C; entries above it are then unspecified
};

/// Scratch entries [doubles] of subtractProduct().
std::size_t productScratch(int m, int n, int k);

/// Computes the product, vectorised for the present processor.
void subtractProduct(const DenseProduct& product, double* scratch);

}  // namespace bullet_fem
