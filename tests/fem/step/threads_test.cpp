// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/common/threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <functional>
#include <thread>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

const int g_counts[] = {1, 2, 3, 8};

class ThreadCount : public testing::TestWithParam<int>
{
protected:
    /// Without oneTBB only the calling thread runs.
#ifdef BULLETFEM_WITH_TBB
    static int expected()
    {
        return GetParam();
    }
#else
    static int expected()
    {
        return 1;
    }
#endif

    /// The threads for which a condition is true.
    template <class Condition>
    int countTogether(const Condition& isTrue) const
    {
        std::atomic<int> present{0}, count{0};
        m_threads.run(expected(),
                      [&](int)
                      {
                          count += isTrue();
                          ++present;
                          while (present < expected()) std::this_thread::yield();
                      });
        return count;
    }

    const Threads m_threads{GetParam()};
};

TEST_P(ThreadCount, IsTheOneAskedFor)
{
    EXPECT_EQ(m_threads.count(), expected());
}

TEST_P(ThreadCount, EveryTaskIsDoneOnce)
{
    for (const int tasks : {0, 1, 2, 7, 1000})
    {
        std::vector<std::atomic<int>> done(tasks);
        m_threads.run(tasks, [&](int k) { ++done[k]; });
        for (int k = 0; k < tasks; ++k) EXPECT_EQ(done[k], 1) << k << " of " << tasks;
    }
}

TEST_P(ThreadCount, TasksMayHaveTasks)
{
    std::atomic<int> sum{0};
    m_threads.gather(
        [&]
        {
            for (int round = 0; round < 20; ++round)
                m_threads.run(5, [&](int a) { m_threads.run(9, [&](int b) { sum += 9 * a + b; }); });
        });
    EXPECT_EQ(sum, 20 * 44 * 45 / 2);
}

// More nested task groups than the pool's slots for them.
TEST_P(ThreadCount, PartsMayLieDeepWithinEachOther)
{
    std::atomic<int> leaves{0};
    const std::function<void(int)> descend = [&](int depth)
    {
        if (depth == 0)
            ++leaves;
        else
            m_threads.run(2, [&](int k) { descend(k == 0 ? depth - 1 : 0); });
    };
    descend(100);
    EXPECT_EQ(leaves, 101);
}

TEST_P(ThreadCount, ThrowingTasksLoseNoOthers)
{
    std::vector<std::atomic<int>> done(50);
    std::string what;
    try
    {
        m_threads.run(50,
                      [&](int k)
                      {
                          ++done[k];
                          if (k % 10 == 3) throw std::runtime_error("task " + std::to_string(k));
                      });
    }
    catch (const std::runtime_error& error)
    {
        what = error.what();
    }
    EXPECT_EQ(what, "task 3");
    for (const std::atomic<int>& count : done) EXPECT_EQ(count, 1);
    m_threads.run(50, [&](int k) { ++done[k]; });  // the pool still works
    for (const std::atomic<int>& count : done) EXPECT_EQ(count, 2);
}

TEST_P(ThreadCount, ThrowingOutOfAGatheringEndsIt)
{
    EXPECT_THROW(m_threads.gather([] { throw std::runtime_error("over"); }), std::runtime_error);
    std::atomic<int> done{0};
    m_threads.gather([&] { m_threads.run(8, [&](int) { ++done; }); });
    EXPECT_EQ(done, 8);
}

TEST_P(ThreadCount, SeveralThreadsMayShareThem)
{
    std::atomic<int> sum{0};
    std::vector<std::thread> users;
    for (int u = 0; u < 3; ++u)
        users.emplace_back(
            [&]
            {
                for (int round = 0; round < 50; ++round) m_threads.run(10, [&](int k) { sum += k; });
            });
    for (std::thread& user : users) user.join();
    EXPECT_EQ(sum, 3 * 50 * 45);
}

// As many tasks as threads, each of which waits for all others.
TEST_P(ThreadCount, TheyWorkAtTheSameTime)
{
    EXPECT_EQ(countTogether([] { return true; }), expected());
}

