// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

/// Lists of nodes are padded to a multiple of this: no kernel has a rest to do.
constexpr std::size_t kNodePadding = 16;

/// What an impulse on one node does to a list of nodes, before the nodes have turned.
struct RestColumn
{
    const float* m_blocks = nullptr;     ///< (A0^-1)_ij for all surface nodes i, nine values each, row by row
    const int* m_offsets = nullptr;      ///< of every node of the list in m_blocks; padded, any valid one there
    const float* m_rotations = nullptr;  ///< R_i: nine arrays, row by row, of m_padded values; 0 in the padding
    std::size_t m_padded = 0;            ///< length of the list, a multiple of kNodePadding
    std::size_t m_first = 0;             ///< nodes before it are left out; a multiple of kNodePadding
    float m_source[9] = {};              ///< s R_j of the node with the impulse, row by row
};

/// columns_c[3 i + k] = s (R_i (A0^-1)_ij R_j^T)_kc for i in [m_first, m_padded), with columns_c = columns + 3 c
/// m_padded. On the widest vectors that the processor has.
void turnColumn(const RestColumn& column, float* columns);

/// A weighted sum of some arrays.
struct WeightedArrays
{
    const float* const* m_arrays = nullptr;  ///< m_count of them
    const float* m_weights = nullptr;        ///< one each
    int m_count = 0;
};

/// sum_i = sum_k w_k a_ki for i in [0, size), in the order of k; zero where there are none. Likewise.
void addWeighted(const WeightedArrays& arrays, std::size_t size, float* sum);

/// The same in plain C++: what the kernels are tested against.
namespace scalar
{
void turnColumn(const RestColumn& column, float* columns);
void addWeighted(const WeightedArrays& arrays, std::size_t size, float* sum);
}  // namespace scalar

}  // namespace bullet_fem
