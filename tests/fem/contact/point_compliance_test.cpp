// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/point_compliance.h"

#include <random>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/body/step_scratch.h"
#include "fem/contact/compliance/compliance_cache.h"
#include "fem/contact/compliance/compliance_kernel.h"
#include "fem/scenes/element_case.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

std::vector<float> randomFloats(std::size_t count, unsigned seed)
{
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<float> result(count);
    for (float& x : result) x = uniform(engine);
    return result;
}

class ComplianceKernel : public OnTarget
{
};

// All nodes, and some of them: memory before and behind them is not written.
TEST_P(ComplianceKernel, RotatesColumnsAsItsScalarReference)
{
    constexpr std::size_t kNodes = 21, kStride = 3 * kNodes + 2;
    const std::vector<float> blocks = randomFloats(9 * kNodes, 1),
                             rotations = randomFloats(3 * kColumnOfRotation * kNodes, 2);
    std::vector<int> offsets;
    for (std::size_t i = 0; i < kNodes; ++i) offsets.push_back(static_cast<int>(9 * ((7 * i) % kNodes)));
    for (const auto& [first, end] :
         {std::pair<std::size_t, std::size_t>(0, kNodes), {7, kNodes}, {3, 4}, {5, 5}, {0, 11}})
    {
        const RestColumn column{
            blocks.data(), offsets.data(), rotations.data(), first, end, kStride, {1, -2, 3, 4, 5, -6, 7, 8, 9}};
        std::vector<float> out(3 * kStride, 99.f), expected = out;
        turnColumn(column, out.data());
        scalar::turnColumn(column, expected.data());
        for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i], expected[i], 1e-5 * 9) << first << " " << i;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < kStride; ++k)
                EXPECT_EQ(out[c * kStride + k] == 99.f, k < 3 * first || k >= 3 * end) << c << " " << k;
    }
}

INSTANTIATE_TEST_SUITE_P(EveryTarget, ComplianceKernel, testing::ValuesIn(availableTargets()), targetName);

/// A box that is clamped at one end and bent; one of its free nodes has been fixed since.
class PointComplianceTest : public testing::Test
{
protected:
    PointComplianceTest()
        : m_body(makeBody(makeBox({2, 1, 1}, {4, 2, 2}), elasticMaterial(1e5, 0.3),
                          [](const Vec3& X) { return X.x == 0; })),
          m_cache(makeComplianceCache(m_body.m_model))
    {
        for (Vec3& x : m_body.m_state.m_x) x = {x.x, x.y + 0.2 * x.x * x.x, x.z - 0.1 * x.x * x.y};
        for (int node : m_body.m_model->mesh().surfaceNodes())
            (m_body.m_state.m_fixed[node] ? m_clamped : m_free).push_back(node);
        m_body.m_state.m_fixed[m_free.back()] = 1;
        m_held = m_free.back();
        m_free.pop_back();
        solveFreeMotion(m_body, StepSettings());
    }

    static SurfacePoint point(const std::vector<int>& nodes, const std::vector<double>& weights)
    {
        SurfacePoint result;
        result.m_body = 0;
        result.m_count = static_cast<int>(nodes.size());
        std::copy(nodes.begin(), nodes.end(), result.m_nodes.begin());
        std::copy(weights.begin(), weights.end(), result.m_weights.begin());
        return result;
    }

    // Forms W of the points, with one slot of its own after theirs.
    void form(PointCompliance& W, const std::vector<SurfacePoint>& points, double scale)
    {
        W.clear(m_body.m_state.m_x.size());
        for (const SurfacePoint& p : points) W.add(p);
        W.addOwn();
        W.numberSlots();
        W.request({&m_body, m_cache.get()});
        W.form({&m_body, m_cache.get()}, scale, sharesOf(W));
    }

    std::vector<RigidMomentum::Share> sharesOf(const PointCompliance& W) const
    {
        std::vector<RigidMomentum::Share> shares;
        const Mat3 whole = Mat3::identity();
        for (int node : W.nodes())
            shares.push_back(m_body.m_workspace.scratch().m_momentum.shareOf(m_body, &node, &whole, 1));
        return shares;
    }

    // The oracle: the preconditioner itself, which is that factor rotated with the nodes.
    Vec3 expected(const SurfacePoint& to, const SurfacePoint& from, int axis) const
    {
        std::vector<Vec3> in(m_body.m_state.m_x.size()), out = in;
        for (int a = 0; a < from.m_count; ++a) in[from.m_nodes[a]][axis] += from.m_weights[a];
        WarpedPreconditioner(m_body).apply(in, out);
        return to.of(out);
    }

    Body m_body;
    std::shared_ptr<ComplianceCache> m_cache;
    std::vector<int> m_free, m_clamped;
    int m_held = -1;
};

