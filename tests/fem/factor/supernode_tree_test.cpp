// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/supernode_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include "fem/factor/block_matrix.h"
#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

using Rows = std::set<int>;

struct NamedGraph
{
    std::string m_name;
    SparsePattern (*m_make)();
};

// `pieces` uncoupled dense blocks.
Eigen::MatrixXd blockDiagonal(int pieces, int size)
{
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(pieces * size, pieces * size);
    for (int k = 0; k < pieces; ++k) A.block(k * size, k * size, size, size) = fullMatrix(size);
    return A;
}

Eigen::MatrixXd randomGraph(int n, double density, unsigned seed)
{
    std::mt19937 random(seed);
    Eigen::MatrixXd A = n * Eigen::MatrixXd::Identity(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j)
            if (random() < density * 4294967296.0) A(i, j) = A(j, i) = 1;
    return A;
}

SparsePattern meshPattern(const TetMesh& mesh)
{
    const BlockMatrix K = assembleRestStiffness(RestShape(mesh, elasticMaterial(1e6, 0.3)));
    SparsePattern pattern;
    pattern.m_size = K.nodeCount();
    pattern.m_columnStart.push_back(0);
    for (int i = 0; i < K.nodeCount(); ++i)
    {
        for (int k = K.m_rowStart[i]; k < K.m_rowStart[i + 1]; ++k)
            if (K.m_column[k] >= i) pattern.m_rowIndex.push_back(K.m_column[k]);
        pattern.m_columnStart.push_back(static_cast<int>(pattern.m_rowIndex.size()));
    }
    return pattern;
}

// The rows below the diagonal of each column of the factor, by textbook elimination.
std::vector<Rows> fill(const SparsePattern& pattern, const std::vector<int>& order)
{
    std::vector<int> position(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) position[order[k]] = static_cast<int>(k);
    std::vector<Rows> below(order.size());
    for (int c = 0; c < pattern.m_size; ++c)
        for (int k = pattern.m_columnStart[c] + 1; k < pattern.m_columnStart[c + 1]; ++k)
        {
            const int a = position[c], b = position[pattern.m_rowIndex[k]];
            below[std::min(a, b)].insert(std::max(a, b));
        }
    for (const Rows& rows : below)
        for (int row : rows)
            for (int other : rows)
                if (other > row) below[row].insert(other);
    return below;
}

std::size_t entryCount(const std::vector<Rows>& below)
{
    std::size_t count = 0;
    for (const Rows& rows : below) count += 6 + 9 * rows.size();
    return count;
}

std::vector<int> naturalOrder(int n)
{
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    return order;
}

std::vector<std::vector<int>> ordersToTry(const SparsePattern& pattern)
{
    std::vector<std::vector<int>> orders = {naturalOrder(pattern.m_size), fillReducingOrder(pattern).m_rows};
    orders.push_back(orders[0]);
    std::shuffle(orders[2].begin(), orders[2].end(), std::mt19937(4));
    return orders;
}

Rows rowsOf(const SupernodeTree& tree, const Supernode& s)
{
    return Rows(tree.m_row.begin() + s.m_rowStart, tree.m_row.begin() + s.m_rowStart + s.m_rows);
}

class SupernodeTrees : public testing::TestWithParam<NamedGraph>
{
protected:
    // Runs check(order before, order after, tree) for several orders.
    template <class Check>
    void forOrders(const Check& check) const
    {
        for (const std::vector<int>& before : ordersToTry(m_pattern))
        {
            std::vector<int> after = before;
            const SupernodeTree tree = buildSupernodeTree(m_pattern, after);
            check(before, after, tree);
        }
    }

    const SparsePattern m_pattern = GetParam().m_make();
};

TEST_P(SupernodeTrees, ColumnsAreDividedAmongSupernodesInPostorder)
{
    forOrders(
        [](const auto& before, const auto&, const SupernodeTree& tree)
        {
            int columns = 0;
            std::vector<int> firstDescendant(tree.m_supernodes.size()), nextSubtree(tree.m_supernodes.size());
            for (int s = 0; s < static_cast<int>(tree.m_supernodes.size()); ++s)
            {
                const Supernode& node = tree.m_supernodes[s];
                EXPECT_EQ(node.m_first, columns);
                EXPECT_GE(node.m_columns, 1);
                columns += node.m_columns;
                // The children's subtrees are adjacent and directly before the parent.
                int first = s;
                for (int child = s - 1; child >= 0 && tree.m_supernodes[child].m_parent == s;
                     child = firstDescendant[child] - 1)
                    first = firstDescendant[child];
                firstDescendant[s] = first;
                for (int below = first; below < s; ++below) EXPECT_LE(tree.m_supernodes[below].m_parent, s);
                for (int before_s = 0; before_s < first; ++before_s) EXPECT_NE(tree.m_supernodes[before_s].m_parent, s);
                EXPECT_TRUE(node.m_parent == -1 || node.m_parent > s);
            }
            EXPECT_EQ(columns, tree.m_nodeCount);
            EXPECT_EQ(columns, static_cast<int>(before.size()));
        });
}

