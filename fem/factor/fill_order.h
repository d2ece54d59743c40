// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
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

/// The libraries that fillReducingOrder() chooses from, with their versions: "AMD x.y.z, METIS x.y.z", with Eigen in
/// place of AMD, or without METIS, where a build or a program has none.
std::string orderingBackend();

/// A permutation that keeps a Cholesky factor sparse, and what found it.
struct FillOrder
{
    const char* m_method = "";  ///< AMD, METIS or Eigen
    std::vector<int> m_rows;    ///< entry k is the row of the pattern that comes k-th
};

/// Of METIS's nested dissection and the approximate minimum degree of SuiteSparse's AMD (or of Eigen where there is no
/// AMD) the one with less fill. May be called at the same time on several threads. Throws std::bad_alloc, or
/// std::runtime_error if a library fails.
FillOrder fillReducingOrder(const SparsePattern& pattern);

/// Eigen's approximate minimum degree: entry k is the row that comes k-th.
std::vector<int> eigenOrder(const SparsePattern& pattern);

}  // namespace bullet_fem
