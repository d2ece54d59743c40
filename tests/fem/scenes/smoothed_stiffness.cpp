// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/smoothed_stiffness.h"

#include <map>
#include <utility>
#include <vector>

#include "fem/factor/block_matrix.h"

namespace bullet_fem
{
namespace
{

using GradientOfNode = std::map<int, Vec3>;  // of a mean displacement gradient: sum over nodes of u_i g_i^T

void addElement(const RestShape& shape, int e, double weight, GradientOfNode& mean)
{
    for (int a = 0; a < 4; ++a) mean[shape.m_mesh.tets()[e][a]] += weight * shapeGradient(shape.m_elements[e], a);
}

// stiffness |dev sym H|^2 / 2 has the derivative stiffness dev sym H : dH, with H = sum of u_i g_i^T: blocks
// stiffness (g_j g_i^T / 2 + g_i . g_j I / 2 - g_i g_j^T / 3).
void addDeviator(double stiffness, const GradientOfNode& mean, std::vector<Eigen::Triplet<double>>& entries)
{
    for (const auto& [i, gi] : mean)
        for (const auto& [j, gj] : mean)
        {
            const Mat3 block =
                0.5 * stiffness * (outer(gj, gi) + Mat3::diagonal(dot(gi, gj))) - stiffness / 3 * outer(gi, gj);
            for (int k = 0; k < 9; ++k) entries.emplace_back(3 * i + k / 3, 3 * j + k % 3, block(k / 3, k % 3));
        }
}

void addDilatation(double stiffness, const GradientOfNode& mean, std::vector<Eigen::Triplet<double>>& entries)
{
    for (const auto& [i, gi] : mean)
        for (const auto& [j, gj] : mean)
            for (int k = 0; k < 9; ++k)
                entries.emplace_back(3 * i + k / 3, 3 * j + k % 3, stiffness * outer(gi, gj)(k / 3, k % 3));
}

}  // namespace

Eigen::SparseMatrix<double> smoothedStiffness(const RestShape& shape)
{
    std::vector<Eigen::Triplet<double>> entries;
    const ElementPatches& patches = shape.m_patches;
    for (int p = 0; p < patches.count(); ++p)
    {
        GradientOfNode mean;
        double bulkVolume = 0;
        for (int k = patches.m_start[p]; k < patches.m_start[p + 1]; ++k)
        {
            const RestElement& element = shape.m_elements[patches.m_element[k]];
            addElement(shape, patches.m_element[k], shape.shareOfPatch(patches.m_element[k]), mean);
            bulkVolume += element.m_lambdaVolume + 2.0 / 3 * element.m_muVolume;
        }
        addDilatation(bulkVolume, mean, entries);
    }
    const EdgeDomains& domains = shape.m_edgeDomains;
    for (int d = 0; d < domains.count(); ++d)
    {
        GradientOfNode mean;
        double muVolume = 0;
        for (int k = domains.m_start[d]; k < domains.m_start[d + 1]; ++k)
        {
            const int e = domains.m_element[k];
            addElement(shape, e, domains.m_weight[k], mean);
            muVolume += domains.m_share[e] / 6 * shape.m_elements[e].m_muVolume;
        }
        addDeviator(2 * muVolume, mean, entries);
    }
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        GradientOfNode own;
        addElement(shape, e, 1, own);
        addDeviator(2 * (1 - domains.m_share[e]) * shape.m_elements[e].m_muVolume, own, entries);
    }
    Eigen::SparseMatrix<double> K(3 * shape.m_mesh.nodeCount(), 3 * shape.m_mesh.nodeCount());
    K.setFromTriplets(entries.begin(), entries.end());
    return K;
}

}  // namespace bullet_fem