TEST_F(PointComplianceTest, MatchesTheRotatedFactorBetweenPoints)
{
    const std::vector<SurfacePoint> points = {
        point({m_free[0]}, {1}), point({m_free[5], m_free[9], m_free[20]}, {.2, .3, .5}),
        point({m_free[20], m_free[5], m_free[20], m_free[7], m_free[8]}, {.15, .45, .1, 0, .3}),
        point({m_clamped[0], m_free[3], m_held}, {.5, .4, .1}), point({m_clamped[1]}, {1})};
    constexpr double kScale = 2.5;
    PointCompliance W;
    for (int repeat = 0; repeat < 2; ++repeat)  // results of the last call are overwritten
    {
        form(W, points, 1);
        W.scaleElastic(kScale);
    }
    const double size = std::sqrt(squaredNorm(W.block(0, 0)));
    ASSERT_GT(size, 0);
    for (int f = 0; f < 5; ++f)
        for (int e = 0; e < 5; ++e)
            for (const Mat3& w : {W.block(f, e), W.elasticBlock(f, e)})
                for (int c = 0; c < 3; ++c)
                {
                    const Vec3 column = {w(0, c), w(1, c), w(2, c)};
                    EXPECT_LE(norm(column - kScale * expected(points[f], points[e], c)), 1e-5 * size) << f << e << c;
                }
    EXPECT_EQ(squaredNorm(W.block(4, 4)), 0);  // clamped
    for (int e = 0; e < 6; ++e) EXPECT_EQ(squaredNorm(W.block(5, e)) + squaredNorm(W.block(e, 5)), 0);
    W.set(3 * static_cast<std::size_t>(W.slot(5)) + 1, 3 * static_cast<std::size_t>(W.slot(0)), 7);
    EXPECT_EQ(W.block(5, 0)(1, 0), 7);
    EXPECT_EQ(W.block(0, 5)(0, 1), 7);
}

TEST_F(PointComplianceTest, ReadsAndMovesSlotsAsThePointsDo)
{
    const std::vector<SurfacePoint> points = {point({m_free[0]}, {1}),
                                              point({m_free[5], m_free[9], m_free[20]}, {.2, .3, .5})};
    PointCompliance W;
    form(W, points, 1);
    std::vector<double> velocity(W.order());
    const Vec3 impulse = {1, -2, 3};
    W.forEachSlot(1,
                  [&](int slot, double weight)
                  {
                      const Response response = W.response(slot, weight * impulse);
                      addResponses(&response, 1, W.order(), velocity.data());
                  });
    for (int e = 0; e < 3; ++e)
        EXPECT_LE(norm(W.read(e, velocity) - W.block(e, 1) * impulse), 1e-6 * norm(W.block(1, 1) * impulse)) << e;
    EXPECT_GT(norm(W.read(0, velocity)), 0);
}

// A free body's points move with 1 / m + r x I^-1 r', without the rounding of single precision.
TEST(PointCompliance, MovesPointsOfAFreeBodyRigidly)
{
    Body body(makeBody(makeBox({2, 1, 1}, {4, 2, 2}), elasticMaterial(1e5, 0.3)));
    for (Vec3& x : body.m_state.m_x) x = {x.x, x.y + 0.2 * x.x * x.x, x.z - 0.1 * x.x * x.y};
    solveFreeMotion(body, StepSettings());
    const std::shared_ptr<ComplianceCache> cache = makeComplianceCache(body.m_model);
    SurfacePoint edge;
    edge.m_body = 0;
    edge.m_count = 2;
    edge.m_nodes = {body.m_model->mesh().surfaceNodes()[0], body.m_model->mesh().surfaceNodes()[9]};
    edge.m_weights = {0.25, 0.75};
    PointCompliance W;
    W.clear(body.m_state.m_x.size());
    W.add(edge);
    W.numberSlots();
    W.request({&body, cache.get()});
    const RigidMomentum& momentum = body.m_workspace.scratch().m_momentum;
    const Mat3 whole = Mat3::identity();
    std::vector<RigidMomentum::Share> shares;
    for (int node : W.nodes()) shares.push_back(momentum.shareOf(body, &node, &whole, 1));
    W.form({&body, cache.get()}, 1, shares);

    const std::vector<Vec3>& x = body.m_workspace.scratch().m_kickPosition;
    double mass = 0;
    Vec3 center;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        mass += body.m_state.m_mass[i];
        center += body.m_state.m_mass[i] * x[i];
    }
    center = (1 / mass) * center;
    Mat3 inertia;
    for (std::size_t i = 0; i < x.size(); ++i)
        inertia += body.m_state.m_mass[i] * transposeTimes(crossMatrix(x[i] - center), crossMatrix(x[i] - center));
    const Mat3 r = crossMatrix(edge.of(x) - center);
    const Mat3 expected = (1 / mass) * whole + transposeTimes(r, inverse(inertia) * r);
    const Mat3 rigid = W.rigid(0).block(W.rigid(0));
    EXPECT_LE(std::sqrt(squaredNorm(rigid - expected)), 1e-12 * std::sqrt(squaredNorm(expected)));
    EXPECT_LE(std::sqrt(squaredNorm(W.block(0, 0) - rigid - W.elasticBlock(0, 0))), 1e-6);
    EXPECT_GT(std::sqrt(squaredNorm(W.elasticBlock(0, 0))), 0);
    std::vector<double> velocity(W.order());
    const Vec3 impulse = {1, -2, 3};
    W.addRigid({W.rigid(0).response(impulse)}, velocity);
    EXPECT_LE(norm(W.read(0, velocity) - expected * impulse), 1e-12 * norm(expected * impulse));
}

TEST_F(PointComplianceTest, IsSymmetricHoweverManyPoints)
{
    PointCompliance W;
    const int count = static_cast<int>(m_free.size());
    ASSERT_GT(count, 16);
    std::vector<SurfacePoint> points;
    for (int k = 0; k < count; ++k) points.push_back(point({m_free[k], m_free[(k + 7) % count]}, {.625, .375}));
    form(W, points, 1);
    const double size = std::sqrt(squaredNorm(W.block(0, 0)));
    for (int f = 0; f < count; ++f)
        for (int e = 0; e < f; ++e)
            EXPECT_LE(std::sqrt(squaredNorm(W.elasticBlock(f, e) - transpose(W.elasticBlock(e, f)))), 5e-7 * size)
                << f << " " << e;
}

}  // namespace
}  // namespace bullet_fem
