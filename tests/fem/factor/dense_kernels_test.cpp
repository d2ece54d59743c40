// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/dense_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fem/common/vector_targets.h"

#include <hwy/highway.h>

#include "fem/scenes/reference_kernels.h"

namespace bullet_fem
{
namespace
{

using Eigen::MatrixXd;

constexpr double kGuard = 1e300;  // guard value behind each block

std::vector<std::int64_t> targetsHere()
{
    std::vector<std::int64_t> targets;
    for (int bit = 0; bit < 63; ++bit)
    {
        const std::int64_t target = std::int64_t{1} << bit;
        if (target & HWY_TARGETS & hwy::SupportedTargets()) targets.push_back(target);
    }
    return targets;
}

// Dispatches to one target during its lifetime.
class OnlyTarget
{
public:
    explicit OnlyTarget(std::int64_t target) { allow(target); }
    ~OnlyTarget() { allow(0); }
    OnlyTarget(const OnlyTarget&) = delete;
    OnlyTarget& operator=(const OnlyTarget&) = delete;

private:
    static void allow(std::int64_t target)
    {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
};

MatrixXd randomMatrix(int rows, int columns, unsigned seed)
{
    std::srand(seed);
    return MatrixXd::Random(rows, columns);
}

// Condition below 10.
MatrixXd positiveDefinite(int n, unsigned seed)
{
    const MatrixXd B = randomMatrix(n, n, seed);
    return B * B.transpose() / n + MatrixXd::Identity(n, n);
}

// A front and its scratch, with guards behind each block.
struct Front
{
    int m_pivots, m_rows;
    std::vector<double> m_A11, m_A21, m_A22, m_scratch;

    Front(const MatrixXd& A, int pivots) : m_pivots(pivots), m_rows(static_cast<int>(A.rows()) - pivots)
    {
        MatrixXd lower = A;
        lower.triangularView<Eigen::StrictlyUpper>().setConstant(7);  // must not be read
        m_A11 = guarded(lower.topLeftCorner(m_pivots, m_pivots));
        m_A21 = guarded(lower.bottomLeftCorner(m_rows, m_pivots));
        m_A22 = guarded(lower.bottomRightCorner(m_rows, m_rows));
        m_scratch.assign(eliminationScratch(m_pivots, m_rows) + 1, kGuard);
    }

