// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/batch/batch_memory.h"

#include <gtest/gtest.h>

#include <thread>

#include "fem/batch/batch_loan.h"
#include "fem/scenes/stepping_scenes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

std::shared_ptr<const BodyModel> smallModel()
{
    return makeBody(makeBox({1, 1, 1}, {2, 2, 2}), Material()).m_model;
}

TEST(BatchMemory, LendsReturnedArraysAgain)
{
    BatchMemory memory;
    const auto model = smallModel();
    const BatchArrays* arrays = &BatchLoan(memory, model).arrays();
    const AllocationCounter counter;
    for (int k = 0; k < 5; ++k) EXPECT_EQ(&BatchLoan(memory, model).arrays(), arrays);
    EXPECT_EQ(counter.count(), 0);
}

TEST(BatchMemory, LendsNothingTwiceAtATime)
{
    BatchMemory memory;
    const auto model = smallModel();
    BatchLoan first(memory, model), second(memory, model);
    EXPECT_NE(&first.arrays(), &second.arrays());
}

TEST(BatchMemory, LendsEveryModelItsOwn)
{
    BatchMemory memory;
    const auto a = smallModel(), b = smallModel();
    const BatchArrays* arrays = &BatchLoan(memory, a).arrays();
    EXPECT_EQ(&BatchLoan(memory, b).arrays().model(), b.get());
    EXPECT_EQ(&BatchLoan(memory, a).arrays(), arrays);
}

// A new model may have the address of a deleted one.
TEST(BatchMemory, ForgetsReleasedModels)
{
    BatchMemory memory;
    for (int k = 0; k < 20; ++k)
    {
        const auto model = makeBody(makeBox({1, 1, 1}, {1 + k % 3, 1, 1}), Material()).m_model;
        EXPECT_EQ(BatchLoan(memory, model).arrays().nodeCount(), model->nodeCount());
    }
}

TEST(BatchMemory, LendsToSeveralThreads)
{
    BatchMemory memory;
    const auto model = smallModel();
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back(
            [&, t]
            {
                for (int k = 0; k < 50; ++k)
                {
                    BatchLoan loan(memory, model);
                    loan.arrays().m_x[0] = t;
                    std::this_thread::yield();
                    EXPECT_EQ(loan.arrays().m_x[0], t);
                }
            });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace bullet_fem
