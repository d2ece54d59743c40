// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/fill_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <string>

#include "fem/factor/nested_dissection.h"
#include "fem/factor/supernode_tree.h"

namespace bullet_fem
{
namespace
{

std::vector<int> minimumDegreeOrder(const SparsePattern& pattern)
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

}  // namespace

const char* orderingBackend()
{
    static const std::string eigen = "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." +
                                     std::to_string(EIGEN_MAJOR_VERSION) + "." + std::to_string(EIGEN_MINOR_VERSION);
    const char* metis = nestedDissectionLibrary();
    return metis ? metis : eigen.c_str();
}

std::vector<int> fillReducingOrder(const SparsePattern& pattern, const char*& methodName)
{
    std::vector<int> amd = minimumDegreeOrder(pattern), metis = nestedDissectionOrder(pattern);
    const bool useAmd = metis.empty() || blocksOfFactor(pattern, amd) < blocksOfFactor(pattern, metis);
    methodName = useAmd ? "AMD" : "METIS";
    return useAmd ? amd : metis;
}

}  // namespace bullet_fem
