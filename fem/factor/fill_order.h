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

/// The library that fillReducingOrder() has for large bodies: "METIS x.y.z", or "Eigen x.y.z" where there is no METIS.
const char* orderingBackend();

/// A permutation that keeps the Cholesky factor of the pattern sparse: entry k is the row that comes k-th.
/// Of METIS's nested dissection and Eigen's approximate minimum degree the one with less fill; its name, METIS or AMD,
/// goes to `methodName`. May be called at the same time on several threads. Throws std::bad_alloc, or
/// std::runtime_error if METIS fails.
std::vector<int> fillReducingOrder(const SparsePattern& pattern, const char*& methodName);

}  // namespace bullet_fem
