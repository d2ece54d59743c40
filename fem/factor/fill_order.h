// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

namespace bullet_fem
{

/// Sparsity pattern of a symmetric matrix: the lower triangle in compressed column storage; row indices ascend,
/// starting with the diagonal.
struct SparsePattern
{
    int m_size = 0;
    std::vector<int> m_columnStart;  ///< m_size + 1 entries
    std::vector<int> m_rowIndex;
};

/// The graph of a pattern, both triangles without the diagonal: the neighbours of row i from m_start[i] to m_start[i +
/// 1].
template <class Index>
struct PatternGraph
{
    explicit PatternGraph(const SparsePattern& pattern) : m_start(pattern.m_size + 1, 0)
    {
        const auto forEdges = [&pattern](const auto& visit)
        {
            for (int c = 0; c < pattern.m_size; ++c)
                for (int k = pattern.m_columnStart[c]; k < pattern.m_columnStart[c + 1]; ++k)
                    if (pattern.m_rowIndex[k] != c) visit(pattern.m_rowIndex[k], c);
        };
        forEdges([this](int a, int b) { ++m_start[a + 1], ++m_start[b + 1]; });
        for (int i = 0; i < pattern.m_size; ++i) m_start[i + 1] += m_start[i];
        m_neighbour.resize(m_start.back());
        std::vector<Index> end(m_start.begin(), m_start.end() - 1);
        forEdges([&](int a, int b) { m_neighbour[end[a]++] = b, m_neighbour[end[b]++] = a; });
    }

    std::vector<Index> m_start, m_neighbour;
};

/// The libraries that fillReducingOrder() uses, with their versions: "AMD x.y.z, METIS x.y.z"; Eigen replaces AMD, and
/// METIS is missing, if a build or program lacks them.
std::string orderingBackend();

/// A fill-reducing elimination order, and the method that found it.
struct FillOrder
{
    const char* m_method = "";  ///< AMD, METIS or Eigen
    std::vector<int> m_rows;    ///< entry k is the row of the pattern eliminated k-th
};

/// The order with less fill of METIS's nested dissection [Karypis & Kumar 1998] and SuiteSparse's approximate minimum
/// degree [Amestoy et al. 1996] (Eigen's without AMD). Thread-safe. Allocates. Throws std::bad_alloc, or
/// std::runtime_error if a library fails.
FillOrder fillReducingOrder(const SparsePattern& pattern);

/// Eigen's approximate minimum degree order: entry k is the row eliminated k-th.
std::vector<int> eigenOrder(const SparsePattern& pattern);

}  // namespace bullet_fem
