// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/compliance_cache.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "fem/factor/rest_factor.h"
#include "fem/factor/rest_modes.h"
#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

constexpr double kSingle = 1e-5;    // 6e-8 of the factor's single precision times a condition of some 100
constexpr double kIterated = 1e-3;  // tolerance of columns on the low-memory path

bool sameBits(const Mat3& a, const Mat3& b)
{
    return squaredNorm(a - b) == 0;
}

class ComplianceCacheTest : public testing::TestWithParam<FactorChoice>
{
protected:
    static std::shared_ptr<const BodyModel> withChoice(const BodyModel& model, FactorInput input)
    {
        input.m_choice = GetParam();
        return BodyModel::create(model.sharedShape(), std::move(input));
    }

    static Body makeClampedBody()
    {
        Material material = elasticMaterial(1e5, 0.3);
        material.m_massDamping = 2;
        material.m_stiffnessDamping = 0.01;
        return makeBody(makeBox({1, 1, 1}, {3, 3, 3}), material, [](const Vec3& X) { return X.x == 0; });
    }

    static std::shared_ptr<const BodyModel> makeModel()
    {
        const auto model = makeClampedBody().m_model;
        return withChoice(*model, model->factorInput());
    }

    const double m_error = GetParam() == FactorChoice::full ? kSingle : kIterated;
    const std::shared_ptr<const BodyModel> m_model = makeModel();
    const std::vector<int>& m_surface = m_model->mesh().surfaceNodes();
};

TEST_P(ComplianceCacheTest, HoldsTheInverseOfA0)
{
    const FactorInput& input = m_model->factorInput();
    const Eigen::MatrixXd inverse = constrained(denseRestSystem(m_model->shape(), input), input.m_fixed).inverse();
    ComplianceCache cache(m_model);
    cache.request(m_surface);
    int compared = 0;
    for (int j : m_surface)
        for (int i : m_surface)
        {
            if (input.m_fixed[i] || input.m_fixed[j]) continue;
            const Eigen::Matrix3d expected = inverse.block<3, 3>(3 * i, 3 * j);
            const double size = inverse.block<3, 3>(3 * j, 3 * j).norm();
            ASSERT_LE((dense(cache.block(i, j)) - expected).norm(), m_error * size) << i << " " << j;
            ++compared;
        }
    EXPECT_EQ(compared, 40 * 40);  // 56 of 64 nodes on the surface, 16 of them clamped
}

TEST_P(ComplianceCacheTest, FactorsItsBlocksBetweenNodes)
{
    ComplianceCache cache(m_model);
    std::vector<int> nodes;
    for (int node : m_surface)
        if (!m_model->factorInput().m_fixed[node]) nodes.insert(nodes.begin(), node);
    const std::shared_ptr<const EnvelopeFactor> factor = cache.factorOf(nodes);
    ASSERT_EQ(factor->rows(), static_cast<int>(nodes.size()));
    std::vector<double> right(3 * nodes.size()), x;
    for (std::size_t i = 0; i < right.size(); ++i) right[i] = std::sin(1.0 + static_cast<double>(i));
    x = right;
    factor->solve(x.data());
    cache.request(nodes);
    double impulses = 0, size = 0;
    for (double value : x) impulses += std::fabs(value);
    for (int node : nodes) size = std::max(size, std::sqrt(squaredNorm(cache.block(node, node))));
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
        Vec3 v;
        for (std::size_t j = 0; j < nodes.size(); ++j)
            v += cache.block(nodes[k], nodes[j]) * Vec3{x[3 * j], x[3 * j + 1], x[3 * j + 2]};
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(v[i], right[3 * k + i], m_error * size * impulses);
    }
}

// A factor is shared by all requests for its set, until the budget is exceeded.
TEST_P(ComplianceCacheTest, KeepsFactorsWithinItsBudget)
{
    ComplianceCache cache(m_model);
    std::vector<int> nodes(m_surface.begin(), m_surface.begin() + 40);
    const std::weak_ptr<const EnvelopeFactor> first = cache.factorOf(nodes);
    EXPECT_EQ(cache.factorOf(nodes), first.lock());
    const std::size_t each = 2 * 9 * sizeof(double) * 40 * 41 / 2, most = NodeSetFactors::kBudget / each;
    std::size_t others = 0;
    while (!first.expired() && others < 2 * most)
    {
        std::next_permutation(nodes.begin(), nodes.end());
        cache.factorOf(nodes);
        ++others;
    }
    EXPECT_EQ(others, most);
}