    DenseFront view() { return {m_pivots, m_rows, m_A11.data(), m_A21.data(), m_A22.data()}; }
    MatrixXd A11() const { return Eigen::Map<const MatrixXd>(m_A11.data(), m_pivots, m_pivots); }
    MatrixXd A21() const { return Eigen::Map<const MatrixXd>(m_A21.data(), m_rows, m_pivots); }
    MatrixXd lowerA22() const
    {
        return Eigen::Map<const MatrixXd>(m_A22.data(), m_rows, m_rows).triangularView<Eigen::Lower>();
    }
    bool guardsStand() const
    {
        return m_A11.back() == kGuard && m_A21.back() == kGuard && m_A22.back() == kGuard && m_scratch.back() == kGuard;
    }

private:
    static std::vector<double> guarded(const MatrixXd& block)
    {
        std::vector<double> values(block.data(), block.data() + block.size());
        values.push_back(kGuard);
        return values;
    }
};

class DenseKernels : public testing::TestWithParam<std::int64_t>
{
    const OnlyTarget m_target{GetParam()};
};

TEST_P(DenseKernels, ProductMatchesItsPlainReference)
{
    for (bool lowerOnly : {false, true})
        for (int m : {1, 2, 7, 8, 9, 16, 17, 24, 25, 53})
            for (int n : {1, 3, 4, 5, 8, 9, 31})
                for (int k : {1, 2, 12, 40})
                {
                    if (lowerOnly && n > m) continue;
                    const MatrixXd U = randomMatrix(m + 3, k, 1), V = randomMatrix(n + 1, k, 2);
                    MatrixXd C = randomMatrix(m + 2, n + 1, 3), expected = C;
                    const MatrixXd before = C;
                    std::vector<double> scratch(productScratch(m, n, k) + 1, kGuard);
                    const DenseProduct product = {m,        n,     k,     U.data(), V.data(),
                                                  C.data(), m + 3, n + 1, m + 2,    lowerOnly};
                    DenseProduct plain = product;
                    plain.m_C = expected.data();
                    subtractProduct(product, scratch.data());
                    reference::subtractProduct(plain);
                    MatrixXd difference = (C - expected).topRows(m).leftCols(n);
                    if (lowerOnly) difference = MatrixXd(difference.triangularView<Eigen::Lower>());
                    EXPECT_LE(difference.cwiseAbs().maxCoeff(), 1e-14 * k) << m << " " << n << " " << k;
                    EXPECT_EQ(C.bottomRows(2), before.bottomRows(2)) << m << " " << n << " " << k;
                    EXPECT_EQ(C.rightCols(1), before.rightCols(1)) << m << " " << n << " " << k;
                    EXPECT_EQ(scratch.back(), kGuard) << m << " " << n << " " << k;
                }
}

// Sizes below and above those of vectors, tiles and blocks.
TEST_P(DenseKernels, EliminationMatchesItsPlainReference)
{
    for (int p : {0, 1, 3, 11, 12, 13, 24, 30, 95, 96, 97, 99, 200})
        for (int r : {0, 1, 3, 8, 9, 24, 27, 60})
        {
            const MatrixXd A = positiveDefinite(p + r, 5);
            Front front(A, p), expected(A, p);
            double pivotValue = 0;
            EXPECT_EQ(eliminatePivots(front.view(), front.m_scratch.data(), pivotValue), -1);
            EXPECT_EQ(reference::eliminatePivots(expected.view(), pivotValue), -1);
            EXPECT_LE((front.A11() - expected.A11()).norm(), 1e-13 * p) << p << " " << r;
            EXPECT_LE((front.A21() - expected.A21()).norm(), 1e-13 * p) << p << " " << r;
            EXPECT_LE((front.lowerA22() - expected.lowerA22()).norm(), 1e-13 * p) << p << " " << r;
            EXPECT_EQ(front.A11(), front.A11().transpose()) << p << " " << r;
            EXPECT_TRUE(front.guardsStand()) << p << " " << r;
        }
}

TEST_P(DenseKernels, EliminationNamesTheNonPositivePivot)
{
    for (int failing : {0, 5, 11, 12, 50, 95, 96, 130, 199})
        for (double value :
             {-2.0, 0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        {
            MatrixXd A = MatrixXd::Identity(220, 220);
            A(failing, failing) = value;
            Front front(A, 200), plain(A, 200);
            double pivotValue = 17;
            EXPECT_EQ(eliminatePivots(front.view(), front.m_scratch.data(), pivotValue), failing);
            EXPECT_EQ(std::to_string(pivotValue), std::to_string(value));  // NaN is not equal to itself
            EXPECT_EQ(reference::eliminatePivots(plain.view(), pivotValue), failing);
        }
}

INSTANTIATE_TEST_SUITE_P(Targets, DenseKernels, testing::ValuesIn(targetsHere()),
                         [](const auto& suite) {
                             return "Bit" + std::to_string(hwy::Num0BitsBelowLS1Bit_Nonzero64(
                                                static_cast<std::uint64_t>(suite.param)));
                         });

// [4 2; 2 5]: 1/4, 1/2 and 5 - 1.
TEST(DenseKernelsPlain, OnePivotMatchesHandValues)
{
    double A11 = 4, A21 = 2, A22 = 5, pivotValue = 0;
    EXPECT_EQ(reference::eliminatePivots({1, 1, &A11, &A21, &A22}, pivotValue), -1);
    EXPECT_DOUBLE_EQ(A11, 0.25);
    EXPECT_DOUBLE_EQ(A21, 0.5);
    EXPECT_DOUBLE_EQ(A22, 4);
    EXPECT_DOUBLE_EQ(pivotValue, 4);
}

TEST(DenseKernelsPlain, EliminationIsInverseQuotientAndSchurComplement)
{
    const int p = 10, r = 7;
    const MatrixXd A = positiveDefinite(p + r, 9);
    Front front(A, p);
    double pivotValue = 0;
    EXPECT_EQ(reference::eliminatePivots(front.view(), pivotValue), -1);
    const MatrixXd S = A.topLeftCorner(p, p).llt().solve(MatrixXd::Identity(p, p)), A21 = A.bottomLeftCorner(r, p);
    const MatrixXd schur = A.bottomRightCorner(r, r) - A21 * S * A21.transpose();
    EXPECT_LE((front.A11() - S).norm(), 1e-13);
    EXPECT_LE((front.A21() - A21 * S).norm(), 1e-13);
    EXPECT_LE((front.lowerA22() - MatrixXd(schur.triangularView<Eigen::Lower>())).norm(), 1e-13);
}

}  // namespace
}  // namespace bullet_fem
