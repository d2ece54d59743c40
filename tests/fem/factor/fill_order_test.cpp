// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/fill_order.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <thread>

#include "fem/factor/ordering_libraries.h"
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

const char* minimumDegreeName()
{
    return amdVersion().empty() ? "Eigen" : "AMD";
}

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

class FillOrderOfPattern : public testing::TestWithParam<NamedPattern>
{
};

TEST_P(FillOrderOfPattern, IsAPermutation)
{
    auto [method, order] = fillReducingOrder(sparsePattern(GetParam().m_matrix));
    EXPECT_THAT(method, AnyOf(StrEq("METIS"), StrEq(minimumDegreeName())));
    std::sort(order.begin(), order.end());
    std::vector<int> all(GetParam().m_matrix.rows());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(order, all);
}

// For any order of a matrix, not only fill-reducing ones.
TEST_P(FillOrderOfPattern, BlocksOfTheFactorAreCountedAsEliminationMakesThem)
{
    const Eigen::MatrixXd& A = GetParam().m_matrix;
    const SparsePattern pattern = sparsePattern(A);
    std::vector<int> order(A.rows());
    std::iota(order.begin(), order.end(), 0);
    EXPECT_EQ(blocksOfFactor(pattern, order), entriesOfFactor(A, order));
    std::mt19937 generator(7);
    std::shuffle(order.begin(), order.end(), generator);
    EXPECT_EQ(blocksOfFactor(pattern, order), entriesOfFactor(A, order));
    order = fillReducingOrder(pattern).m_rows;
    EXPECT_EQ(blocksOfFactor(pattern, order), entriesOfFactor(A, order));
}

INSTANTIATE_TEST_SUITE_P(Patterns, FillOrderOfPattern,
                         testing::Values(NamedPattern{"One", diagonalMatrix(1)},
                                         NamedPattern{"Diagonal", diagonalMatrix(7)},
                                         NamedPattern{"Full", fullMatrix(13)},
                                         NamedPattern{"Tridiagonal", tridiagonalMatrix(20)},
                                         NamedPattern{"Arrow", arrowMatrix(30)}, NamedPattern{"Grid", gridMatrix(6)}),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

// In its natural order an arrow matrix fills completely; with the tip last it has no fill.
TEST(FillOrder, EliminatesTheTipOfAnArrowLast)
{
    constexpr int n = 40;
    std::vector<int> natural(n);
    std::iota(natural.begin(), natural.end(), 0);
    EXPECT_EQ(entriesOfFactor(arrowMatrix(n), natural), n * (n + 1) / 2);
    EXPECT_EQ(entriesOfFactor(arrowMatrix(n), fillReducingOrder(sparsePattern(arrowMatrix(n))).m_rows), 2 * n - 1);
}

// METIS seeds the C library's only random generator and draws from it.
TEST(FillOrder, IsTheSameForConcurrentCallers)
{
    const SparsePattern pattern = sparsePattern(gridMatrix(40));
    const FillOrder alone = fillReducingOrder(pattern);
    std::vector<int> different(4, 0);
    std::vector<std::thread> callers;
    for (int& differences : different)
        callers.emplace_back(
            [&]
            {
                for (int k = 0; k < 20; ++k) differences += fillReducingOrder(pattern).m_rows != alone.m_rows;
            });
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(different, std::vector<int>(4, 0)) << alone.m_method;
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

std::vector<int> minimumDegreeOrder(const SparsePattern& pattern)
{
    return amdVersion().empty() ? eigenOrder(pattern) : amdOrder(pattern);
}

// SuiteSparse's AMD replaces Eigen's if available; dissection of a bar would have more fill.
TEST(FillOrder, UsesMinimumDegreeForABar)
{
    const SparsePattern bar = boxPattern(60, 3, 3);
    const FillOrder order = fillReducingOrder(bar);
    EXPECT_STREQ(order.m_method, minimumDegreeName());
    EXPECT_EQ(order.m_rows, minimumDegreeOrder(bar));
    const std::vector<int> dissection = metisOrder(bar);
    EXPECT_TRUE(dissection.empty() || blocksOfFactor(bar, dissection) > blocksOfFactor(bar, order.m_rows));
}

// Nested dissection has less fill in a cube, if this build has it.
TEST(FillOrder, UsesNestedDissectionForACube)
{
    const SparsePattern cube = boxPattern(10, 10, 10);
    const FillOrder order = fillReducingOrder(cube);
    EXPECT_STREQ(order.m_method, metisVersion().empty() ? minimumDegreeName() : "METIS");
    EXPECT_EQ(order.m_rows, metisVersion().empty() ? minimumDegreeOrder(cube) : metisOrder(cube));
    EXPECT_LE(blocksOfFactor(cube, order.m_rows), blocksOfFactor(cube, minimumDegreeOrder(cube)));
}

TEST(FillOrder, IsEmptyForNoRows)
{
    SparsePattern nothing;
    nothing.m_columnStart = {0};
    EXPECT_TRUE(fillReducingOrder(nothing).m_rows.empty());
}

TEST(OrderingBackend, NamesTheLibrariesOfThisBuildWithTheirVersions)
{
    EXPECT_THAT(orderingBackend(), StartsWith(std::string(minimumDegreeName()) + " "));
    EXPECT_THAT(orderingBackend(), HasSubstr("."));
    EXPECT_THAT(orderingBackend(), HasSubstr(metisVersion()));
    EXPECT_LT(orderingBackend().size(), 48u) << "size of its field in baked files";
}

}  // namespace
}  // namespace bullet_fem
