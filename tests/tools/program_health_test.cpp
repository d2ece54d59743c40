// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// bulletfem simulate reports faults of a run in its output and exit code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/temporary_folder.h"
#include "tools/program_run.h"

namespace bullet_fem
{
namespace
{

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A cube of 1 m on the ground, of a material with rho g H = `ratio` E.
std::string cube(double ratio, const std::string& rest = "")
{
    return R"({ "seconds": 1.5, "softBodies": [{ "name": "cube", "mesh": { "box": [1, 1, 1], "tets": 600 },
        "material": { "young": )" +
           std::to_string(9810 / ratio) + R"(, "poisson": 0.45, "law": "hooke" }, "position": [0, 0.5, 0] }],
        "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }])" +
           rest + " }";
}

class ProgramHealth : public testing::Test
{
protected:
    ProgramRun simulate(const std::string& scene, const std::string& options = "")
    {
        m_folder.write("scene.json", scene);
        return bulletfem("simulate '" + m_folder.path("scene.json") + "' --quiet --glb -o '" + m_folder.path("run") +
                         "' " + options);
    }

    TemporaryFolder m_folder;
};

// Under Hooke's law a cube crushed by its own weight inverts, and stays at rest so.
TEST_F(ProgramHealth, InvertedBodyIsReported)
{
    const ProgramRun run = simulate(cube(2), "--json");
    EXPECT_EQ(run.m_code, 3) << run.m_output;
    const json told = json::parse(run.m_output);
    ASSERT_GE(told["faults"].size(), 1u);
    EXPECT_EQ(told["faults"][0]["what"], "insideOut");
    EXPECT_EQ(told["faults"][0]["body"], "cube");
    EXPECT_GT(told["faults"][0]["elements"].get<int>(), 0);
    EXPECT_EQ(told["files"].size(), 1u) << "they are written all the same";
    bool isFlagged = false;
    for (const json& flag : told["flags"])
    {
        EXPECT_EQ(flag["body"], "cube");
        EXPECT_LE(flag["first"].get<double>(), flag["last"].get<double>());
        EXPECT_GE(flag["steps"].get<int>(), 1);
        if (flag["flag"] != "BT_FEM_INSIDE_OUT") continue;
        isFlagged = true;
        EXPECT_GT(flag["first"].get<double>(), 0.1) << "not before it falls in";
        EXPECT_NEAR(flag["last"].get<double>(), 1.5, 1e-9);
        EXPECT_THAT(flag["explanation"].get<std::string>(), HasSubstr("stiffer material"));
    }
    EXPECT_TRUE(isFlagged) << told["flags"];
    const ProgramRun shown = simulate(cube(2));
    EXPECT_EQ(shown.m_code, 3);
    EXPECT_THAT(shown.m_output, AllOf(HasSubstr("'cube' has "), HasSubstr("BT_FEM_INSIDE_OUT"), HasSubstr("cube: 0."),
                                      HasSubstr(" s to 1.5 s, in ")));
}

TEST_F(ProgramHealth, StandingBodyIsHealthy)
{
    const ProgramRun run = simulate(cube(0.1), "--json");
    EXPECT_EQ(run.m_code, 0) << run.m_output;
    EXPECT_TRUE(json::parse(run.m_output)["faults"].empty());
}

// A ball that starts inside a cube does not come out by itself.
TEST_F(ProgramHealth, BodyInsideAnotherIsReported)
{
    const std::string scene = R"({ "seconds": 0.2, "gravity": [0, 0, 0], "softBodies": [{ "name": "cube",
        "mesh": { "box": [1, 1, 1], "tets": 300 }, "material": "rubber" }],
        "rigidBodies": [{ "name": "seed", "shape": { "sphere": 0.1 } }] })";
    const ProgramRun run = simulate(scene, "--json");
    EXPECT_EQ(run.m_code, 3) << run.m_output;
    const json fault = json::parse(run.m_output)["faults"][0];
    EXPECT_EQ(fault["what"], "inside");
    EXPECT_EQ(fault["body"], "seed");
    EXPECT_EQ(fault["other"], "cube");
    EXPECT_NEAR(fault["depth"].get<double>(), 0.442, 0.01) << "of its point towards a corner";
    EXPECT_NEAR(fault["share"].get<double>() * std::cbrt(4. / 3 * 3.14159 * 1e-3), fault["depth"].get<double>(), 0.01);
}

// 60 steps are simulated between two frames; the flag is set in the first few only.
TEST_F(ProgramHealth, FlagBetweenTwoFramesIsReported)
{
    const std::string sunken = R"({ "seconds": 1, "framesPerSecond": 1, "softBodies": [{ "name": "sunken",
        "mesh": { "box": [1, 1, 1], "tets": 100 }, "material": "rubber", "position": [0, 0.45, 0] }],
        "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }] })";
    const ProgramRun run = simulate(sunken, "--json");
    EXPECT_EQ(run.m_code, 0) << run.m_output;
    const json told = json::parse(run.m_output);
    EXPECT_EQ(told["frames"], 2);
    ASSERT_EQ(told["flags"].size(), 1u);
    EXPECT_EQ(told["flags"][0]["flag"], "BT_FEM_PENETRATING");
    EXPECT_LT(told["flags"][0]["last"].get<double>(), 0.9);
}

TEST_F(ProgramHealth, ManyBodiesWithAFlagAreFewLines)
{
    const std::string many = R"({ "seconds": 0.05, "softBodies": [{ "name": "sunken",
        "mesh": { "box": [1, 1, 1], "tets": 40 }, "material": "rubber", "position": [0, 0.46, 0],
        "copies": { "count": [12, 1, 1], "spacing": [2, 0, 0] } }],
        "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }] })";
    const ProgramRun run = simulate(many);
    EXPECT_THAT(run.m_output, AllOf(HasSubstr("sunken.9: "), Not(HasSubstr("sunken.10: ")), HasSubstr("and 2 more")));
}

}  // namespace
}  // namespace bullet_fem
