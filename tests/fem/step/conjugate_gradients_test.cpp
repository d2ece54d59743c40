// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <limits>

#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

/// A dense matrix as a linear operator.
class DenseOperator : public LinearOperator
{
public:
    explicit DenseOperator(Eigen::MatrixXd A) : m_A(std::move(A)) {}
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override { out = nodes(m_A * flat(in)); }

private:
    Eigen::MatrixXd m_A;
};

/// An operator that returns a wrong result in a chosen application, counted from 0.
class LyingOperator : public LinearOperator
{
public:
    LyingOperator(const LinearOperator& honest, int when, std::function<Vec3(const Vec3&)> lie)
        : m_honest(honest), m_when(when), m_lie(std::move(lie))
    {
    }
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override
    {
        m_honest.apply(in, out);
        if (m_count++ == m_when)
            for (Vec3& value : out) value = m_lie(value);
    }

private:
    const LinearOperator& m_honest;
    int m_when;
    std::function<Vec3(const Vec3&)> m_lie;
    mutable int m_count = 0;
};

/// Counts its applications.
class CountingOperator : public LinearOperator
{
public:
    CountingOperator(const LinearOperator& A, int& count) : m_A(A), m_count(count) {}
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override
    {
        m_A.apply(in, out);
        ++m_count;
    }

private:
    const LinearOperator& m_A;
    int& m_count;
};

class ConjugateGradients : public testing::Test
{
protected:
    static constexpr int kNodes = 12;

    SolveReport solve(const LinearOperator& A, const LinearOperator& P)
    {
        return solveConjugateGradients({A, P, m_b, m_x, m_scratch}, m_stop);
    }
    SolveReport solve() { return solve(m_A, m_identity); }

    double trueResidual() const { return (flat(m_b) - m_matrix * flat(m_x)).norm() / flat(m_b).norm(); }
    double error() const { return largestDistance(m_x, m_solution); }
    bool isFinite() const { return flat(m_x).allFinite(); }

    std::vector<Vec3> randomNodes(unsigned seed) const
    {
        RandomVectors random(seed);
        std::vector<Vec3> u(kNodes);
        for (Vec3& ui : u) ui = random.next();
        return u;
    }

    const Eigen::MatrixXd m_matrix = gridMatrix(6).topLeftCorner(3 * kNodes, 3 * kNodes);
    const DenseOperator m_A{m_matrix};
    const DenseOperator m_identity{Eigen::MatrixXd::Identity(3 * kNodes, 3 * kNodes)};
    const DenseOperator m_inverse{m_matrix.inverse()};
    const std::vector<Vec3> m_solution = randomNodes(1);
    std::vector<Vec3> m_b = nodes(m_matrix * flat(m_solution));
    std::vector<Vec3> m_x = std::vector<Vec3>(kNodes);
    ConjugateGradientStop m_stop{1e-10, 0, 200};
    ConjugateGradientScratch m_scratch{kNodes};
};

TEST_F(ConjugateGradients, FindsTheSolution)
{
    const SolveReport report = solve();
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_GT(report.m_iterations, 1);
    EXPECT_LE(report.m_iterations, 3 * kNodes);
    EXPECT_LE(report.m_residual, 1e-10);
    EXPECT_LE(error(), 1e-8);  // the tolerance times a condition below 100
}

TEST_F(ConjugateGradients, ConvergesInOneIterationWithTheInverse)
{
    const SolveReport report = solve(m_A, m_inverse);
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_EQ(report.m_iterations, 1);
    EXPECT_LE(error(), 1e-12);
}

// A scaled inverse is equally good: the step length is optimal.
TEST_F(ConjugateGradients, IsInvariantToPreconditionerScale)
{
    EXPECT_EQ(solve(m_A, DenseOperator(1e-7 * m_matrix.inverse())).m_iterations, 1);
    EXPECT_LE(error(), 1e-12);
}

// k distinct eigenvalues need k iterations.
TEST_F(ConjugateGradients, ConvergesInAsManyIterationsAsDistinctEigenvalues)
{
    Eigen::VectorXd d(3 * kNodes);
    for (int i = 0; i < 3 * kNodes; ++i) d(i) = 1 + i % 4;
    const SolveReport report = solve(DenseOperator(d.asDiagonal()), m_identity);
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_EQ(report.m_iterations, 4);
}

