// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/batch/body_batches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "fem/batch/batch_arrays.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

/// Bodies of a model that may be batched and of one that may not, alternating until one kind runs out.
class BodyBatchesTest : public testing::Test
{
protected:
    void SetUp() override
    {
        if (!canBeBatched(*m_free)) GTEST_SKIP() << "this build has no vector kernels (BULLETFEM_VECTORS)";
    }

    void divide(int free, int hung, int threads, bool together = true)
    {
        m_bodies.clear();
        for (int k = 0; k < std::max(free, hung); ++k)
        {
            if (k < free) m_bodies.emplace_back(m_free);
            if (k < hung) m_bodies.emplace_back(m_hung);
        }
        std::vector<const Body*> bodies;
        for (const Body& body : m_bodies) bodies.push_back(&body);
        m_batches.divide(bodies, threads, together);
        expectEveryBodyOnce();
    }

    void expectEveryBodyOnce() const
    {
        std::set<int> seen;
        std::size_t count = 0;
        for (const Range& batch : m_batches.batches())
            for (int k = batch.m_begin; k < batch.m_end; ++k, ++count)
            {
                seen.insert(m_batches.order()[k]);
                EXPECT_EQ(modelAt(k), modelAt(batch.m_begin));
            }
        EXPECT_EQ(count, m_bodies.size());
        EXPECT_EQ(seen.size(), m_bodies.size());
    }

    const BodyModel* modelAt(int place) const { return m_bodies[m_batches.order()[place]].m_model.get(); }

    // The number of batches of that many bodies.
    int batchesOf(int bodies) const
    {
        const auto has = [bodies](const Range& batch) { return batch.m_end - batch.m_begin == bodies; };
        return static_cast<int>(std::count_if(m_batches.batches().begin(), m_batches.batches().end(), has));
    }

    const std::shared_ptr<const BodyModel> m_free = makeBody(makeBox({1, 1, 1}, {1, 1, 1}), Material()).m_model;
    const std::shared_ptr<const BodyModel> m_hung =
        makeBody(makeBox({1, 1, 1}, {1, 1, 1}), Material(), [](const Vec3& X) { return X.x == 0; }).m_model;
    std::vector<Body> m_bodies;
    BodyBatches m_batches;
};

TEST_F(BodyBatchesTest, OneModelMakesOneBatchForASingleThread)
{
    divide(40, 0, 1);
    EXPECT_EQ(batchesOf(40), 1);
}

TEST_F(BodyBatchesTest, BodiesAreAloneIfBatchingIsOff)
{
    for (const int threads : {1, 2})
    {
        divide(40, 3, threads, false);
        EXPECT_EQ(batchesOf(1), 43);
    }
}

// Batches of sixteen, and the remainder one by one, so that both threads end at about one time.
TEST_F(BodyBatchesTest, FillTheLanesAndShareOutTheRest)
{
    divide(100, 0, 2);
    EXPECT_EQ(batchesOf(kBatchWidth), 6);
    EXPECT_EQ(batchesOf(1), 4);
}

// A large remainder is a batch, too: it takes as long as a full one.
TEST_F(BodyBatchesTest, RemainingBodiesMakeABatch)
{
    divide(94, 0, 2);
    EXPECT_EQ(batchesOf(kBatchWidth), 5);
    EXPECT_EQ(batchesOf(14), 1);
}

TEST_F(BodyBatchesTest, LeaveNoThreadWithoutWork)
{
    divide(12, 0, 2);
    EXPECT_EQ(batchesOf(1), 12);
    divide(100, 0, 64);
    EXPECT_EQ(batchesOf(1), 100);
}

TEST_F(BodyBatchesTest, BodiesOfUnbatchableModelsAreAlone)
{
    ASSERT_FALSE(canBeBatched(*m_hung));
    divide(0, 50, 2);
    EXPECT_EQ(batchesOf(1), 50);
}

TEST_F(BodyBatchesTest, BeginWithTheLongOnes)
{
    divide(33, 40, 2);
    const std::vector<Range>& batches = m_batches.batches();
    const auto isShorter = [](const Range& a, const Range& b) { return a.m_end - a.m_begin > b.m_end - b.m_begin; };
    EXPECT_EQ(batchesOf(kBatchWidth), 2);
    EXPECT_TRUE(std::is_sorted(batches.begin(), batches.end(), isShorter));
}

TEST_F(BodyBatchesTest, MayBeNone)
{
    divide(0, 0, 2);
    EXPECT_TRUE(m_batches.batches().empty());
}

}  // namespace
}  // namespace bullet_fem