TEST_P(SupernodeTrees, RowsAscendAndAreTheParentsOwn)
{
    forOrders(
        [](const auto&, const auto&, const SupernodeTree& tree)
        {
            for (const Supernode& s : tree.m_supernodes)
            {
                const auto begin = tree.m_row.begin() + s.m_rowStart;
                EXPECT_TRUE(std::is_sorted(begin, begin + s.m_rows, std::less_equal<int>()));
                EXPECT_EQ(s.m_parent == -1, s.m_rows == 0);
                if (s.m_parent == -1) continue;
                const Supernode& parent = tree.m_supernodes[s.m_parent];
                Rows allowed = rowsOf(tree, parent);
                for (int c = 0; c < parent.m_columns; ++c) allowed.insert(parent.m_first + c);
                EXPECT_GE(*begin, s.m_first + s.m_columns);
                for (int row : rowsOf(tree, s)) EXPECT_TRUE(allowed.count(row)) << row;
            }
        });
}

TEST_P(SupernodeTrees, TheNewOrderHasTheSameFill)
{
    forOrders(
        [this](const auto& before, const auto& after, const SupernodeTree&)
        {
            std::vector<int> sorted = after;
            std::sort(sorted.begin(), sorted.end());
            EXPECT_EQ(sorted, naturalOrder(static_cast<int>(before.size())));
            EXPECT_EQ(entryCount(fill(m_pattern, after)), entryCount(fill(m_pattern, before)));
        });
}

TEST_P(SupernodeTrees, MergingOnlyAddsEntries)
{
    forOrders(
        [this](const auto&, const auto& after, const SupernodeTree& tree)
        {
            const std::vector<Rows> exact = fill(m_pattern, after);
            std::size_t stored = 0;
            for (const Supernode& s : tree.m_supernodes)
            {
                Rows place = rowsOf(tree, s), needed;
                for (int c = s.m_first; c < s.m_first + s.m_columns; ++c)
                {
                    for (int row : exact[c])
                        EXPECT_TRUE(place.count(row) || row < s.m_first + s.m_columns)
                            << "column " << c << " row " << row;
                    needed.insert(exact[c].lower_bound(s.m_first + s.m_columns), exact[c].end());
                }
                EXPECT_EQ(s.m_rows == 0, needed.empty());
                stored += 3 * s.m_columns * (3 * s.m_columns + 1) / 2 + 9 * s.m_columns * s.m_rows;
            }
            EXPECT_EQ(static_cast<std::size_t>(tree.m_entries), stored);
            EXPECT_GE(stored, entryCount(exact));
        });
}

// Made within the tests that use them, since each test runs in a process of its own.
INSTANTIATE_TEST_SUITE_P(Graphs, SupernodeTrees,
                         testing::Values(NamedGraph{"One", [] { return sparsePattern(diagonalMatrix(1)); }},
                                         NamedGraph{"Points", [] { return sparsePattern(diagonalMatrix(9)); }},
                                         NamedGraph{"Dense", [] { return sparsePattern(fullMatrix(30)); }},
                                         NamedGraph{"Chain", [] { return sparsePattern(tridiagonalMatrix(90)); }},
                                         NamedGraph{"Arrow", [] { return sparsePattern(arrowMatrix(60)); }},
                                         NamedGraph{"TwoPieces", [] { return sparsePattern(blockDiagonal(2, 25)); }},
                                         NamedGraph{"Sparse", [] { return sparsePattern(randomGraph(120, 0.015, 1)); }},
                                         NamedGraph{"LessSparse",
                                                    [] { return sparsePattern(randomGraph(120, 0.05, 2)); }},
                                         NamedGraph{"Box",
                                                    [] {
                                                        return meshPattern(makeBox({1, 1, 1}, {4, 5, 6}));
                                                    }},
                                         NamedGraph{"Bar",
                                                    [] {
                                                        return meshPattern(makeBox({9, 1, 1}, {27, 3, 3}));
                                                    }}),
                         [](const auto& suite) { return suite.param.m_name; });

SupernodeTree treeOf(const Eigen::MatrixXd& A)
{
    std::vector<int> order = naturalOrder(static_cast<int>(A.rows()));
    return buildSupernodeTree(sparsePattern(A), order);
}