TEST_F(ConjugateGradients, ReportsTheTrueResidual)
{
    for (const int budget : {1, 2, 5, 200})
    {
        m_stop.m_maxIterations = budget;
        m_x.assign(kNodes, Vec3());
        const SolveReport report = solve();
        EXPECT_NEAR(report.m_residual, trueResidual(), 1e-3 * trueResidual() + 1e-15) << budget;
    }
}

TEST_F(ConjugateGradients, StopsAtTheBudgetAndReportsIt)
{
    m_stop.m_maxIterations = 3;
    const SolveReport report = solve();
    EXPECT_EQ(report.m_stop, SolveStop::budget);
    EXPECT_EQ(report.m_iterations, 3);
    EXPECT_GT(report.m_residual, 1e-10);
    EXPECT_LT(report.m_residual, 1);
}

TEST_F(ConjugateGradients, StopsAtTheToleranceNotBelow)
{
    m_stop.m_tolerance = 1e-2;
    const int loose = solve().m_iterations;
    EXPECT_GT(trueResidual(), 1e-6);
    m_x.assign(kNodes, Vec3());
    m_stop.m_tolerance = 1e-6;
    EXPECT_GT(solve().m_iterations, loose);
}

TEST_F(ConjugateGradients, MeasuresASmallRightSideAgainstTheFloor)
{
    m_stop.m_tolerance = 1e-3;
    m_stop.m_floor = 1e3 * flat(m_b).norm();
    SolveReport report = solve();
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_EQ(report.m_iterations, 0);
    EXPECT_EQ(flat(m_x).norm(), 0);

    m_stop.m_floor = 10 * flat(m_b).norm();
    report = solve();
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_GT(report.m_iterations, 0);
    EXPECT_LE(report.m_residual, 1e-2);
    EXPECT_GT(report.m_residual, 1e-5);
}

TEST_F(ConjugateGradients, StartsFromTheGuess)
{
    const int cold = solve().m_iterations;
    m_x = m_solution;
    EXPECT_EQ(solve().m_iterations, 0);
    EXPECT_EQ(error(), 0);

    const std::vector<Vec3> other = randomNodes(2);
    for (int i = 0; i < kNodes; ++i) m_x[i] += 1e-6 * other[i];
    const SolveReport warm = solve();
    EXPECT_LT(warm.m_iterations, cold);
    EXPECT_EQ(warm.m_stop, SolveStop::converged);
    EXPECT_LE(error(), 1e-8);
}

// An initial guess that is right up to its length costs no iteration; one in a wrong direction is as good as none.
TEST_F(ConjugateGradients, ScalesTheGuessByItsOptimalLength)
{
    const int cold = solve().m_iterations;
    for (const double length : {1e-3, 0.5, 40.0})
    {
        for (int i = 0; i < kNodes; ++i) m_x[i] = length * m_solution[i];
        const SolveReport report = solve();
        EXPECT_LE(report.m_iterations, 1) << length;  // rounding of the scaled guess may leave one
        EXPECT_LE(error(), 1e-9) << length;
    }
    for (int i = 0; i < kNodes; ++i) m_x[i] = -1e6 * m_solution[i];
    EXPECT_EQ(solve().m_iterations, cold);
    EXPECT_LE(error(), 1e-8);
}

// Otherwise its error would be carried from step to step.
TEST_F(ConjugateGradients, AcceptsAGuessOnlyAtATenthOfTheTolerance)
{
    m_stop.m_tolerance = 1e-2;
    m_stop.m_maxIterations = 2;
    const std::vector<Vec3> other = randomNodes(3);
    const auto guessWithResidual = [&](double share)
    {
        const Eigen::VectorXd residual = share * flat(m_b).norm() * flat(other).normalized();
        m_x = nodes(m_matrix.inverse() * (flat(m_b) - residual));
        return solve().m_iterations;
    };
    EXPECT_EQ(guessWithResidual(0.5e-3), 0);
    EXPECT_GT(guessWithResidual(5e-3), 0);
}

// Below eight iterations and at loose tolerances the recurrence is trusted: no product is spent on a true residual.
TEST_F(ConjugateGradients, SpendsNoProductOnTheTrueResidualAtLooseTolerances)
{
    m_stop.m_tolerance = 1e-2;
    int products = 0;
    const CountingOperator A(m_A, products);
    const SolveReport report = solve(A, DenseOperator(m_matrix.inverse()));
    EXPECT_EQ(report.m_iterations, 1);
    EXPECT_EQ(products, 1);
    EXPECT_NEAR(report.m_residual, trueResidual(), 1e-9);
}

