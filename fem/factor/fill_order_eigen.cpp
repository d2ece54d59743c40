// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Ordering without SuiteSparse: a little more fill, no LGPL.
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <string>

#include "fem/factor/fill_order.h"

namespace bullet_fem
{
namespace
{

using EigenSparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

// A view of the lower triangle; a pattern gets ones.
Eigen::Map<const EigenSparse> view(const SparsePattern& A, const std::vector<double>& value)
{
    return {A.m_size,
            A.m_size,
            static_cast<Eigen::Index>(A.m_rowIndex.size()),
            A.m_columnStart.data(),
            A.m_rowIndex.data(),
            value.data()};
}

}  // namespace

const char* orderingBackend()
{
    static const std::string name = "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." +
                                    std::to_string(EIGEN_MAJOR_VERSION) + "." + std::to_string(EIGEN_MINOR_VERSION);
    return name.c_str();
}

std::vector<int> fillReducingOrder(const SparsePattern& pattern, const char*& methodName)
{
    methodName = "AMD";
    const std::vector<double> ones(pattern.m_rowIndex.size(), 1.0);
    const EigenSparse lower = view(pattern, ones);
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(lower.selfadjointView<Eigen::Lower>(), order);
    const int* indices = order.indices().data();
    return std::vector<int>(indices, indices + pattern.m_size);
}

}  // namespace bullet_fem
