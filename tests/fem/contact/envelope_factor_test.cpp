// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/envelope_factor.h"

#include <gtest/gtest.h>

#include "fem/common/vector_targets.h"

#include <hwy/highway.h>
#include <Eigen/Dense>
#include <algorithm>
#include <random>
#include <vector>

#include "fem/contact/compliance/row_products.h"

namespace bullet_fem
{
namespace
{

/// Uniform random numbers in [-1, 1).
class Signed
{
public:
    double operator()() { return m_generator() / 2147483648.0 - 1; }

private:
    std::mt19937 m_generator{7};
};

/// A factor of J J^T within an envelope; J has the given number of columns.
class Within
{
public:
    Within(const std::vector<int>& first, int columns) : m_held(3 * first.size(), 0)
    {
        const int rows = static_cast<int>(first.size()), n = 3 * rows;
        Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, columns);
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < columns; ++k) J(i, k) = m_random();
        m_W = J * J.transpose();
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < first[i]; ++j)
            {
                m_W.block<3, 3>(3 * i, 3 * j).setZero();
                m_W.block<3, 3>(3 * j, 3 * i).setZero();
            }
        if (*std::max_element(first.begin(), first.end()) > 0) m_W.diagonal().array() += n;  // keeps it definite
        for (int i = 0; i < rows; ++i) m_factor.addRow(first[i]);
        for (int i = 0; i < rows; ++i)
            for (int j = first[i]; j <= i; ++j)
            {
                Mat3 block;
                for (int c = 0; c < 3; ++c)
                    for (int d = 0; d < 3; ++d) block(c, d) = m_W(3 * i + c, 3 * j + d);
                m_factor.set(i, j, block);
            }
    }

    Eigen::VectorXd solve(const Eigen::VectorXd& b)
    {
        Eigen::VectorXd x = b;
        m_factor.factor(m_held.data());
        m_factor.solve(x.data());
        return x;
    }

    Eigen::VectorXd vector()
    {
        Eigen::VectorXd b(m_W.rows());
        for (int i = 0; i < b.size(); ++i) b(i) = m_random();
        return b;
    }

    Signed m_random;
    Eigen::MatrixXd m_W;
    std::vector<unsigned char> m_held;
    EnvelopeFactor m_factor;
};

TEST(EnvelopeFactor, SolvesWithinItsEnvelope)
{
    for (const std::vector<int>& first :
         {std::vector<int>{0}, {0, 0, 0, 0, 0, 0, 0}, {0, 0, 1, 1, 4, 3, 5, 0}, {0, 1, 2, 2}})
    {
        Within c(first, 40);
        const Eigen::VectorXd b = c.vector(), x = c.solve(b);
        EXPECT_LT((c.m_W * x - b).norm(), 1e-10 * b.norm());
    }
}

TEST(EnvelopeFactor, OmitsHeldUnknowns)
{
    Within c({0, 0, 0, 0}, 40);
    c.m_held[2] = c.m_held[7] = 1;
    const Eigen::VectorXd b = c.vector(), x = c.solve(b), left = c.m_W * x - b;
    for (int i = 0; i < x.size(); ++i)
        if (c.m_held[i])
            EXPECT_EQ(x(i), 0);
        else
            EXPECT_NEAR(left(i), 0, 1e-10);
}

// A system of 12 equations and rank 5: a consistent right-hand side is solved exactly, and no unknown grows large.
TEST(EnvelopeFactor, LeavesDependentUnknownsAtZero)
{
    Within c({0, 0, 0, 0}, 5);
    const Eigen::VectorXd b = c.m_W * c.vector(), x = c.solve(b);
    EXPECT_LT((c.m_W * x - b).norm(), 1e-9 * b.norm());
    EXPECT_EQ((x.array() == 0).count(), 7);
    EXPECT_LT(c.solve(c.vector()).norm(), 1e3);  // an inconsistent right-hand side
}

// Single precision leaves about 1e-7 of a pivot that is zero exactly; other pivots are much larger.
TEST(EnvelopeFactor, KnowsRoundingFromStiffness)
{
    for (const double pivot : {1e-7, 1e-5})
    {
        Within c({0}, 1);
        c.m_factor.set(0, 0, {{{1, 1, 0}, {1, 1 + pivot, 0}, {0, 0, 1}}});
        EXPECT_EQ(c.solve(Eigen::Vector3d(0, 1, 0))(1) != 0, pivot > EnvelopeFactor::kDependent);
    }
}

TEST(RowProducts, AreTheSameOnEveryInstructionSet)
{
    Signed random;
    int compared = 0;
    for (const std::size_t count : {0, 1, 3, 6, 9, 30})
    {
        std::vector<double> a(3 * (count + 2)), b(3 * (count + 1));
        for (std::vector<double>* values : {&a, &b})
            for (double& value : *values) value = random();
        std::vector<double> expected(9, 0.5);
        scalar::subtractRowProducts({a.data(), count + 2}, {b.data(), count + 1}, count, expected.data());
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
        {
            hwy::SetSupportedTargetsForTest(target);
            std::vector<double> block(9, 0.5);
            subtractRowProducts({a.data(), count + 2}, {b.data(), count + 1}, count, block.data());
            for (int e = 0; e < 9; ++e, ++compared)
                EXPECT_NEAR(block[e], expected[e], 1e-14) << hwy::TargetName(target);
        }
        hwy::SetSupportedTargetsForTest(0);
    }
    EXPECT_GE(compared, 54);
}

}  // namespace
}  // namespace bullet_fem
