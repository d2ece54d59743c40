// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/numeric_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The 3x3 blocks that are not zero, and those of the diagonal.
BlockMatrix blocksOf(const MatrixXd& A)
{
    BlockMatrix result;
    result.m_rowStart.push_back(0);
    const int n = static_cast<int>(A.rows()) / 3;
    for (int i = 0; i < n; ++i)
    {
        for (int j = 0; j < n; ++j)
        {
            const Eigen::Matrix3d block = A.block<3, 3>(3 * i, 3 * j);
            if (i != j && block.isZero(0)) continue;
            Mat3 entries;
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) entries(r, c) = block(r, c);
            result.m_column.push_back(j);
            result.m_block.push_back(entries);
        }
        result.m_rowStart.push_back(static_cast<int>(result.m_column.size()));
    }
    return result;
}

// Each pair of nodes is coupled with this probability. Positive definite, condition below 100.
MatrixXd randomBlocks(int nodes, double density, unsigned seed)
{
    std::mt19937 random(seed);
    const auto number = [&random] { return random() / 4294967296.0; };
    MatrixXd A = MatrixXd::Zero(3 * nodes, 3 * nodes);
    for (int i = 0; i < nodes; ++i)
        for (int j = 0; j <= i; ++j)
        {
            if (i != j && number() > density) continue;
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) A(3 * i + r, 3 * j + c) = A(3 * j + c, 3 * i + r) = number() - 0.5;
        }
    A.diagonal().array() += A.cwiseAbs().rowwise().sum().maxCoeff();
    return A;
}

// A0 of a clamped bar: stiffness times h^2 + h beta and lumped masses, on h = 1/60 s.
BlockMatrix restSystem(const TetMesh& mesh)
{
    const Material material = elasticMaterial(1e6, 0.3);
    BlockMatrix A = assembleRestStiffness(RestShape(mesh, material));
    for (Mat3& block : A.m_block) block *= 1.0 / 3600 + 0.01 / 60;
    const double mass = material.m_density * mesh.volume() / mesh.nodeCount();
    for (int i = 0; i < A.nodeCount(); ++i) A.at(i, i) += Mat3::diagonal(mass);
    return A;
}

std::vector<int> freeNodes(const TetMesh& mesh)
{
    std::vector<int> nodes;
    for (int i = 0; i < mesh.nodeCount(); ++i)
        if (mesh.restPositions()[i].x > 1e-9) nodes.push_back(i);
    return nodes;
}

std::vector<int> allNodes(const BlockMatrix& A)
{
    std::vector<int> nodes(A.nodeCount());
    std::iota(nodes.begin(), nodes.end(), 0);
    return nodes;
}

// The pattern of A over some of its nodes, ascending.
SparsePattern patternOf(const BlockMatrix& A, const std::vector<int>& nodes)
{
    std::vector<int> place(A.nodeCount(), -1);
    for (std::size_t k = 0; k < nodes.size(); ++k) place[nodes[k]] = static_cast<int>(k);
    SparsePattern pattern;
    pattern.m_size = static_cast<int>(nodes.size());
    pattern.m_columnStart.push_back(0);
    for (int node : nodes)
    {
        for (int k = A.m_rowStart[node]; k < A.m_rowStart[node + 1]; ++k)
            if (place[A.m_column[k]] >= place[node]) pattern.m_rowIndex.push_back(place[A.m_column[k]]);
        pattern.m_columnStart.push_back(static_cast<int>(pattern.m_rowIndex.size()));
    }
    return pattern;
}

// A factor with all its blocks kept.
struct Factor
{
    std::vector<int> m_nodes;  // of A, by column of the tree
    SupernodeTree m_tree;
    std::vector<MatrixXd> m_S, m_M;

    Factor(const BlockMatrix& A, const std::vector<int>& nodes)
    {
        const SparsePattern pattern = patternOf(A, nodes);
        std::vector<int> order = fillReducingOrder(pattern).m_rows;
        m_tree = buildSupernodeTree(pattern, order);
        for (int k : order) m_nodes.push_back(nodes[k]);
        run(A);
    }

    void run(const BlockMatrix& A)
    {
        m_S.clear();
        m_M.clear();
        factorSupernodes(A, m_nodes, m_tree,
                         [this](int s, const double* S, const double* M)
                         {
                             EXPECT_EQ(s, static_cast<int>(m_S.size())) << "children before parents";
                             const Supernode& node = m_tree.m_supernodes[s];
                             m_S.push_back(Eigen::Map<const MatrixXd>(S, 3 * node.m_columns, 3 * node.m_columns));
                             m_M.push_back(Eigen::Map<const MatrixXd>(M, 3 * node.m_rows, 3 * node.m_columns));
                         });
        EXPECT_EQ(m_S.size(), m_tree.m_supernodes.size());
    }

