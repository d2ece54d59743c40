// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/block_matrix.h"

#include <algorithm>
#include <cassert>

namespace bullet_fem
{
namespace
{

Vec3 shapeGradient(const RestElement& element, int a)
{
    const auto& D = element.m_DmInverse.m;
    if (a > 0) return {D[a - 1][0], D[a - 1][1], D[a - 1][2]};
    return -(shapeGradient(element, 1) + shapeGradient(element, 2) + shapeGradient(element, 3));
}

// Sparsity pattern: nodes that share an element, and the diagonal.
BlockMatrix emptyMatrix(const TetMesh& mesh)
{
    std::vector<std::vector<int>> neighbours(mesh.nodeCount());
    for (int i = 0; i < mesh.nodeCount(); ++i) neighbours[i].push_back(i);  // loose nodes have no more
    for (const Tet& tet : mesh.tets())
        for (int a : tet) neighbours[a].insert(neighbours[a].end(), tet.begin(), tet.end());
    BlockMatrix matrix;
    matrix.m_rowStart.push_back(0);
    for (std::vector<int>& row : neighbours)
    {
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        matrix.m_column.insert(matrix.m_column.end(), row.begin(), row.end());
        matrix.m_rowStart.push_back(static_cast<int>(matrix.m_column.size()));
    }
    matrix.m_block.resize(matrix.m_column.size());
    return matrix;
}

}  // namespace

Mat3& BlockMatrix::at(int row, int column)
{
    const auto begin = m_column.begin() + m_rowStart[row], end = m_column.begin() + m_rowStart[row + 1];
    const auto found = std::lower_bound(begin, end, column);
    assert(found != end && *found == column);
    return m_block[found - m_column.begin()];
}

Mat3 elementStiffnessBlock(const RestElement& element, int a, int b)
{
    const Vec3 ga = shapeGradient(element, a), gb = shapeGradient(element, b);
    return element.m_lambdaVolume * outer(ga, gb) + element.m_muVolume * outer(gb, ga) +
           Mat3::diagonal(element.m_muVolume * dot(ga, gb));
}

BlockMatrix assembleRestStiffness(const RestShape& shape)
{
    BlockMatrix K = emptyMatrix(shape.m_mesh);
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        const Tet& tet = shape.m_mesh.tets()[e];
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) K.at(tet[a], tet[b]) += elementStiffnessBlock(shape.m_elements[e], a, b);
    }
    return K;
}

}  // namespace bullet_fem
