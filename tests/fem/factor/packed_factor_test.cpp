// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/packed_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "fem/factor/rest_factor.h"
#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

constexpr double kSingleSolve = 1e-5;  // 6e-8 of single precision times a condition of some 100

// A box fixed at one side: its A0 over the free nodes in the factor's order, dense and packed.
class PackedSolve : public testing::TestWithParam<int>
{
protected:
    PackedSolve()
    {
        const FactorInput& input = m_model->factorInput();
        const Eigen::MatrixXd all = denseRestSystem(m_model->shape(), input);
        m_A.resize(m_packed.size(), m_packed.size());
        for (int i = 0; i < m_model->nodeCount(); ++i)
            for (int j = 0; j < m_model->nodeCount(); ++j)
                if (place(i) >= 0 && place(j) >= 0)
                    m_A.block<3, 3>(3 * place(i), 3 * place(j)) = all.block<3, 3>(3 * i, 3 * j);
        m_llt.compute(m_A);
    }

    int place(int node) const { return m_model->factor().position(node); }

    // |y - A^-1 b| / |A^-1 b| of one lane.
    double error(const float* y, const std::vector<float>& b, int lanes, int lane) const
    {
        Eigen::VectorXd right(m_packed.size()), got(m_packed.size());
        for (int i = 0; i < m_packed.size(); ++i)
        {
            right(i) = b[i * lanes + lane];
            got(i) = y[i * lanes + lane];
        }
        const Eigen::VectorXd expected = m_llt.solve(right);
        return (got - expected).norm() / expected.norm();
    }

    static std::vector<float> randomVector(std::size_t count, unsigned seed)
    {
        RandomVectors random(seed);
        std::vector<float> values(count);
        for (float& value : values) value = static_cast<float>(random.next().x);
        return values;
    }

    const std::shared_ptr<const BodyModel> m_model =
        makeBody(makeBox({1, 1, 1}, {GetParam(), GetParam(), GetParam()}), elasticMaterial(1e4, 0.3),
                 [](const Vec3& X) { return X.x == 0; })
            .m_model;
    const PackedFactor& m_packed = m_model->factor().lower();
    const std::size_t m_scratchSize = std::max(m_packed.scratchSize(), m_packed.laneScratchSize());
    AlignedFloats m_y = allocateFloats(m_packed.vectorSize() * kPanelLanes), m_scratch = allocateFloats(m_scratchSize);
    Eigen::MatrixXd m_A;
    Eigen::LLT<Eigen::MatrixXd> m_llt;
};

TEST_P(PackedSolve, SolvesOneRightSide)
{
    const std::vector<float> b = randomVector(m_packed.size(), 1);
    std::copy(b.begin(), b.end(), m_y.get());
    m_packed.solve(m_y.get(), m_scratch.get());
    EXPECT_LE(error(m_y.get(), b, 1, 0), kSingleSolve);
}

TEST_P(PackedSolve, SolvesSixteenEachForItself)
{
    const std::size_t count = static_cast<std::size_t>(m_packed.size()) * kPanelLanes;
    const std::vector<float> b = randomVector(count, 2);
    std::copy(b.begin(), b.end(), m_y.get());
    m_packed.solveLanes(m_packed.allSupernodes(), m_packed.allSupernodes(), m_y.get(), m_scratch.get());
    for (int lane = 0; lane < kPanelLanes; ++lane)
        EXPECT_LE(error(m_y.get(), b, kPanelLanes, lane), kSingleSolve) << lane;

    // The bits of a lane do not depend on the other lanes.
    AlignedFloats alone = allocateFloats(count);
    for (std::size_t i = 0; i < count; ++i) alone[i] = i % kPanelLanes == 5 ? b[i] : 0;
    m_packed.solveLanes(m_packed.allSupernodes(), m_packed.allSupernodes(), alone.get(), m_scratch.get());
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(alone[i], i % kPanelLanes == 5 ? m_y[i] : 0) << i;
}