TEST_P(ThreadCount, TasksInheritTheRoundingMode)
{
    const auto roundsUp = [] { return std::fegetround() == FE_UPWARD; };
    EXPECT_EQ(countTogether(roundsUp), 0);  // all tasks have started before the caller changes it
    const int before = std::fegetround();
    ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
    const int upward = countTogether(roundsUp);
    std::fesetround(before);
    EXPECT_EQ(upward, expected());
    EXPECT_EQ(countTogether(roundsUp), 0);
}

INSTANTIATE_TEST_SUITE_P(Counts, ThreadCount, testing::ValuesIn(g_counts));

TEST(Threads, RejectInvalidCounts)
{
    expectRejected([] { Threads(-1); }, {"-1", "[0, 256]", "1 is the caller's"});
    expectRejected([] { Threads(257); }, {"257", "[0, 256]"});
    EXPECT_GE(Threads(0).count(), 1);
    EXPECT_EQ(Threads().count(), 1);
}

/// A body of 10,240 tetrahedra, bent and twisted; at a free body elements are in patches.
struct SharedCase
{
    const char* m_name;
    Warp m_warp;
    double m_tolerance;
    bool m_clamped;
};

class SharedBody : public testing::TestWithParam<SharedCase>
{
protected:
    static std::shared_ptr<const BodyModel> model(bool clamped)
    {
        static const auto make = [](bool held)
        {
            return makeBody(makeBox({4, 1, 1}, {32, 8, 8}), elasticMaterial(1e6, held ? 0.3 : 0.45),
                            [held](const Vec3& X) { return held && X.x == 0; })
                .m_model;
        };
        static const std::shared_ptr<const BodyModel> models[] = {make(false), make(true)};
        return models[clamped];
    }

    /// Ten steps with impulses and a position correction.
    static BodyState run(const Threads* threads)
    {
        Body body(model(GetParam().m_clamped));
        setGravity(body, {0, 0, -9.81});
        for (std::size_t i = 0; i < body.m_state.m_v.size(); ++i)
        {
            const Vec3& x = body.m_state.m_x[i];
            body.m_state.m_v[i] = x.x * Vec3{0, -2 * x.z, 2 * x.y};
        }
        StepSettings settings;
        settings.m_warp = GetParam().m_warp;
        settings.m_tolerance = GetParam().m_tolerance;
        settings.m_threads = threads;
        std::vector<Vec3> impulses(body.m_state.m_x.size());
        impulses.back() = {0, 1, 2};
        for (int k = 0; k < 10; ++k)
        {
            solveFreeMotion(body, settings);
            applyImpulses(body, impulses, settings);
            applyPositionCorrection(body, impulses, settings);
            finishStep(body, settings);
        }
        return body.m_state;
    }
};

TEST_P(SharedBody, MovesBitForBitAsOnOneThread)
{
    const BodyState alone = run(nullptr);
    for (const int count : g_counts)
    {
        const Threads threads(count);
        const BodyState shared = run(&threads);
        EXPECT_EQ(largestDistance(shared.m_x, alone.m_x), 0) << count;
        EXPECT_EQ(largestDistance(shared.m_v, alone.m_v), 0) << count;
    }
}

INSTANTIATE_TEST_SUITE_P(Bodies, SharedBody,
                         testing::Values(SharedCase{"Clamped", Warp::nodal, 1e-3, true},
                                         SharedCase{"Free", Warp::nodal, 1e-3, false},
                                         SharedCase{"Global", Warp::global, 1e-3, true},
                                         SharedCase{"Double", Warp::nodal, 1e-7, false}),
                         [](const auto& suite) { return suite.param.m_name; });

TEST(Threads, OneAllocatesNothing)
{
    const Threads one(1);
    Body body = makeBody(makeBox({2, 1, 1}, {12, 6, 6}), elasticMaterial(1e6, 0.3));
    setGravity(body, {0, 0, -9.81});
    StepSettings settings;
    settings.m_threads = &one;
    const AllocationCounter counter;
    for (int k = 0; k < 5; ++k) step(body, settings);
    EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace bullet_fem
