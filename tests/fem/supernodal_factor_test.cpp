// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/supernodal_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <string>

#include "fem/dense_system.h"
#include "fem/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

struct FactorCase
{
    const char* m_name;
    Eigen::MatrixXd m_matrix;
    int m_supernodes;  // by hand
};

void PrintTo(const FactorCase& factorCase, std::ostream* out)
{
    *out << factorCase.m_name;
}

std::vector<float> randomVector(int n, unsigned seed)
{
    RandomVectors random(seed);
    std::vector<float> y(n);
    for (float& value : y) value = static_cast<float>(random.next().x);
    return y;
}

class SupernodalSolve : public testing::TestWithParam<FactorCase>
{
protected:
    const Eigen::MatrixXd& A() const { return GetParam().m_matrix; }
    int size() const { return static_cast<int>(A().rows()); }

    // |y - A^-1 b| / |A^-1 b|, for one lane of an interleaved array.
    double error(const std::vector<float>& y, const std::vector<float>& b, int lanes, int lane) const
    {
        Eigen::VectorXd right(size()), got(size());
        for (int i = 0; i < size(); ++i)
        {
            right(i) = b[i * lanes + lane];
            got(i) = y[i * lanes + lane];
        }
        const Eigen::VectorXd expected = A().llt().solve(right);
        return (got - expected).norm() / expected.norm();
    }

    const SupernodalFactor m_factor{choleskyFactor(sparseLower(A()))};
    std::vector<float> m_scratch = std::vector<float>(4 * m_factor.scratchSize() + 1);
};

// Single precision, 6e-8, times a condition below 100.
constexpr double kSingle = 6e-6;

TEST_P(SupernodalSolve, OneLaneSolves)
{
    const std::vector<float> b = randomVector(size(), 1);
    std::vector<float> y = b;
    m_factor.solve<1>(y.data(), m_scratch.data());
    EXPECT_LE(error(y, b, 1, 0), kSingle);
}

TEST_P(SupernodalSolve, FourLanesSolveEachForItself)
{
    const std::vector<float> b = randomVector(4 * size(), 2);
    std::vector<float> y = b;
    m_factor.solve<4>(y.data(), m_scratch.data());
    for (int lane = 0; lane < 4; ++lane) EXPECT_LE(error(y, b, 4, lane), kSingle) << lane;

    // The bits of a lane do not depend on the others.
    std::vector<float> alone(b.size());
    for (int i = 0; i < size(); ++i) alone[4 * i + 2] = b[4 * i + 2];
    m_factor.solve<4>(alone.data(), m_scratch.data());
    for (int i = 0; i < size(); ++i)
    {
        EXPECT_EQ(alone[4 * i + 2], y[4 * i + 2]);
        EXPECT_EQ(alone[4 * i], 0);
    }
}

TEST_P(SupernodalSolve, GivesTheSameBitsEveryTime)
{
    std::vector<float> first = randomVector(size(), 3), second = first;
    m_factor.solve<1>(first.data(), m_scratch.data());
    m_scratch.assign(m_scratch.size(), 1e30f);  // what the scratch held does not matter
    m_factor.solve<1>(second.data(), m_scratch.data());
    EXPECT_EQ(first, second);
}

TEST_P(SupernodalSolve, CountsItsEntriesAndPanels)
{
    const SparseLower L = choleskyFactor(sparseLower(A()));
    EXPECT_EQ(m_factor.size(), size());
    EXPECT_EQ(m_factor.entryCount(), static_cast<long>(L.m_rowIndex.size()));
    EXPECT_EQ(m_factor.supernodeCount(), GetParam().m_supernodes);
}

// Two dense blocks of 5 and 7 columns above a dense block of `rows`: three supernodes with rows below, whose number
// runs through the remainders of the unrolled loops.
Eigen::MatrixXd branches(int rows)
{
    Eigen::MatrixXd A = fullMatrix(12 + rows);
    A.block(5, 0, 7, 5).setZero();
    A.block(0, 5, 5, 7).setZero();
    return A;
}

INSTANTIATE_TEST_SUITE_P(
    Patterns, SupernodalSolve,
    testing::Values(FactorCase{"One", diagonalMatrix(1), 1}, FactorCase{"Diagonal", diagonalMatrix(9), 9},
                    FactorCase{"Full", fullMatrix(23), 1},
                    FactorCase{"Tridiagonal", tridiagonalMatrix(20), 19},  // the last two columns are one
                    FactorCase{"ArrowTipLast", arrowMatrix(16).reverse(), 15},
                    FactorCase{"BranchesOver1", branches(1), 3 - 1},  // one row below: the second block goes on into it
                    FactorCase{"BranchesOver8", branches(8), 3 - 1}, FactorCase{"BranchesOver19", branches(19), 3 - 1}),
    [](const auto& suite) { return std::string(suite.param.m_name); });

// Of a mesh-like matrix the number of supernodes is not known by hand: at least three columns of a node share one.
TEST(SupernodalFactor, PanelsHoldWholeNodesOfABlockMatrix)
{
    const Eigen::MatrixXd A = gridMatrix(7);
    const SupernodalFactor factor(choleskyFactor(sparseLower(A)));
    EXPECT_LE(factor.supernodeCount(), A.rows() / 3);
    const std::vector<float> b = randomVector(factor.size(), 4);
    std::vector<float> y = b, scratch(factor.scratchSize());
    factor.solve<1>(y.data(), scratch.data());
    const Eigen::Map<const Eigen::VectorXf> right(b.data(), factor.size()), got(y.data(), factor.size());
    const Eigen::VectorXd expected = A.llt().solve(right.cast<double>());
    EXPECT_LE((got.cast<double>() - expected).norm(), kSingle * expected.norm());
}

// L = [2 0; 1 4]: L L^T = [4 2; 2 17], whose inverse times (8, 21) is (94, 68) / 64.
TEST(SupernodalFactor, TwoByTwoByHand)
{
    SparseLower L;
    L.m_size = 2;
    L.m_columnStart = {0, 2, 3};
    L.m_rowIndex = {0, 1, 1};
    L.m_value = {2, 1, 4};
    const SupernodalFactor factor(L);
    float y[] = {8, 21}, scratch[1];
    factor.solve<1>(y, scratch);
    EXPECT_FLOAT_EQ(y[0], 94.f / 64);
    EXPECT_FLOAT_EQ(y[1], 68.f / 64);
}

TEST(SupernodalFactor, AnEmptyOneDoesNothing)
{
    const SupernodalFactor factor;
    EXPECT_EQ(factor.size(), 0);
    EXPECT_EQ(factor.supernodeCount(), 0);
    float nothing = 7;
    factor.solve<1>(&nothing, &nothing);
    EXPECT_EQ(nothing, 7);
}

}  // namespace
}  // namespace bullet_fem
