// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Ordering and factorization without SuiteSparse: slower to set up, the same at run time.
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <stdexcept>
#include <string>

#include "fem/factor/sparse_cholesky.h"

namespace bullet_fem
{
namespace
{

using EigenSparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

// A view of the lower triangle; a pattern gets ones.
Eigen::Map<const EigenSparse> view(const SparseLower& A, const std::vector<double>& value)
{
    return {A.m_size,
            A.m_size,
            static_cast<Eigen::Index>(A.m_rowIndex.size()),
            A.m_columnStart.data(),
            A.m_rowIndex.data(),
            value.data()};
}

}  // namespace

const char* sparseCholeskyBackend()
{
    static const std::string name = "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." +
                                    std::to_string(EIGEN_MAJOR_VERSION) + "." + std::to_string(EIGEN_MINOR_VERSION);
    return name.c_str();
}

std::vector<int> fillReducingOrder(const SparseLower& pattern, const char*& methodName)
{
    methodName = "AMD";
    const std::vector<double> ones(pattern.m_rowIndex.size(), 1.0);
    const EigenSparse lower = view(pattern, ones);
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(lower.selfadjointView<Eigen::Lower>(), order);
    const int* indices = order.indices().data();
    return std::vector<int>(indices, indices + pattern.m_size);
}

SparseLower choleskyFactor(const SparseLower& A)
{
    const EigenSparse matrix = view(A, A.m_value);
    const Eigen::SimplicialLLT<EigenSparse, Eigen::Lower, Eigen::NaturalOrdering<int>> llt(matrix);
    if (llt.info() != Eigen::Success)
        throw std::runtime_error("the matrix of size " + std::to_string(A.m_size) + " is not positive definite");
    const EigenSparse& factor = llt.matrixL().nestedExpression();
    SparseLower L;
    L.m_size = A.m_size;
    L.m_columnStart.assign(factor.outerIndexPtr(), factor.outerIndexPtr() + A.m_size + 1);
    L.m_rowIndex.assign(factor.innerIndexPtr(), factor.innerIndexPtr() + factor.nonZeros());
    L.m_value.assign(factor.valuePtr(), factor.valuePtr() + factor.nonZeros());
    return L;
}

}  // namespace bullet_fem