TEST_F(ConjugateGradients, DoesNothingWithoutARightSide)
{
    m_b.assign(kNodes, Vec3());
    const SolveReport report = solve();
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_EQ(report.m_iterations, 0);
    EXPECT_EQ(report.m_residual, 0);
    EXPECT_EQ(flat(m_x).norm(), 0);
}

TEST_F(ConjugateGradients, BringsAWrongGuessBackToZero)
{
    m_b.assign(kNodes, Vec3());
    m_x = m_solution;
    m_stop.m_floor = 1;
    EXPECT_EQ(solve().m_stop, SolveStop::converged);
    EXPECT_LE(flat(m_x).norm(), 1e-9);
}

TEST_F(ConjugateGradients, BreaksDownForANonPositiveSystem)
{
    const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(3 * kNodes, 3 * kNodes);
    for (const Eigen::MatrixXd& bad : {Eigen::MatrixXd(-m_matrix), zero})
    {
        SolveReport report = solve(DenseOperator(bad), m_identity);
        EXPECT_EQ(report.m_stop, SolveStop::breakdown);
        EXPECT_EQ(report.m_iterations, 0);
        EXPECT_EQ(flat(m_x).norm(), 0);
        EXPECT_DOUBLE_EQ(report.m_residual, 1);

        report = solve(m_A, DenseOperator(bad));
        EXPECT_EQ(report.m_stop, SolveStop::breakdown);
        EXPECT_EQ(flat(m_x).norm(), 0);
    }
}

// One negative eigenvalue: the iterate before the breakdown is kept.
TEST_F(ConjugateGradients, KeepsTheLastIterateOnBreakdown)
{
    Eigen::MatrixXd indefinite = m_matrix;
    indefinite(5, 5) = -1;
    const SolveReport report = solve(DenseOperator(indefinite), m_identity);
    EXPECT_EQ(report.m_stop, SolveStop::breakdown);
    EXPECT_GT(report.m_iterations, 0);
    EXPECT_TRUE(isFinite());
    EXPECT_LT(report.m_residual, 1);
}

TEST_F(ConjugateGradients, NeverPropagatesNaN)
{
    const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
    for (const double value : bad)
        for (const int when : {0, 1, 3})
        {
            const auto lie = [value](const Vec3&) { return Vec3{value, value, value}; };
            m_x.assign(kNodes, Vec3());
            EXPECT_EQ(solve(LyingOperator(m_A, when, lie), m_identity).m_stop, SolveStop::breakdown) << when;
            EXPECT_TRUE(isFinite()) << when;
            m_x.assign(kNodes, Vec3());
            EXPECT_EQ(solve(m_A, LyingOperator(m_identity, when, lie)).m_stop, SolveStop::breakdown) << when;
            EXPECT_TRUE(isFinite()) << when;
        }
}

// A right-hand side that is not finite is never reported as converged, and x is unchanged.
TEST_F(ConjugateGradients, NeverReportsConvergenceForANonFiniteRightSide)
{
    const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
    for (const double value : bad)
    {
        m_b[4].y = value;
        m_x.assign(kNodes, Vec3());
        EXPECT_EQ(solve().m_stop, SolveStop::breakdown) << value;
        EXPECT_EQ(flat(m_x).norm(), 0) << value;
    }
}

// A's second application has an error of 1 %, so that the recurrence's residual differs from the true one; the solver
// detects it, restarts, and converges.
TEST_F(ConjugateGradients, ChecksTheRecurrenceAgainstTheTrueResidual)
{
    const LyingOperator A(m_A, 1, [](const Vec3& value) { return Vec3{1.01 * value.x, value.y, value.z}; });
    const SolveReport report = solve(A, m_identity);
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_LE(trueResidual(), 1.001e-10);
}

TEST_F(ConjugateGradients, GivesTheSameBitsEveryTime)
{
    solve();
    const std::vector<Vec3> first = m_x;
    m_x.assign(kNodes, Vec3());
    m_scratch.m_p = m_scratch.m_z = m_solution;  // its initial contents do not matter
    solve();
    EXPECT_EQ(largestDistance(first, m_x), 0);
}

TEST(NodeVectors, DotProductMatchesHandValue)
{
    EXPECT_EQ(dot(std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}, std::vector<Vec3>{{1, 0, -1}, {2, 1, 0}}), 11);
}

}  // namespace
}  // namespace bullet_fem