TEST(SupernodeTree, ASingleNodeIsOneSupernode)
{
    const SupernodeTree tree = treeOf(diagonalMatrix(1));
    ASSERT_EQ(tree.m_supernodes.size(), 1u);
    EXPECT_EQ(tree.m_supernodes[0].m_columns, 1);
    EXPECT_EQ(tree.m_supernodes[0].m_rows, 0);
    EXPECT_EQ(tree.m_supernodes[0].m_parent, -1);
    EXPECT_EQ(tree.m_entries, 6);
}

TEST(SupernodeTree, ADenseMatrixIsOneSupernode)
{
    const SupernodeTree tree = treeOf(fullMatrix(50));
    ASSERT_EQ(tree.m_supernodes.size(), 1u);
    EXPECT_EQ(tree.widestColumns(), 50);
    EXPECT_EQ(tree.longestRows(), 0);
}

// 150 columns in three links: 50 columns with 100 rows, 50 with 50, 50 with none.
TEST(SupernodeTree, AWideSupernodeIsAChain)
{
    const SupernodeTree tree = treeOf(fullMatrix(150));
    ASSERT_EQ(tree.m_supernodes.size(), 3u);
    for (int k = 0; k < 3; ++k)
    {
        const Supernode& s = tree.m_supernodes[k];
        EXPECT_EQ(s.m_first, 50 * k);
        EXPECT_EQ(s.m_columns, 50);
        EXPECT_EQ(s.m_rows, 100 - 50 * k);
        EXPECT_EQ(s.m_parent, k < 2 ? k + 1 : -1);
    }
    EXPECT_EQ(tree.m_entries, 450 * 451 / 2);
}

TEST(SupernodeTree, ComponentsAreNotMerged)
{
    const SupernodeTree tree = treeOf(blockDiagonal(3, 2));
    ASSERT_EQ(tree.m_supernodes.size(), 3u);
    for (const Supernode& s : tree.m_supernodes) EXPECT_EQ(s.m_parent, -1);
}

// Dense blocks of 40 nodes that share only 8 at the end: merging them would add too many zeros.
TEST(SupernodeTree, WideBranchesStayApart)
{
    Eigen::MatrixXd A = blockDiagonal(2, 40);
    A.conservativeResizeLike(Eigen::MatrixXd::Zero(88, 88));
    A.rightCols(8).setOnes();
    A.bottomRows(8).setOnes();
    A.bottomRightCorner(8, 8) = fullMatrix(8);
    const SupernodeTree tree = treeOf(A);
    ASSERT_GE(tree.m_supernodes.size(), 2u);
    EXPECT_EQ(tree.m_supernodes[0].m_columns, 40);
    EXPECT_EQ(tree.m_supernodes[0].m_rows, 8);
    EXPECT_LE(tree.m_entries, static_cast<long>(1.2 * entryCount(fill(sparsePattern(A), naturalOrder(88)))));
}

TEST(SupernodeTree, AMeshHasFewSupernodesAndFewZeros)
{
    const SparsePattern pattern = meshPattern(makeBox({4, 1, 1}, {16, 4, 4}, {}, CellSplit::kuhnSix));
    std::vector<int> order = fillReducingOrder(pattern).m_rows;
    const SupernodeTree tree = buildSupernodeTree(pattern, order);
    EXPECT_LE(tree.m_supernodes.size(), pattern.m_size / 5u);
    EXPECT_LE(tree.m_entries, static_cast<long>(1.2 * entryCount(fill(pattern, order))));
}

TEST(SupernodeTree, AnEmptyPatternHasNone)
{
    SparsePattern nothing;
    nothing.m_columnStart = {0};
    std::vector<int> order;
    const SupernodeTree tree = buildSupernodeTree(nothing, order);
    EXPECT_TRUE(tree.m_supernodes.empty());
    EXPECT_EQ(tree.widestColumns(), 0);
    EXPECT_EQ(tree.longestRows(), 0);
}

TEST(SupernodeTree, RejectsInvalidPermutations)
{
    const SparsePattern pattern = sparsePattern(tridiagonalMatrix(4));
    const auto build = [&pattern](std::vector<int> order)
    { return [&pattern, order]() mutable { buildSupernodeTree(pattern, order); }; };
    expectRejected(build({0, 1, 2}), {"3 entries", "4 rows"});
    expectRejected(build({0, 1, 1, 2}), {"row 1", "place 2"});
    expectRejected(build({0, 1, 2, 4}), {"row 4", "place 3"});
    expectRejected(build({0, -1, 2, 3}), {"row -1", "place 1"});
}

}  // namespace
}  // namespace bullet_fem
