// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/block_matrix.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <utility>

namespace bullet_fem
{
namespace
{

double bulkVolumeOf(const RestElement& element)
{
    return element.m_lambdaVolume + 2.0 / 3 * element.m_muVolume;
}

void addNodes(const std::vector<int>& from, std::vector<int>& to)
{
    to.insert(to.end(), from.begin(), from.end());
}

/// The nodes of a patch, ascending.
std::vector<int> nodesOf(const RestShape& shape, int patch)
{
    const ElementPatches& patches = shape.m_patches;
    std::vector<int> nodes;
    for (int k = patches.m_start[patch]; k < patches.m_start[patch + 1]; ++k)
        for (const int node : shape.m_mesh.tets()[patches.m_element[k]]) nodes.push_back(node);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

// Sparsity pattern: nodes that share an element or a patch, and the diagonal.
BlockMatrix emptyMatrix(const RestShape& shape)
{
    const TetMesh& mesh = shape.m_mesh;
    std::vector<std::vector<int>> neighbours(mesh.nodeCount());
    for (int i = 0; i < mesh.nodeCount(); ++i) neighbours[i].push_back(i);  // loose nodes have only this
    for (const Tet& tet : mesh.tets())
        for (int a : tet) neighbours[a].insert(neighbours[a].end(), tet.begin(), tet.end());
    for (int p = 0; p < shape.m_patches.count(); ++p)
    {
        const std::vector<int> nodes = nodesOf(shape, p);
        for (int i : nodes) addNodes(nodes, neighbours[i]);
    }
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

/// Strains with doubled shears that a patch's nodal displacements cause, one for each component of each node.
using NodalStrains = std::vector<std::array<double, 6>>;

/// Strain of element e for the displacement u of a node.
SymmetricTensor strainOfNode(const RestShape& shape, int e, int node, const Vec3& u)
{
    const Tet& tet = shape.m_mesh.tets()[e];
    const auto at = std::find(tet.begin(), tet.end(), node);
    if (at == tet.end()) return {};
    return symmetricPart(outer(u, shapeGradient(shape.m_elements[e], static_cast<int>(at - tet.begin()))));
}

// Adds V B^T C B.
void addProducts(const std::vector<int>& nodes, const NodalStrains& B, const ElasticMatrix& C, double volume,
                 BlockMatrix& K)
{
    for (std::size_t column = 0; column < B.size(); ++column)
    {
        std::array<double, 6> stress = {};
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) stress[i] += volume * C(i, j) * B[column][j];
        for (std::size_t row = 0; row < B.size(); ++row)
            K.at(nodes[row / 3], nodes[column / 3])(row % 3, column % 3) +=
                std::inner_product(stress.begin(), stress.end(), B[row].begin(), 0.0);
    }
}

// Adds V B~^T C B~ of every element, B~ = B_p + H_p (B_e - B_p) with the mean B_p over the patch (AssumedStrain).
void addAssumed(const RestShape& shape, BlockMatrix& K)
{
    const ElementPatches& patches = shape.m_patches;
    for (int p = 0; p < patches.count(); ++p)
    {
        const std::vector<int> nodes = nodesOf(shape, p);
        const int *element = &patches.m_element[patches.m_start[p]], count = patches.size(p);
        double share[ElementPatches::kMax];
        for (int k = 0; k < count; ++k) share[k] = shape.shareOfPatch(element[k]);
        std::vector<NodalStrains> B(count, NodalStrains(3 * nodes.size()));
        for (std::size_t column = 0; column < 3 * nodes.size(); ++column)
        {
            const Vec3 u = {column % 3 == 0 ? 1.0 : 0.0, column % 3 == 1 ? 1.0 : 0.0, column % 3 == 2 ? 1.0 : 0.0};
            SymmetricTensor strain[ElementPatches::kMax];
            for (int k = 0; k < count; ++k) strain[k] = strainOfNode(shape, element[k], nodes[column / 3], u);
            shape.m_assumedStrain.assume(p, count, share, strain);
            for (int k = 0; k < count; ++k)
            {
                const SymmetricTensor& s = strain[k];
                B[k][column] = {s.xx, s.yy, s.zz, 2 * s.yz, 2 * s.xz, 2 * s.xy};
            }
        }
        for (int k = 0; k < count; ++k)
        {
            const RestElement& rest = shape.m_elements[element[k]];
            const LameModuli moduli = {rest.m_muVolume / rest.m_volume, rest.m_lambdaVolume / rest.m_volume};
            addProducts(nodes, B[k], shape.isOrthotropic() ? shape.stiffnessOf(element[k]) : isotropicStiffness(moduli),
                        rest.m_volume, K);
        }
    }
}

// Adds (lambda + 2/3 mu) V G_i G_j^T of every patch.
void addPatches(const RestShape& shape, BlockMatrix& K)
{
    const ElementPatches& patches = shape.m_patches;
    for (int p = 0; p < patches.count(); ++p)
    {
        const std::vector<int> nodes = nodesOf(shape, p);
        std::vector<Vec3> G(nodes.size());
        double bulkVolume = 0;
        for (int k = patches.m_start[p]; k < patches.m_start[p + 1]; ++k)
        {
            const int e = patches.m_element[k];
            bulkVolume += bulkVolumeOf(shape.m_elements[e]);
            for (int a = 0; a < 4; ++a)
            {
                const auto i = std::lower_bound(nodes.begin(), nodes.end(), shape.m_mesh.tets()[e][a]) - nodes.begin();
                G[i] += shape.shareOfPatch(e) * shapeGradient(shape.m_elements[e], a);
            }
        }
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (std::size_t j = 0; j < nodes.size(); ++j) K.at(nodes[i], nodes[j]) += bulkVolume * outer(G[i], G[j]);
    }
}

}  // namespace

Vec3 shapeGradient(const RestElement& element, int a)
{
    const auto& D = element.m_DmInverse.m;
    if (a > 0) return {D[a - 1][0], D[a - 1][1], D[a - 1][2]};
    return -(shapeGradient(element, 1) + shapeGradient(element, 2) + shapeGradient(element, 3));
}

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

Mat3 elementStiffnessBlock(const RestElement& element, const ElasticMatrix& C, int a, int b)
{
    // (K_ab)_ij = V sum over k, l of g_ak C_kilj g_bl
    constexpr int kVoigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    const Vec3 ga = shapeGradient(element, a), gb = shapeGradient(element, b);
    Mat3 K;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l) K(i, j) += element.m_volume * ga[k] * C(kVoigt[k][i], kVoigt[l][j]) * gb[l];
    return K;
}

BlockMatrix assembleRestStiffness(const RestShape& shape)
{
    BlockMatrix K = emptyMatrix(shape);
    if (!shape.m_assumedStrain.empty()) return addAssumed(shape, K), K;
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        const Tet& tet = shape.m_mesh.tets()[e];
        RestElement element = shape.m_elements[e];
        if (!shape.m_patches.empty()) element.m_lambdaVolume -= bulkVolumeOf(element);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                K.at(tet[a], tet[b]) += shape.isOrthotropic()
                                            ? elementStiffnessBlock(element, shape.stiffnessOf(e), a, b)
                                            : elementStiffnessBlock(element, a, b);
    }
    addPatches(shape, K);
    return K;
}