TEST_P(ComplianceCacheTest, ServesTheNodesThatItIsMadeFor)
{
    const FactorInput& input = m_model->factorInput();
    const Eigen::MatrixXd inverse = constrained(denseRestSystem(m_model->shape(), input), input.m_fixed).inverse();
    const std::vector<int> nodes = {21, 22, 25, 26, 37, 63};  // all inside but for the last
    ComplianceCache cache(m_model, nodes);
    cache.request({25, 63, 21, 22, 26, 37});
    for (int j : nodes)
        for (int i : nodes)
        {
            const Eigen::Matrix3d expected = inverse.block<3, 3>(3 * i, 3 * j);
            const double size = inverse.block<3, 3>(3 * j, 3 * j).norm();
            EXPECT_LE((dense(cache.block(i, j)) - expected).norm(), m_error * size) << i << " " << j;
        }
}

TEST_P(ComplianceCacheTest, HasTheSameBitsOnAnyThreads)
{
    ComplianceCache alone(m_model);
    alone.request(m_surface);
    for (const int count : {1, 2, 3, 8})
    {
        const Threads threads(count);
        for (int repeat = 0; repeat < 5; ++repeat)
        {
            ComplianceCache cache(m_model);
            cache.request(m_surface, &threads);
            for (int j : m_surface)
                for (int i : m_surface) ASSERT_TRUE(sameBits(cache.block(i, j), alone.block(i, j))) << i << " " << j;
        }
    }
}

TEST_P(ComplianceCacheTest, IsZeroForFixedNodes)
{
    ComplianceCache cache(m_model);
    cache.request(m_surface);
    int zero = 0;
    for (int j : m_surface)
        for (int i : m_surface) zero += sameBits(cache.block(i, j), Mat3());
    EXPECT_EQ(zero, 56 * 56 - 40 * 40);
}

// One node at a time: the budget is two columns, so that each is evicted soon and solved again, bitwise equal.
TEST_P(ComplianceCacheTest, GivesTheSameNumbersAfterEviction)
{
    ComplianceCache all(m_model), small(m_model, 0);
    all.request(m_surface);
    for (int round = 0; round < 3; ++round)
        for (int j : m_surface)
        {
            small.request({j});
            for (int i : m_surface) ASSERT_TRUE(sameBits(small.block(i, j), all.block(i, j))) << i << " " << j;
        }
}

// Bodies that share a cache request different nodes in each step.
TEST_P(ComplianceCacheTest, SolvesEveryColumnOnceWithinItsBudget)
{
    ComplianceCache cache(m_model), small(m_model, 0);
    for (int step = 0; step < 2; ++step)
        for (const int node : m_surface)
            for (ComplianceCache* c : {&cache, &small}) c->request({node});
    EXPECT_EQ(cache.solvedColumns(), static_cast<long>(m_surface.size()));
    EXPECT_EQ(small.solvedColumns(), 2 * static_cast<long>(m_surface.size()));
}

// Columns of one request never evict each other, whatever the cache held before.
TEST_P(ComplianceCacheTest, KeepsAllColumnsOfARequest)
{
    ComplianceCache all(m_model), small(m_model, 0);
    all.request(m_surface);
    const int n = static_cast<int>(m_surface.size());
    for (int first = 0; first < n; ++first)
    {
        std::vector<int> nodes;
        for (int k = 0; k < 5; ++k) nodes.push_back(m_surface[(first * 7 + k * 11) % n]);
        small.request(nodes);
        for (int j : nodes)
            for (int i : nodes) ASSERT_TRUE(sameBits(small.block(i, j), all.block(i, j))) << i << " " << j;
    }
}

// A budget of ten columns, all in use; the request names the oldest of them before four new ones.
TEST_P(ComplianceCacheTest, DoesNotEvictRequestedColumns)
{
    ComplianceCache cache(m_model, 0);
    std::vector<std::vector<int>> requests = {{0, 1, 2, 3, 4}, {5, 6, 7, 8, 9}, {0, 10, 11, 12, 13}};
    for (std::vector<int>& nodes : requests)
    {
        for (int& node : nodes) node = m_surface[4 * node + 1];
        cache.request(nodes);
    }
    ComplianceCache all(m_model);
    all.request(m_surface);
    for (int j : requests.back()) EXPECT_TRUE(sameBits(cache.block(j, j), all.block(j, j))) << j;
}