    // The scalar rows below supernode s.
    std::vector<int> rows(const Supernode& s) const
    {
        std::vector<int> result;
        for (int k = 0; k < s.m_rows; ++k)
            for (int i = 0; i < 3; ++i) result.push_back(3 * m_tree.m_row[s.m_rowStart + k] + i);
        return result;
    }

    MatrixXd permuted(const MatrixXd& A) const
    {
        MatrixXd result(3 * m_nodes.size(), 3 * m_nodes.size());
        for (std::size_t i = 0; i < m_nodes.size(); ++i)
            for (std::size_t j = 0; j < m_nodes.size(); ++j)
                result.block<3, 3>(3 * i, 3 * j) = A.block<3, 3>(3 * m_nodes[i], 3 * m_nodes[j]);
        return result;
    }

    VectorXd solve(VectorXd y) const
    {
        const int n = static_cast<int>(m_S.size());
        for (int s = 0; s < n; ++s)
        {
            const Supernode& node = m_tree.m_supernodes[s];
            const VectorXd update = m_M[s] * y.segment(3 * node.m_first, 3 * node.m_columns);
            y(rows(node)) -= update;
        }
        for (int s = n - 1; s >= 0; --s)
        {
            const Supernode& node = m_tree.m_supernodes[s];
            auto own = y.segment(3 * node.m_first, 3 * node.m_columns);
            const VectorXd below = y(rows(node));
            own = (m_S[s] * own - m_M[s].transpose() * below).eval();
        }
        return y;
    }
};

struct NamedSystem
{
    std::string m_name;
    BlockMatrix (*m_make)();
};

class NumericFactor : public testing::TestWithParam<NamedSystem>
{
protected:
    const BlockMatrix m_A = GetParam().m_make();
    const Factor m_factor{m_A, allNodes(m_A)};
    const MatrixXd m_permuted = m_factor.permuted(dense(m_A));
};

// A = (I + M) S^-1 (I + M)^T with the blocks M and S^-1 of all supernodes.
TEST_P(NumericFactor, BlocksMultiplyToA)
{
    const int n = static_cast<int>(m_permuted.rows());
    MatrixXd L = MatrixXd::Identity(n, n), D = MatrixXd::Zero(n, n);
    for (std::size_t s = 0; s < m_factor.m_S.size(); ++s)
    {
        const Supernode& node = m_factor.m_tree.m_supernodes[s];
        const int first = 3 * node.m_first, size = 3 * node.m_columns;
        D.block(first, first, size, size) = m_factor.m_S[s].inverse();
        L(m_factor.rows(node), Eigen::seqN(first, size)) = m_factor.m_M[s];
    }
    EXPECT_LE((L * D * L.transpose() - m_permuted).norm(), 1e-12 * m_permuted.norm());
}

TEST_P(NumericFactor, BlocksAreThoseOfTheCholeskyFactor)
{
    const MatrixXd L = m_permuted.llt().matrixL();
    for (std::size_t s = 0; s < m_factor.m_S.size(); ++s)
    {
        const Supernode& node = m_factor.m_tree.m_supernodes[s];
        const int first = 3 * node.m_first, size = 3 * node.m_columns;
        const MatrixXd inverse = L.block(first, first, size, size).inverse();
        const MatrixXd L21 = L(m_factor.rows(node), Eigen::seqN(first, size));
        const MatrixXd S = inverse.transpose() * inverse, M = L21 * inverse;
        EXPECT_LE((m_factor.m_S[s] - S).norm(), 1e-11 * S.norm()) << s;
        EXPECT_LE((m_factor.m_M[s] - M).norm(), 1e-11 * (1 + M.norm())) << s;
    }
}

TEST_P(NumericFactor, RefactoringGivesTheSameBits)
{
    Factor again = m_factor;
    again.run(m_A);
    EXPECT_EQ(again.m_S, m_factor.m_S);
    EXPECT_EQ(again.m_M, m_factor.m_M);
}

MatrixXd twoPieces()
{
    MatrixXd A = MatrixXd::Zero(3 * 60, 3 * 60);
    A.topLeftCorner(90, 90) = randomBlocks(30, 0.1, 3);
    A.bottomRightCorner(90, 90) = randomBlocks(30, 0.2, 4);
    return A;
}

