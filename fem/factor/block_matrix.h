// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

/// A symmetric matrix of 3x3 blocks, one block row a node, in compressed row storage; both triangles are stored,
/// columns ascend.
struct BlockMatrix
{
    std::vector<int> m_rowStart;  ///< node count + 1 entries
    std::vector<int> m_column;
    std::vector<Mat3> m_block;

    int nodeCount() const { return static_cast<int>(m_rowStart.size()) - 1; }
    Mat3& at(int row, int column);
    const Mat3& at(int row, int column) const { return const_cast<BlockMatrix*>(this)->at(row, column); }
};

/// Shape gradient g_a of an element's node a in 0..3 [1/m].
Vec3 shapeGradient(const RestElement& element, int a);

/// The 3x3 block K_ab = V (lambda g_a g_b^T + mu g_b g_a^T + mu (g_a . g_b) I) of an element's rest stiffness K_e = V
/// B^T C B [N/m], nodes a, b in 0..3.
Mat3 elementStiffnessBlock(const RestElement& element, int a, int b);

/// The 3x3 block K_ab = V B_a^T C B_b of the rest stiffness for a general C [N/m], nodes a, b in 0..3.
Mat3 elementStiffnessBlock(const RestElement& element, const ElasticMatrix& C, int a, int b);

/// Assembles the rest stiffness K [N/m] over all nodes. For patches of mean dilatation, (lambda + 2/3 mu) V G_i G_j^T
/// replaces the elements' own volumetric stiffness, with G_i = sum of V_e / V g_a over the elements of a patch of
/// volume V at node i.
BlockMatrix assembleRestStiffness(const RestShape& shape);

/// The lower half of a symmetric block matrix over the nodes of a factor, in the factor's order and in single
/// precision, for iterations with a factor of another matrix. Constant once built.
struct RestMatrix
{
    RestMatrix() = default;

    /// Row k is node order[k] of A; `position` is a node's row, or -1 for nodes to leave out. Allocates.
    RestMatrix(const BlockMatrix& A, const std::vector<int>& order, const std::vector<int>& position);

    int nodeCount() const { return static_cast<int>(m_rowStart.size()) - 1; }
    std::size_t byteCount() const;

    std::vector<int> m_rowStart = {0};  ///< start of each row, then the end
    std::vector<int> m_column;          ///< ascending; the last entry of a row is the diagonal
    std::vector<float> m_values;        ///< nine per block, row-major
};

}  // namespace bullet_fem
