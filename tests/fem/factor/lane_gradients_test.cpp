// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Conjugate gradients for sixteen right-hand sides at a time, and their vector operations.
#include "fem/factor/lane_gradients.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/element_case.h"

namespace bullet_fem
{
namespace
{

constexpr double kSingleRounding = 1e-6;  // some rounding errors of single precision

// A block fixed on one side, with a number of nodes that is no multiple of sixteen.
std::shared_ptr<const BodyModel> makeModel(double young = 1e6, double poisson = 0.3)
{
    const Body body = makeBody(makeBox({1, 1, 1}, {4, 3, 3}), elasticMaterial(young, poisson),
                               [](const Vec3& X) { return X.x == 0; });
    FactorInput input = body.m_model->factorInput();
    input.m_choice = FactorChoice::lowMemory;
    return BodyModel::create(body.m_model->sharedShape(), input);
}

class LaneGradientsTest : public OnTarget
{
protected:
    using Lanes = Eigen::Matrix<float, Eigen::Dynamic, kPanelLanes, Eigen::RowMajor>;  // the memory layout

    Lanes randomLanes(unsigned seed) const
    {
        RandomVectors random(seed);
        Lanes lanes(m_size, int(kPanelLanes));
        for (int i = 0; i < lanes.rows(); ++i)
            for (int k = 0; k < kPanelLanes; ++k) lanes(i, k) = static_cast<float>(random.next().x);
        return lanes;
    }

    // A0 over the free nodes in the factor's order, from the textbook formula.
    Eigen::MatrixXd orderedA0() const { return ordered(*m_model); }
    static Eigen::MatrixXd ordered(const BodyModel& model)
    {
        const Eigen::MatrixXd all = denseRestSystem(model.shape(), model.factorInput());
        const RestFactor& factor = model.factor();
        Eigen::MatrixXd A0(factor.lower().size(), factor.lower().size());
        for (int i = 0; i < model.nodeCount(); ++i)
            for (int j = 0; j < model.nodeCount(); ++j)
                if (factor.position(i) >= 0 && factor.position(j) >= 0)
                    A0.block<3, 3>(3 * factor.position(i), 3 * factor.position(j)) = all.block<3, 3>(3 * i, 3 * j);
        return A0;
    }

    static AlignedFloats aligned(const Lanes& lanes)
    {
        AlignedFloats floats = allocateFloats(lanes.size());
        std::copy(lanes.data(), lanes.data() + lanes.size(), floats.get());
        return floats;
    }

    // A0^-1 times the lanes, by conjugate gradients of a model.
    static Lanes solved(const BodyModel& model, const Lanes& rightSide, double tolerance)
    {
        const RestFactor& factor = model.factor();
        AlignedFloats y = aligned(rightSide), scratch = allocateFloats(factor.lower().laneScratchSize());
        LaneGradients gradients(model);
        gradients.solve(tolerance, y.get(), scratch.get());
        return Eigen::Map<const Lanes>(y.get(), rightSide.rows(), int(kPanelLanes));
    }

