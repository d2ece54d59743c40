// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The history of flags, with their times.
#include "tools/scene/scene_flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "bullet_fem/btFemReports.h"
#include "tools/scene/scene_history.h"
#include "tools/scene_run.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;

/// A cube that starts 5 cm in the ground, which position correction resolves, and another one far from it.
const char* const kSunken = R"({ "step": 0.01, "softBodies": [
    { "name": "free", "mesh": { "box": [0.4, 0.4, 0.4], "tets": 100 }, "material": "rubber", "position": [5, 3, 0] },
    { "name": "sunken", "mesh": { "box": [1, 1, 1], "tets": 100 }, "material": "rubber", "position": [0, 0.45, 0] }],
    "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }] })";

TEST(SceneFlags, TellTheFirstAndTheLastStepWithAFlag)
{
    SceneRun run(kSunken);
    SceneFlags flags;
    double first = 0, last = 0;
    long steps = 0;
    while (run.m_world.time() < 0.5)
    {
        run.m_world.step();
        flags.look(run.m_world);
        if ((run.m_world.fem().stepReport(&run.m_world.soft(1)).m_flags & BT_FEM_PENETRATING) == 0) continue;
        ++steps;
        first = first > 0 ? first : run.m_world.time();
        last = run.m_world.time();
    }
    ASSERT_GT(steps, 1);
    EXPECT_LT(last, 0.45) << "it is raised only early";
    const std::vector<SceneFlag> all = flags.all();
    ASSERT_EQ(all.size(), 1u) << "of one body";
    EXPECT_EQ(all[0].m_body, "sunken");
    EXPECT_EQ(all[0].m_text->m_flag, BT_FEM_PENETRATING);
    EXPECT_EQ(all[0].m_first, first);
    EXPECT_EQ(all[0].m_last, last);
    EXPECT_EQ(all[0].m_steps, steps);
    EXPECT_THAT(all[0].when(), HasSubstr("0.01 s to "));
    EXPECT_THAT(all[0].when(), HasSubstr("in " + std::to_string(steps) + " steps"));
    EXPECT_THAT(all[0].explanation(), HasSubstr("deeper inside the body"));
}

TEST(SceneFlags, RevertedStepsAreForgotten)
{
    SceneRun run(kSunken);
    SceneHistory history(run.m_world, {10, 1u << 28u});
    SceneFlags flags;
    const auto step = [&]
    {
        history.step();
        flags.look(run.m_world);
    };
    for (int k = 0; k < 20; ++k) step();
    run.m_world.soft(0).m_nodes[0].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
    step();
    ASSERT_EQ(flags.all().back().m_text->m_flag, BT_FEM_RESTORED);
    ASSERT_TRUE(history.earlier());  // to step 20
    ASSERT_TRUE(history.earlier());  // to step 10
    step();
    const std::vector<SceneFlag> all = flags.all();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].m_text->m_flag, BT_FEM_PENETRATING);
    EXPECT_EQ(all[0].m_first, 0.01);
    EXPECT_LE(all[0].m_last, 0.11 + 1e-12);
    EXPECT_LE(all[0].m_steps, 11);
}

TEST(SceneFlags, SetUpFlagsTellTheReportsMessage)
{
    SceneFlag flag;
    flag.m_text = btFemFlagText::find(BT_FEM_NOT_SPLIT);
    EXPECT_EQ(flag.explanation(), flag.m_text->m_explanation);
    flag.m_message = "the factor would be too large";
    EXPECT_EQ(flag.explanation(),
              std::string(flag.m_text->m_explanation) + " The message: the factor would be too large");
    flag.m_first = flag.m_last = 0.25;
    flag.m_steps = 1;
    EXPECT_EQ(flag.when(), "0.25 s");
}

}  // namespace
}  // namespace bullet_fem