// Made within the tests that use them, since each test runs in a process of its own.
INSTANTIATE_TEST_SUITE_P(Systems, NumericFactor,
                         testing::Values(NamedSystem{"OneNode", [] { return blocksOf(randomBlocks(1, 1, 1)); }},
                                         NamedSystem{"Points", [] { return blocksOf(randomBlocks(8, 0, 1)); }},
                                         NamedSystem{"Dense", [] { return blocksOf(randomBlocks(80, 1, 2)); }},
                                         NamedSystem{"TwoPieces", [] { return blocksOf(twoPieces()); }},
                                         NamedSystem{"Sparse", [] { return blocksOf(randomBlocks(150, 0.015, 5)); }},
                                         NamedSystem{"LessSparse", [] { return blocksOf(randomBlocks(110, 0.05, 6)); }},
                                         NamedSystem{"Box",
                                                     [] {
                                                         return restSystem(makeBox({1, 1, 1}, {5, 4, 6}));
                                                     }},
                                         NamedSystem{"Bar",
                                                     [] {
                                                         return restSystem(makeBox({9, 1, 1}, {45, 2, 2}));
                                                     }}),
                         [](const auto& suite) { return suite.param.m_name; });

// The clamped beam of 1,536 elements.
TEST(NumericFactorBeam, SolvesWithoutOmittedNodes)
{
    const TetMesh mesh = makeBox({4, 1, 1}, {16, 4, 4}, {}, CellSplit::kuhnSix);
    const BlockMatrix A = restSystem(mesh);
    const Factor factor(A, freeNodes(mesh));
    ASSERT_EQ(factor.m_nodes.size(), 400u);
    const MatrixXd permuted = factor.permuted(dense(A));
    const VectorXd b = VectorXd::LinSpaced(1200, -1, 2);
    EXPECT_LE((b - permuted * factor.solve(b)).norm(), 1e-12 * b.norm());
}

std::string failure(const BlockMatrix& A)
{
    try
    {
        Factor(A, allNodes(A));
    }
    catch (const std::runtime_error& error)
    {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(NumericFactorErrors, NameTheNonPositiveNode)
{
    BlockMatrix A = restSystem(makeBox({1, 1, 1}, {4, 4, 4}));
    A.at(17, 17)(1, 1) = -3e5;
    EXPECT_NE(failure(A).find("not positive definite: pivot -"), std::string::npos) << failure(A);
    EXPECT_NE(failure(A).find("at node 17;"), std::string::npos) << failure(A);
    A.at(17, 17)(1, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(failure(A).find("pivot nan at node 17;"), std::string::npos) << failure(A);
}

// Without masses the rigid modes are singular: the last pivots are round-off, here made clearly negative.
TEST(NumericFactorErrors, RefuseAnIndefiniteSum)
{
    BlockMatrix A = assembleRestStiffness(RestShape(makeBox({1, 1, 1}, {3, 3, 3}), elasticMaterial(1e6, 0.3)));
    for (int i = 0; i < A.nodeCount(); ++i) A.at(i, i) += Mat3::diagonal(-1);
    EXPECT_NE(failure(A).find("not positive definite"), std::string::npos);
}

TEST(NumericFactorErrors, RejectInconsistentInput)
{
    const BlockMatrix A = blocksOf(randomBlocks(6, 1, 1)), sparse = blocksOf(randomBlocks(6, 0, 1));
    const Factor factor(A, allNodes(A)), points(sparse, allNodes(sparse));
    const auto run = [](const BlockMatrix& matrix, const std::vector<int>& order, const SupernodeTree& tree)
    { return [=] { factorSupernodes(matrix, order, tree, [](int, const double*, const double*) {}); }; };
    expectRejected(run(A, {0, 1, 2}, factor.m_tree), {"3 entries", "6 columns"});
    expectRejected(run(A, {0, 1, 2, 3, 4, 6}, factor.m_tree), {"node 6", "place 5", "0 ... 5"});
    expectRejected(run(A, {0, 1, 2, 3, 4, 4}, factor.m_tree), {"node 4", "place 5", "once"});
    expectRejected(run(A, {0, 1, 2, 3, 4, 5}, points.m_tree), {"no room", "nodes 0 and 1"});
}

TEST(NumericFactorErrors, NothingToFactorIsNoError)
{
    const BlockMatrix A = blocksOf(randomBlocks(3, 1, 1));
    factorSupernodes(A, {}, SupernodeTree(), [](int, const double*, const double*) { FAIL(); });
}

}  // namespace
}  // namespace bullet_fem