TEST_P(ComplianceCacheTest, TakesRepeatedNodesAndNone)
{
    ComplianceCache all(m_model), cache(m_model);
    all.request(m_surface);
    const int a = m_surface[30], b = m_surface[50];
    cache.request({});
    cache.request({a, a, b, a, b});
    EXPECT_TRUE(sameBits(cache.block(a, b), all.block(a, b)));
    EXPECT_TRUE(sameBits(cache.block(b, a), all.block(b, a)));
    const std::vector<int> many(3 * m_surface.size(), a);  // more than there are nodes
    cache.request(many);
    EXPECT_TRUE(sameBits(cache.block(b, a), all.block(b, a)));
}

TEST_P(ComplianceCacheTest, DoesNotAllocateForRequestsNoLargerThanBefore)
{
    ComplianceCache cache(m_model);
    std::vector<int> nodes(m_surface.begin() + 10, m_surface.begin() + 20);
    cache.request(nodes);
    const AllocationCounter counter;
    for (std::size_t k = 0; k < m_surface.size(); ++k)
    {
        for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = m_surface[(3 * i + k) % m_surface.size()];
        cache.request(nodes);
        cache.request(nodes);
    }
    EXPECT_EQ(counter.count(), 0);
}

// For any mass: blocks scale as 1 / kg, and single precision keeps its digits.
TEST_P(ComplianceCacheTest, ScalesWithTheMass)
{
    const int a = m_surface[30], b = m_surface[50];
    ComplianceCache cache(m_model);
    cache.request({a, b});
    for (const double scale : {1e-8, 1e8})
    {
        Material material = m_model->shape().m_material;
        material.m_youngModulus *= scale;
        FactorInput input = m_model->factorInput();
        for (double& m : input.m_mass) m *= scale;
        ComplianceCache scaled(
            BodyModel::create(std::make_shared<const RestShape>(m_model->mesh(), material), std::move(input)));
        scaled.request({a, b});
        const Mat3 expected = (1 / scale) * cache.block(a, b);
        EXPECT_LE(squaredNorm(scaled.block(a, b) - expected), m_error * m_error * squaredNorm(expected)) << scale;
    }
}

TEST_P(ComplianceCacheTest, IsZeroForAFullyFixedBody)
{
    FactorInput input = m_model->factorInput();
    input.m_fixed.assign(input.m_fixed.size(), 1);
    ComplianceCache cache(withChoice(*m_model, input));
    cache.request(m_surface);
    EXPECT_TRUE(sameBits(cache.block(m_surface[0], m_surface[1]), Mat3()));
}

// A plate of 27 g, with its rest modes, whose elastic compliance is 1e-7 of its rigid response: sweeps over an
// indefinite compliance diverge.
TEST_P(ComplianceCacheTest, IsDefiniteForAStiffLightBody)
{
    Material material = elasticMaterial(1e8, 0.3);
    material.m_density = 10;
    material.m_massDamping = 2;
    const auto made = makeBody(makeBox({0.3, 0.3, 0.03}, {6, 6, 1}), material, {}, 0.05).m_model;
    const auto model = withChoice(*made, made->factorInput());
    const int lower = 49;
    std::vector<int> nodes(lower);
    std::iota(nodes.begin(), nodes.end(), 0);
    ComplianceCache cache(model);
    cache.request(nodes);
    Eigen::MatrixXd W(3 * lower, 3 * lower);
    for (int i = 0; i < 3 * lower; ++i)
        for (int j = 0; j < 3 * lower; ++j)
            W(i, j) = cache.block(i / 3, j / 3)(i % 3, j % 3) + model->restModes().response(i / 3, j / 3)(i % 3, j % 3);
    const Eigen::MatrixXd A0 = denseRestSystem(model->shape(), model->factorInput());
    const Eigen::MatrixXd expected = A0.inverse().topLeftCorner(3 * lower, 3 * lower);
    const auto least = [](const Eigen::MatrixXd& m)
    { return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (m + m.transpose())).eigenvalues()[0]; };
    EXPECT_GT(least(W), 0.3 * least(expected));
    EXPECT_LT((W - expected).norm(), 1e-6 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(Factors, ComplianceCacheTest, testing::Values(FactorChoice::full, FactorChoice::lowMemory),
                         [](const auto& factor) { return factor.param == FactorChoice::full ? "full" : "lowMemory"; });

}  // namespace
}  // namespace bullet_fem
