// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/fill_order.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <thread>

#include "fem/scenes/dense_system.h"

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

class FillOrder : public testing::TestWithParam<NamedPattern>
{
};

TEST_P(FillOrder, IsAPermutation)
{
    const char* method = nullptr;
    std::vector<int> order = fillReducingOrder(sparsePattern(GetParam().m_matrix), method);
    EXPECT_THAT(method, AnyOf(StrEq("METIS"), StrEq("AMD")));
    std::sort(order.begin(), order.end());
    std::vector<int> all(GetParam().m_matrix.rows());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(order, all);
}

INSTANTIATE_TEST_SUITE_P(Patterns, FillOrder,
                         testing::Values(NamedPattern{"One", diagonalMatrix(1)},
                                         NamedPattern{"Diagonal", diagonalMatrix(7)},
                                         NamedPattern{"Full", fullMatrix(13)},
                                         NamedPattern{"Tridiagonal", tridiagonalMatrix(20)},
                                         NamedPattern{"Arrow", arrowMatrix(30)}, NamedPattern{"Grid", gridMatrix(6)}),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

// Entries of L: eliminating a row joins all its later neighbours.
long entriesOfFactor(Eigen::MatrixXd A, const std::vector<int>& order)
{
    long entries = 0;
    for (std::size_t k = 0; k < order.size(); ++k)
        for (std::size_t i = k; i < order.size(); ++i)
        {
            if (A(order[i], order[k]) == 0) continue;
            ++entries;
            for (std::size_t j = k + 1; j < order.size(); ++j)
                if (A(order[j], order[k]) != 0 && i > k) A(order[i], order[j]) = 1;
        }
    return entries;
}

// In its own order an arrow fills up; with its tip last it does not fill at all.
TEST(FillOrderOf, AnArrowLeavesItsTipToTheEnd)
{
    constexpr int n = 40;
    std::vector<int> natural(n);
    std::iota(natural.begin(), natural.end(), 0);
    const char* method = nullptr;
    EXPECT_EQ(entriesOfFactor(arrowMatrix(n), natural), n * (n + 1) / 2);
    EXPECT_EQ(entriesOfFactor(arrowMatrix(n), fillReducingOrder(sparsePattern(arrowMatrix(n)), method)), 2 * n - 1);
}

// METIS seeds the C library's one random generator and draws from it.
TEST(FillOrderOf, ConcurrentCallersIsThatOfOne)
{
    const SparsePattern pattern = sparsePattern(gridMatrix(40));
    const char* method = nullptr;
    const std::vector<int> alone = fillReducingOrder(pattern, method);
    std::vector<int> different(4, 0);
    std::vector<std::thread> callers;
    for (int& differences : different)
        callers.emplace_back(
            [&]
            {
                const char* ownMethod = nullptr;
                for (int k = 0; k < 20; ++k) differences += fillReducingOrder(pattern, ownMethod) != alone;
            });
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(different, std::vector<int>(4, 0)) << method;
}

TEST(OrderingBackend, IsNamedWithItsVersion)
{
    EXPECT_THAT(orderingBackend(), AnyOf(StartsWith("CHOLMOD "), StartsWith("Eigen ")));
    EXPECT_THAT(orderingBackend(), HasSubstr("."));
}

}  // namespace
}  // namespace bullet_fem
