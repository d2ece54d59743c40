// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Going back in time, and continuing from there.
#include "tools/scene/scene_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/scene_run.h"

namespace bullet_fem
{
namespace
{

const char* const kFallingBall = R"({ "step": 0.01, "softBodies": [
    { "name": "cube", "mesh": { "box": [0.4, 0.4, 0.4], "tets": 100 }, "material": "rubber", "position": [0, 0.25, 0] }],
    "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } },
                    { "name": "ball", "shape": { "sphere": 0.1 }, "mass": 2, "position": [0.03, 0.62, 0], "velocity": [0.6, 0, 0] }] })";

/// Positions of all nodes and rigid bodies.
std::vector<Vec3> placesIn(SceneRun& run)
{
    std::vector<Vec3> places;
    for (int i = 0; i < run.nodeCount(0); ++i) places.push_back(run.node(0, i));
    for (int i = 0; i < run.m_world.rigidCount(); ++i)
        places.push_back(vec3(run.m_world.rigid(i).getWorldTransform().getOrigin()));
    return places;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double distance = 0;
    for (std::size_t i = 0; i < a.size(); ++i) distance = std::max(distance, norm(a[i] - b[i]));
    return distance;
}

class SceneHistoryTest : public testing::Test
{
protected:
    void begin(int stepsBetween, std::size_t maxBytes)
    {
        m_history = std::make_unique<SceneHistory>(m_run.m_world, SceneHistorySettings{stepsBetween, maxBytes});
    }
    void steps(int count)
    {
        for (int k = 0; k < count; ++k)
        {
            m_history->step();
            m_seen.resize(std::max<std::size_t>(m_seen.size(), m_run.m_world.steps() + 1));
            m_seen[m_run.m_world.steps()] = placesIn(m_run);
        }
    }
    double awayFrom(int step) { return farthest(placesIn(m_run), m_seen[step]); }

    SceneRun m_run{kFallingBall};
    std::unique_ptr<SceneHistory> m_history;
    std::vector<std::vector<Vec3>> m_seen = {placesIn(m_run)};  // by number of steps
};

TEST_F(SceneHistoryTest, LeadsBackAndForthToTheBit)
{
    begin(10, 1u << 28u);
    steps(35);
    EXPECT_EQ(m_history->count(), 4) << "at 0, 10, 20 and 30";
    EXPECT_FALSE(m_history->isPast());
    EXPECT_FALSE(m_history->later());
    for (const int step : {30, 20, 10, 0})
    {
        ASSERT_TRUE(m_history->earlier());
        EXPECT_TRUE(m_history->isPast());
        EXPECT_EQ(m_run.m_world.steps(), step);
        EXPECT_NEAR(m_run.m_world.time(), 0.01 * step, 1e-12);
        EXPECT_EQ(awayFrom(step), 0);
        EXPECT_NEAR(m_history->until(), 0.35, 1e-12);
    }
    EXPECT_FALSE(m_history->earlier());
    EXPECT_EQ(awayFrom(0), 0) << "nothing has changed";
    for (const int step : {10, 20, 30, 35})
    {
        ASSERT_TRUE(m_history->later());
        EXPECT_EQ(awayFrom(step), 0);
    }
    EXPECT_FALSE(m_history->isPast()) << "the present was kept when it was left";
    EXPECT_FALSE(m_history->later());
}

// During an impact: the ball is on the cube, the cube on the ground.
TEST_F(SceneHistoryTest, RunsOnAsItDidBefore)
{
    begin(10, 1u << 28u);
    steps(50);
    ASSERT_TRUE(m_history->earlier() && m_history->earlier());
    ASSERT_EQ(m_run.m_world.steps(), 30);
    const std::vector<std::vector<Vec3>> before = m_seen;
    steps(20);
    EXPECT_LT(farthest(m_seen[50], before[50]), 2e-4) << "contacts of rigid bodies restart without warm start";
    EXPECT_GT(farthest(m_seen[30], m_seen[50]), 2e-2) << "it moves meanwhile";
}

