// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

/// Values per column of a rotation: three and one of padding.
constexpr std::size_t kColumnOfRotation = 4;

/// Response of a list of nodes to an impulse on one node, before rotation.
struct RestColumn
{
    const float* m_blocks = nullptr;     ///< (A0^-1)_ij for all surface nodes i, nine values each, row by row
    const int* m_offsets = nullptr;      ///< offset of every node of the list in m_blocks
    const float* m_rotations = nullptr;  ///< R_i of every node of the list: three columns of kColumnOfRotation values
    std::size_t m_first = 0;             ///< first node of the range
    std::size_t m_end = 0;               ///< end of the range
    std::size_t m_stride = 0;            ///< stride of the columns, >= 3 m_end
    float m_source[9] = {};              ///< s R_j of the node with the impulse, row by row
};

/// columns_c[3 i + k] = s (R_i (A0^-1)_ij R_j^T)_kc for i in [m_first, m_end), with columns_c = columns + c m_stride.
/// On vectors of four values.
void turnColumn(const RestColumn& column, float* columns);

/// Reference in plain C++, against which the kernel is tested.
namespace scalar
{
void turnColumn(const RestColumn& column, float* columns);
}  // namespace scalar

}  // namespace bullet_fem
