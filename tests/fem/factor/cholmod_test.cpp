// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The factor against CHOLMOD's of the equally ordered matrix, for thirty bodies.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <limits>
#include <numeric>

#include "benchmarks/factor/cholmod_factor.h"
#include "benchmarks/factor/factor_cases.h"
#include "fem/common/aligned_array.h"
#include "fem/factor/numeric_factor.h"
#include "fem/factor/packed_factor.h"

namespace bullet_fem
{
namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSingleRounding = std::numeric_limits<float>::epsilon() / 2;

// CHOLMOD's L over the rows and columns of supernodes, dense.
class DenseBlocks
{
public:
    explicit DenseBlocks(const LowerMatrix& L) : m_L(L), m_place(L.m_size, -1) {}

    // Columns of nodes `first`, ... and rows of these nodes.
    MatrixXd block(const std::vector<int>& nodes, int first, int columns)
    {
        MatrixXd dense = MatrixXd::Zero(3 * static_cast<Eigen::Index>(nodes.size()), 3 * columns);
        setPlaces(nodes, true);
        for (int c = 0; c < 3 * columns; ++c)
            for (int k = m_L.m_columnStart[3 * first + c]; k < m_L.m_columnStart[3 * first + c + 1]; ++k)
                if (m_place[m_L.m_row[k]] >= 0) dense(m_place[m_L.m_row[k]], c) = m_L.m_value[k];
        setPlaces(nodes, false);
        return dense;
    }

private:
    void setPlaces(const std::vector<int>& nodes, bool set)
    {
        for (std::size_t k = 0; k < nodes.size(); ++k)
            for (int i = 0; i < 3; ++i) m_place[3 * nodes[k] + i] = set ? static_cast<int>(3 * k + i) : -1;
    }

    const LowerMatrix& m_L;
    std::vector<int> m_place;
};

// |A| |x| and A x of a symmetric matrix.
struct Product
{
    VectorXd m_value, m_size;

    Product(const LowerMatrix& A, const VectorXd& x)
        : m_value(VectorXd::Zero(A.m_size)), m_size(VectorXd::Zero(A.m_size))
    {
        for (int c = 0; c < A.m_size; ++c)
            for (int k = A.m_columnStart[c]; k < A.m_columnStart[c + 1]; ++k)
            {
                add(A.m_row[k], A.m_value[k] * x[c]);
                if (A.m_row[k] != c) add(c, A.m_value[k] * x[A.m_row[k]]);
            }
    }

    void add(int row, double value)
    {
        m_value[row] += value;
        m_size[row] += std::abs(value);
    }
};

class CholmodComparison : public testing::TestWithParam<int>
{
protected:
    const FactorCase m_case = thirtyFactorCases()[GetParam()]();
    const FactorSystem m_system{m_case};
    std::vector<int> m_order;
    SupernodeTree m_tree;
    LowerMatrix m_A;

    void SetUp() override
    {
        m_order = fillReducingOrder(m_system.m_pattern).m_rows;
        m_tree = buildSupernodeTree(m_system.m_pattern, m_order);
        for (int& row : m_order) row = m_system.m_freeNodes[row];
        m_A = lowerMatrix(m_system.m_A0, m_order);
    }

    // CHOLMOD's solution of A x = b, refined once: its error in double precision is far below the factor's.
    VectorXd exactSolution(const VectorXd& b) const
    {
        CholmodFactor cholmod(m_A, CholmodFactor::Kind::supernodal, CholmodFactor::Order::natural);
        cholmod.factorize();
        const auto solve = [&cholmod](const VectorXd& right) -> VectorXd
        {
            const std::vector<double> x = cholmod.solve(std::vector<double>(right.begin(), right.end()), 1);
            return VectorXd::Map(x.data(), static_cast<Eigen::Index>(x.size()));
        };
        const VectorXd x = solve(b);
        return x + solve(b - Product(m_A, x).m_value);
    }
};

// S = (L11 L11^T)^-1 and M = L21 L11^-1 of each supernode, from CHOLMOD's L: rounded once to single precision, the
// factors are equal.
TEST_P(CholmodComparison, FactorBlocksMatchCholmod)
{
    CholmodFactor cholmod(m_A, CholmodFactor::Kind::simplicial, CholmodFactor::Order::natural);
    cholmod.factorize();
    const LowerMatrix L = cholmod.takeL();
    DenseBlocks blocks(L);
    double worstS = 0, worstM = 0;
    const auto compare = [&](int s, const double* S, const double* M)
    {
        const Supernode& node = m_tree.m_supernodes[s];
        const int p = 3 * node.m_columns, r = 3 * node.m_rows;
        std::vector<int> columns(node.m_columns);
        std::iota(columns.begin(), columns.end(), node.m_first);
        const auto row = m_tree.m_row.begin() + node.m_rowStart;
        const MatrixXd L11 = blocks.block(columns, node.m_first, node.m_columns),
                       L21 = blocks.block({row, row + node.m_rows}, node.m_first, node.m_columns);
        const MatrixXd inverse = L11.triangularView<Eigen::Lower>().solve(MatrixXd::Identity(p, p));
        const MatrixXd S0 = inverse.transpose() * inverse, M0 = L21 * inverse;
        worstS = std::max(worstS, (MatrixXd::Map(S, p, p) - S0).norm() / S0.norm());
        if (r > 0) worstM = std::max(worstM, (MatrixXd::Map(M, r, p) - M0).norm() / (1 + M0.norm()));
    };
    factorSupernodes(m_system.m_A0, m_order, m_tree, compare);
    EXPECT_LE(worstS, kSingleRounding / 100) << m_case.m_name;
    EXPECT_LE(worstM, kSingleRounding / 100) << m_case.m_name;
}

// A few roundings of single precision in all: of b, of the factor's entries and of x.
TEST_P(CholmodComparison, SolutionMatchesCholmodToSinglePrecision)
{
    PackedFactor factor(m_tree);
    factorSupernodes(m_system.m_A0, m_order, m_tree,
                     [&factor](int s, const double* S, const double* M) { factor.pack(s, S, M); });
    const VectorXd b = VectorXd::Random(factor.size()).cast<float>().cast<double>();
    AlignedFloats y = allocateFloats(factor.vectorSize()), scratch = allocateFloats(factor.scratchSize());
    Eigen::Map<Eigen::VectorXf> solved(y.get(), factor.size());
    solved = b.cast<float>();
    factor.solve(y.get(), scratch.get());
    const VectorXd x = solved.cast<double>(), exact = exactSolution(b);
    const Product product(m_A, x);
    EXPECT_LE((b - product.m_value).norm(), kSingleRounding * (product.m_size.norm() + b.norm())) << m_case.m_name;
    EXPECT_LE((x - exact).norm(), 8 * kSingleRounding * exact.norm()) << m_case.m_name;
}

INSTANTIATE_TEST_SUITE_P(ThirtyBodies, CholmodComparison, testing::Range(0, 30));

}  // namespace
}  // namespace bullet_fem