// An impulse on one node, the response at another: a solve along the two nodes' paths to the root gives equal results.
TEST_P(PackedSolve, ASparseRightSideNeedsItsWayToTheRootAlone)
{
    const SupernodeTree& tree = m_packed.tree();
    const auto way = [&tree](int node)
    {
        int s = 0;
        while (tree.m_supernodes[s].m_first + tree.m_supernodes[s].m_columns <= node) ++s;
        std::vector<int> list;
        for (; s >= 0; s = tree.m_supernodes[s].m_parent) list.push_back(s);
        return list;
    };
    const std::size_t count = static_cast<std::size_t>(m_packed.size()) * kPanelLanes;
    const int pushed = 0, wanted = tree.m_nodeCount / 2;
    std::vector<float> b(count);
    for (int l = 0; l < kPanelLanes; ++l) b[3 * pushed * kPanelLanes + l] = 1;
    std::copy(b.begin(), b.end(), m_y.get());
    m_packed.solveLanes(way(pushed), way(wanted), m_y.get(), m_scratch.get());
    const std::vector<float> sparse(m_y.get() + 3 * wanted * kPanelLanes, m_y.get() + (3 * wanted + 3) * kPanelLanes);
    std::copy(b.begin(), b.end(), m_y.get());
    m_packed.solveLanes(m_packed.allSupernodes(), m_packed.allSupernodes(), m_y.get(), m_scratch.get());
    for (std::size_t k = 0; k < sparse.size(); ++k) EXPECT_EQ(sparse[k], m_y[3 * wanted * kPanelLanes + k]) << k;
}

TEST_P(PackedSolve, GivesTheSameBitsEveryTime)
{
    const std::vector<float> b = randomVector(m_packed.size(), 3);
    std::copy(b.begin(), b.end(), m_y.get());
    m_packed.solve(m_y.get(), m_scratch.get());
    const std::vector<float> first(m_y.get(), m_y.get() + m_packed.size());
    std::fill(m_scratch.get(), m_scratch.get() + m_scratchSize, 1e30f);  // its initial contents do not matter
    std::copy(b.begin(), b.end(), m_y.get());
    m_packed.solve(m_y.get(), m_scratch.get());
    EXPECT_EQ(first, std::vector<float>(m_y.get(), m_y.get() + m_packed.size()));
}

TEST_P(PackedSolve, GivesVectorsSideBySideTheirOwnBits)
{
    const AlignedFloats y = allocateFloats(m_packed.vectorSize() * kPanelLanes);
    const AlignedFloats scratch = allocateFloats(m_packed.batchScratchSize());
    const std::vector<float> b = randomVector(m_packed.size() * kPanelLanes, 5);
    std::copy(b.begin(), b.end(), y.get());
    m_packed.solveBatch(y.get(), scratch.get());
    for (int lane = 0; lane < kPanelLanes; ++lane)
    {
        for (int i = 0; i < m_packed.size(); ++i) m_y[i] = b[i * kPanelLanes + lane];
        m_packed.solve(m_y.get(), m_scratch.get());
        for (int i = 0; i < m_packed.size(); ++i) ASSERT_EQ(y[i * kPanelLanes + lane], m_y[i]) << i << ", " << lane;
    }
}

TEST_P(PackedSolve, TakesTheMemoryOfItsPaddedPanels)
{
    std::size_t bytes = 0;
    for (const Supernode& s : m_packed.tree().m_supernodes)
        bytes += sizeof(float) * 3 * s.m_columns * ((3 * (s.m_columns + s.m_rows) + 15) / 16 * 16);
    EXPECT_EQ(m_packed.byteCount(), bytes);
    EXPECT_GE(bytes, sizeof(float) * m_packed.tree().m_entries);
}

INSTANTIATE_TEST_SUITE_P(CellsOfABox, PackedSolve, testing::Values(1, 2, 4, 6));

TEST(PackedFactor, AnEmptyOneDoesNothing)
{
    const PackedFactor factor;
    EXPECT_EQ(factor.size(), 0);
    EXPECT_EQ(factor.byteCount(), 0u);
    float nothing = 7;
    factor.solve(&nothing, &nothing);
    EXPECT_EQ(nothing, 7);
}

}  // namespace
}  // namespace bullet_fem