TEST_F(SceneHistoryTest, StepDiscardsLaterStates)
{
    begin(10, 1u << 28u);
    steps(40);
    ASSERT_TRUE(m_history->earlier() && m_history->earlier());
    EXPECT_EQ(m_history->count(), 5);
    steps(1);
    EXPECT_EQ(m_run.m_world.steps(), 21);
    EXPECT_EQ(m_history->count(), 3) << "at 0, 10 and 20";
    EXPECT_FALSE(m_history->later());
    ASSERT_TRUE(m_history->earlier());
    EXPECT_EQ(m_run.m_world.steps(), 20);
}

TEST_F(SceneHistoryTest, KeepsItsMemoryInBounds)
{
    begin(1, 1u << 28u);
    steps(4);
    const std::size_t bound = m_history->bytes() + 4096;  // five states, with contacts
    begin(1, bound);
    steps(30);
    EXPECT_LE(m_history->bytes(), bound);
    EXPECT_GE(m_history->count(), 2) << "states in contact are larger";
    EXPECT_LE(m_history->count(), 5);
    EXPECT_NEAR(m_history->since(), m_run.m_world.time() - 0.01 * (m_history->count() - 1), 1e-9) << "the newest ones";
    const int count = m_history->count();
    int back = 0;
    while (m_history->earlier()) ++back;
    EXPECT_EQ(back, count - 1);
    EXPECT_LE(m_history->bytes(), bound);

    begin(1, 100);
    steps(3);
    EXPECT_EQ(m_history->count(), 0) << "one state is larger than that";
    EXPECT_FALSE(m_history->earlier());
    EXPECT_EQ(m_history->bytes(), 0u);
}

TEST_F(SceneHistoryTest, RestartsIfBodiesAreAdded)
{
    begin(5, 1u << 28u);
    steps(12);
    const SceneState before = stateOf(m_run.m_world);
    SceneRigidBody box;
    box.m_mass = 1;
    box.m_pose.m_position = {2, 3, 0};
    m_run.m_world.add(box);
    EXPECT_THROW(restore(before, m_run.m_world), std::invalid_argument) << "it has a body more now";
    m_history->clear();
    EXPECT_EQ(m_history->count(), 1);
    EXPECT_FALSE(m_history->earlier());
    steps(20);
    EXPECT_LT(m_run.m_world.rigid(2).getWorldTransform().getOrigin().y(), 2.9);
    while (m_history->earlier())
    {
    }
    EXPECT_EQ(m_run.m_world.steps(), 12);
    EXPECT_NEAR(m_run.m_world.rigid(2).getWorldTransform().getOrigin().y(), 3, 1e-6);
}

// A muscle contracts at .1 s: its activation follows the time, also after going back.
TEST(SceneHistoryActuators, ActuatorsHaveTheValuesOfTheTime)
{
    SceneRun run(R"({ "step": 0.01, "gravity": [0, 0, 0], "softBodies": [{ "name": "bar",
        "mesh": { "box": [0.4, 0.1, 0.1], "cell": 0.05 }, "material": { "young": 1e5, "poisson": 0.3, "stiffnessDamping": 0.02 } }],
        "actuators": [{ "kind": "fibres", "body": "bar", "direction": [1, 0, 0], "activation": [[0, 0], [0.1, 0], [0.11, 2e4]] }] })");
    const auto length = [&]
    {
        double longest = 0;
        for (int i = 0; i < run.nodeCount(0); ++i) longest = std::max(longest, norm(run.node(0, i) - run.node(0, 0)));
        return longest;
    };
    SceneHistory history(run.m_world, {5, 1u << 28u});
    const double start = length();
    for (int k = 0; k < 40; ++k) history.step();
    const double drawn = length();
    EXPECT_LT(drawn, 0.95 * start);
    while (history.earlier())
    {
    }
    EXPECT_EQ(run.m_world.steps(), 0);
    for (int k = 0; k < 9; ++k) history.step();
    EXPECT_NEAR(length(), start, 1e-5) << "not drawn yet";
    for (int k = 0; k < 31; ++k) history.step();
    EXPECT_NEAR(length(), drawn, 1e-3 * start);
}

}  // namespace
}  // namespace bullet_fem
