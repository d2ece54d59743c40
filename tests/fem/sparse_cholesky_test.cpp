// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/sparse_cholesky.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "fem/dense_system.h"

namespace bullet_fem
{
namespace
{

using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::StrEq;

struct NamedPattern
{
    const char* m_name;
    Eigen::MatrixXd m_matrix;
};

void PrintTo(const NamedPattern& pattern, std::ostream* out)
{
    *out << pattern.m_name;
}

std::string nameOf(const testing::TestParamInfo<NamedPattern>& info)
{
    return info.param.m_name;
}

class SparseCholesky : public testing::TestWithParam<NamedPattern>
{
protected:
    const Eigen::MatrixXd& A() const { return GetParam().m_matrix; }
};

TEST_P(SparseCholesky, FactorTimesItsTransposeIsA)
{
    const Eigen::MatrixXd L = denseLower(choleskyFactor(sparseLower(A())));
    EXPECT_LE((L * L.transpose() - A()).norm(), 1e-14 * A().norm());
    EXPECT_GT(L.diagonal().minCoeff(), 0);
}

// What the packing relies on: the diagonal first, rows ascending, and every column's pattern contained in that of the
// column of its first row below the diagonal.
TEST_P(SparseCholesky, FactorHasTheFormOfAnEliminationTree)
{
    const SparseLower L = choleskyFactor(sparseLower(A()));
    ASSERT_EQ(L.m_size, A().rows());
    ASSERT_EQ(L.m_columnStart.size(), static_cast<std::size_t>(L.m_size + 1));
    ASSERT_EQ(L.m_rowIndex.size(), L.m_value.size());
    ASSERT_EQ(L.m_rowIndex.size(), static_cast<std::size_t>(L.m_columnStart.back()));
    for (int j = 0; j < L.m_size; ++j)
    {
        const auto begin = L.m_rowIndex.begin() + L.m_columnStart[j],
                   end = L.m_rowIndex.begin() + L.m_columnStart[j + 1];
        ASSERT_LT(begin, end) << j;
        EXPECT_EQ(*begin, j);
        EXPECT_TRUE(std::is_sorted(begin, end)) << j;
        const int parent = begin + 1 < end ? begin[1] : j;
        EXPECT_TRUE(std::includes(L.m_rowIndex.begin() + L.m_columnStart[parent],
                                  L.m_rowIndex.begin() + L.m_columnStart[parent + 1], std::min(begin + 1, end), end))
            << j;
    }
}

TEST_P(SparseCholesky, OrderIsAPermutation)
{
    SparseLower pattern = sparseLower(A());
    pattern.m_value.clear();
    const char* method = nullptr;
    std::vector<int> order = fillReducingOrder(pattern, method);
    EXPECT_THAT(method, AnyOf(StrEq("METIS"), StrEq("AMD")));
    std::sort(order.begin(), order.end());
    std::vector<int> all(A().rows());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(order, all);
}

INSTANTIATE_TEST_SUITE_P(Patterns, SparseCholesky,
                         testing::Values(NamedPattern{"One", diagonalMatrix(1)},
                                         NamedPattern{"Diagonal", diagonalMatrix(7)},
                                         NamedPattern{"Full", fullMatrix(13)},
                                         NamedPattern{"Tridiagonal", tridiagonalMatrix(20)},
                                         NamedPattern{"Arrow", arrowMatrix(30)}, NamedPattern{"Grid", gridMatrix(6)}),
                         nameOf);

TEST(SparseCholeskyByHand, TwoByTwo)
{
    Eigen::MatrixXd A(2, 2);
    A << 4, 2, 2, 5;
    const SparseLower L = choleskyFactor(sparseLower(A));
    EXPECT_EQ(L.m_rowIndex, (std::vector<int>{0, 1, 1}));
    ASSERT_EQ(L.m_value.size(), 3u);
    EXPECT_DOUBLE_EQ(L.m_value[0], 2);
    EXPECT_DOUBLE_EQ(L.m_value[1], 1);
    EXPECT_DOUBLE_EQ(L.m_value[2], 2);
}

// In its own order an arrow fills up; with its tip last it does not fill at all.
TEST(SparseCholeskyOrder, AvoidsTheFillOfAnArrow)
{
    constexpr int n = 40;
    const Eigen::MatrixXd A = arrowMatrix(n);
    EXPECT_EQ(choleskyFactor(sparseLower(A)).m_rowIndex.size(), n * (n + 1) / 2u);
    const char* method = nullptr;
    const std::vector<int> order = fillReducingOrder(sparseLower(A), method);
    Eigen::MatrixXd reordered(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) reordered(i, j) = A(order[i], order[j]);
    EXPECT_EQ(choleskyFactor(sparseLower(reordered)).m_rowIndex.size(), 2 * n - 1u);
}

std::string failure(const Eigen::MatrixXd& A)
{
    try
    {
        choleskyFactor(sparseLower(A));
    }
    catch (const std::runtime_error& error)
    {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(SparseCholeskyErrors, MatricesThatAreNotPositiveDefinite)
{
    Eigen::MatrixXd A = tridiagonalMatrix(6);
    A(3, 3) = -1;
    EXPECT_THAT(failure(A), HasSubstr("not positive definite"));
    EXPECT_THAT(failure(A), HasSubstr(" 6"));  // its size
    EXPECT_THAT(failure(Eigen::MatrixXd::Zero(2, 2)), HasSubstr("not positive definite"));
    Eigen::MatrixXd last = diagonalMatrix(5);
    last(4, 4) = -1e-3;
    EXPECT_THAT(failure(last), HasSubstr("not positive definite"));
}

TEST(SparseCholeskyBackend, IsNamedWithItsVersion)
{
    EXPECT_THAT(sparseCholeskyBackend(), AnyOf(StartsWith("CHOLMOD "), StartsWith("Eigen ")));
    EXPECT_THAT(sparseCholeskyBackend(), HasSubstr("."));
}

}  // namespace
}  // namespace bullet_fem
