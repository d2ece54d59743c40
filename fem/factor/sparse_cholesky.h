// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

namespace bullet_fem
{

/// A sparse matrix of which the lower triangle is stored, by columns; row indices ascend and the diagonal comes first.
struct SparseLower
{
    int m_size = 0;
    std::vector<int> m_columnStart;  ///< m_size + 1 entries
    std::vector<int> m_rowIndex;
    std::vector<double> m_value;  ///< empty for a pattern
};

/// Name of the library that the two functions below call: "CHOLMOD x.y.z" or "Eigen x.y.z".
const char* sparseCholeskyBackend();

/// A permutation that keeps the Cholesky factor of the pattern sparse: entry k is the row that comes k-th.
/// CHOLMOD tries METIS and AMD and keeps the smaller fill; Eigen has AMD only. The chosen method's name goes to
/// `methodName`. Not thread-safe (METIS draws from the global random generator). Throws std::runtime_error.
std::vector<int> fillReducingOrder(const SparseLower& pattern, const char*& methodName);

/// The factor L of A = L L^T, in A's own order. Throws std::runtime_error if A is not positive definite (CHOLMOD names
/// the column) and std::bad_alloc if memory runs out.
SparseLower choleskyFactor(const SparseLower& A);

}  // namespace bullet_fem
