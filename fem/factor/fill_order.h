// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

namespace bullet_fem
{

/// Where a symmetric matrix has entries: the lower triangle by columns; row indices ascend and the diagonal comes
/// first.
struct SparsePattern
{
    int m_size = 0;
    std::vector<int> m_columnStart;  ///< m_size + 1 entries
    std::vector<int> m_rowIndex;
};

/// Name of the library that fillReducingOrder() calls: "CHOLMOD x.y.z" or "Eigen x.y.z".
const char* orderingBackend();

/// A permutation that keeps the Cholesky factor of the pattern sparse: entry k is the row that comes k-th.
/// CHOLMOD tries METIS and AMD and keeps the smaller fill; Eigen has AMD only. The chosen method's name goes to
/// `methodName`. Not thread-safe (METIS draws from the global random generator). Throws std::runtime_error.
std::vector<int> fillReducingOrder(const SparsePattern& pattern, const char*& methodName);

}  // namespace bullet_fem