    const std::shared_ptr<const BodyModel> m_model = makeModel();
    const int m_size = m_model->factor().lower().size();
};

TEST_P(LaneGradientsTest, MultiplyByA0)
{
    const Lanes p = randomLanes(1), before = randomLanes(2);
    const AlignedFloats pFloats = aligned(p), q = aligned(before);
    const LaneVectors v = {m_size / 3, nullptr, nullptr, pFloats.get(), q.get()};
    const LaneNumbers pq = multiplyLanes(m_model->factor().rest(), v);
    const Eigen::MatrixXd expected = before.cast<double>() + orderedA0() * p.cast<double>();
    const Lanes found = Eigen::Map<const Lanes>(q.get(), m_size, int(kPanelLanes));
    EXPECT_LE((found.cast<double>() - expected).norm(), kSingleRounding * expected.norm());
    for (int k = 0; k < kPanelLanes; ++k)
        EXPECT_NEAR(pq.m[k], expected.col(k).dot(p.col(k).cast<double>()), kSingleRounding * expected.norm() * p.norm())
            << k;
}

TEST_P(LaneGradientsTest, MoveEveryLaneByItsOwnStep)
{
    const Lanes x = randomLanes(1), r = randomLanes(2), p = randomLanes(3), q = randomLanes(4);
    const AlignedFloats xf = aligned(x), rf = aligned(r), pf = aligned(p), qf = aligned(q);
    const LaneVectors v = {m_size / 3, xf.get(), rf.get(), pf.get(), qf.get()};
    LaneNumbers step;
    for (int k = 0; k < kPanelLanes; ++k) step.m[k] = 0.1 * k;
    const LaneNumbers rq = dotLanes(v);
    advanceLanes(v, step);
    const auto lanes = [&](const AlignedFloats& f)
    { return Eigen::Map<const Lanes>(f.get(), m_size, int(kPanelLanes)); };
    for (int k = 0; k < kPanelLanes; ++k)
    {
        const float a = static_cast<float>(step.m[k]);
        EXPECT_NEAR(rq.m[k], r.col(k).cast<double>().dot(q.col(k).cast<double>()),
                    kSingleRounding * r.norm() * q.norm());
        EXPECT_LE((lanes(xf).col(k) - x.col(k) - a * p.col(k)).norm(), kSingleRounding * x.norm()) << k;
        EXPECT_LE((lanes(rf).col(k) - r.col(k) + a * q.col(k)).norm(), kSingleRounding * x.norm()) << k;
        EXPECT_EQ((lanes(qf).col(k) - lanes(rf).col(k)).norm(), 0) << k;
    }
    const Lanes residual = lanes(rf);
    turnLanes(v, step);
    for (int k = 0; k < kPanelLanes; ++k)
        EXPECT_LE((lanes(pf).col(k) - residual.col(k) - static_cast<float>(step.m[k]) * p.col(k)).norm(),
                  kSingleRounding * x.norm())
            << k;
    EXPECT_EQ(lanes(qf).norm(), 0);
}

// In the energy norm, and up to twice the tolerance at slow convergence; the scalar factor alone has an error of 40 to
// 90 %.
TEST_P(LaneGradientsTest, SolveToTheTolerance)
{
    for (const double young : {1e4, 1e6, 1e8})
        for (const double poisson : {0.3, 0.45})
            for (const double tolerance : {1e-2, 1e-3})
            {
                const auto model = makeModel(young, poisson);
                const Eigen::MatrixXd A0 = ordered(*model);
                Lanes unit = Lanes::Zero(m_size, int(kPanelLanes));
                for (int k = 0; k < kPanelLanes; ++k) unit(7 * k, k) = 1;
                const Eigen::MatrixXd expected = A0.llt().solve(unit.cast<double>());
                const Eigen::MatrixXd error = solved(*model, unit, tolerance).cast<double>() - expected;
                for (int k = 0; k < kPanelLanes; ++k)
                    EXPECT_LE(error.col(k).dot(A0 * error.col(k)),
                              4 * tolerance * tolerance * expected.col(k).dot(A0 * expected.col(k)))
                        << k << " " << young << " " << poisson << " " << tolerance;
            }
}

TEST_P(LaneGradientsTest, DoNotLetLanesActOnEachOther)
{
    const Lanes all = randomLanes(5);
    Lanes some = Lanes::Zero(m_size, int(kPanelLanes));
    some.col(3) = all.col(11);
    some.col(4) = 1e6f * all.col(2);
    const Lanes a = solved(*m_model, all, 1e-3), b = solved(*m_model, some, 1e-3);
    EXPECT_EQ((b.col(3) - a.col(11)).norm(), 0);
    EXPECT_EQ(b.col(0).norm(), 0);
    EXPECT_GT(b.col(4).norm(), 0);
}

// Without a finite step length the last iterate is kept, and no NaN appears.
TEST_P(LaneGradientsTest, LeaveNoNaNOnBreakdown)
{
    Lanes extreme = randomLanes(6);
    extreme.col(0) *= 1e30f;
    extreme.col(1) *= 1e-30f;
    EXPECT_TRUE(solved(*m_model, extreme, 1e-3).allFinite());
}

INSTANTIATE_TEST_SUITE_P(Targets, LaneGradientsTest, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