RestMatrix::RestMatrix(const BlockMatrix& A, const std::vector<int>& order, const std::vector<int>& position)
{
    // An upper bound of the entries if nodes are left out.
    const std::size_t half = (A.m_column.size() + order.size()) / 2;
    m_rowStart.reserve(order.size() + 1);
    m_column.reserve(half);
    m_values.reserve(9 * half);
    std::vector<std::pair<int, int>> row;  // column, block of A
    for (std::size_t k = 0; k < order.size(); ++k)
    {
        row.clear();
        for (int b = A.m_rowStart[order[k]]; b < A.m_rowStart[order[k] + 1]; ++b)
        {
            const int column = position[A.m_column[b]];
            if (column >= 0 && column <= static_cast<int>(k)) row.emplace_back(column, b);
        }
        std::sort(row.begin(), row.end());
        for (const auto& [column, b] : row)
        {
            m_column.push_back(column);
            for (int i = 0; i < 9; ++i) m_values.push_back(static_cast<float>(A.m_block[b](i / 3, i % 3)));
        }
        m_rowStart.push_back(static_cast<int>(m_column.size()));
    }
    m_column.shrink_to_fit();
    m_values.shrink_to_fit();
}

std::size_t RestMatrix::byteCount() const
{
    return sizeof(int) * (m_rowStart.size() + m_column.size()) + sizeof(float) * m_values.size();
}

}  // namespace bullet_fem
