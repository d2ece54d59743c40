// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/fill_order.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <thread>

#include "fem/factor/nested_dissection.h"
#include "fem/factor/supernode_tree.h"
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

// In every order of a matrix, not only in good ones.
TEST_P(FillOrder, BlocksOfTheFactorAreCountedAsEliminationMakesThem)
{
    const Eigen::MatrixXd& A = GetParam().m_matrix;
    const SparsePattern pattern = sparsePattern(A);
    const char* method = nullptr;
    std::vector<int> order(A.rows());
    std::iota(order.begin(), order.end(), 0);
    EXPECT_EQ(blocksOfFactor(pattern, order), entriesOfFactor(A, order));
    std::mt19937 generator(7);
    std::shuffle(order.begin(), order.end(), generator);
    EXPECT_EQ(blocksOfFactor(pattern, order), entriesOfFactor(A, order));
    order = fillReducingOrder(pattern, method);
    EXPECT_EQ(blocksOfFactor(pattern, order), entriesOfFactor(A, order));
}

INSTANTIATE_TEST_SUITE_P(Patterns, FillOrder,
                         testing::Values(NamedPattern{"One", diagonalMatrix(1)},
                                         NamedPattern{"Diagonal", diagonalMatrix(7)},
                                         NamedPattern{"Full", fullMatrix(13)},
                                         NamedPattern{"Tridiagonal", tridiagonalMatrix(20)},
                                         NamedPattern{"Arrow", arrowMatrix(30)}, NamedPattern{"Grid", gridMatrix(6)}),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

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

// Nodes of a box of cells: neighbours share a cell.
SparsePattern boxPattern(int nx, int ny, int nz)
{
    const auto at = [=](int i, int j, int k) { return (k * ny + j) * nx + i; };
    SparsePattern pattern;
    pattern.m_size = nx * ny * nz;
    pattern.m_columnStart.push_back(0);
    for (int c = 0; c < pattern.m_size; ++c)
    {
        const int i = c % nx, j = c / nx % ny, k = c / (nx * ny);
        for (int dk = 0; dk <= 1; ++dk)
            for (int dj = -1; dj <= 1; ++dj)
                for (int di = -1; di <= 1; ++di)
                {
                    const bool inside = i + di >= 0 && i + di < nx && j + dj >= 0 && j + dj < ny && k + dk < nz;
                    const int row = at(i + di, j + dj, k + dk);
                    if (inside && row >= c) pattern.m_rowIndex.push_back(row);
                }
        pattern.m_columnStart.push_back(static_cast<int>(pattern.m_rowIndex.size()));
    }
    return pattern;
}

// Dissection wins in a cube, the minimum degree in a long bar.
TEST(FillOrderOf, ABoxIsTheOneWithLessFill)
{
    if (!nestedDissectionLibrary()) GTEST_SKIP() << "no METIS in this build";
    const SparsePattern cube = boxPattern(10, 10, 10), bar = boxPattern(60, 3, 3);
    const char *ofCube = nullptr, *ofBar = nullptr;
    EXPECT_EQ(fillReducingOrder(cube, ofCube), nestedDissectionOrder(cube));
    EXPECT_STREQ(ofCube, "METIS");
    const long blocks = blocksOfFactor(bar, fillReducingOrder(bar, ofBar));
    EXPECT_STREQ(ofBar, "AMD");
    EXPECT_LT(blocks, blocksOfFactor(bar, nestedDissectionOrder(bar)));
}

TEST(OrderingBackend, IsNamedWithItsVersion)
{
    EXPECT_THAT(orderingBackend(), AnyOf(StartsWith("METIS "), StartsWith("Eigen ")));
    EXPECT_THAT(orderingBackend(), HasSubstr("."));
}

}  // namespace
}  // namespace bullet_fem
