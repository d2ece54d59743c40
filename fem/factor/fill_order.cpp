// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/fill_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <string>

#include "fem/factor/ordering_libraries.h"
#include "fem/factor/supernode_tree.h"

namespace bullet_fem
{
std::vector<int> eigenOrder(const SparsePattern& pattern)
{
    using EigenSparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
    const std::vector<double> ones(pattern.m_rowIndex.size(), 1.0);
    const Eigen::Map<const EigenSparse> lower(pattern.m_size, pattern.m_size,
                                              static_cast<Eigen::Index>(pattern.m_rowIndex.size()),
                                              pattern.m_columnStart.data(), pattern.m_rowIndex.data(), ones.data());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(lower.selfadjointView<Eigen::Lower>(), order);
    const int* indices = order.indices().data();
    return std::vector<int>(indices, indices + pattern.m_size);
}

std::string orderingBackend()
{
    std::string names = amdVersion();
    if (names.empty())
        names = "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
                std::to_string(EIGEN_MINOR_VERSION);
    return metisVersion().empty() ? names : names + ", " + metisVersion();
}

FillOrder fillReducingOrder(const SparsePattern& pattern)
{
    FillOrder minimumDegree = {"AMD", amdOrder(pattern)}, dissection = {"METIS", metisOrder(pattern)};
    if (minimumDegree.m_rows.empty()) minimumDegree = {"Eigen", eigenOrder(pattern)};
    const bool dissect = !dissection.m_rows.empty() &&
                         blocksOfFactor(pattern, dissection.m_rows) <= blocksOfFactor(pattern, minimumDegree.m_rows);
    return dissect ? dissection : minimumDegree;
}

}  // namespace bullet_fem
