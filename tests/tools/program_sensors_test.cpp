// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// bulletfem simulate prints the readings of a scene's sensors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/temporary_folder.h"
#include "tools/program_run.h"

namespace bullet_fem
{
namespace
{

using nlohmann::json;
using testing::HasSubstr;

// Two columns of 250 kg: one hangs from pins, the other from a static box.
std::string hangingScene(const std::string& sensors)
{
    return R"({ "softBodies": [
      { "name": "column", "mesh": { "box": [0.5, 1, 0.5], "cell": 0.25 },
        "material": { "young": 1e6, "density": 1000, "massDamping": 10 }, "pins": [{ "low": [-1, 0.5, -1], "high": [1, 0.5, 1] }] },
      { "name": "other", "mesh": { "box": [0.5, 1, 0.5], "cell": 0.25 }, "position": [3, 0, 0],
        "material": { "young": 1e6, "density": 1000, "massDamping": 10 } }],
      "rigidBodies": [{ "name": "hook", "shape": { "box": [0.5, 0.2, 0.5] }, "position": [3, 0.6, 0] }],
      "constraints": [{ "kind": "anchor", "soft": "other", "rigid": "hook", "nodes": { "low": [2, 0.49, -1], "high": [4, 0.6, 1] } }],
      "sensors": [)" +
           sensors + "] }";
}

TEST(ProgramSensors, TellTheWeightInJsonAndATable)
{
    const TemporaryFolder folder;
    const std::string scene = folder.write("scene.json", hangingScene(R"(
        { "name": "pins, all", "body": "column", "about": [1, 0.5, 0] }, { "name": "hook", "body": "other", "to": "hook" })"));
    const ProgramRun run =
        bulletfem("simulate '" + scene + "' --json --seconds 3 --pvd -o '" + folder.path("run") + "'");
    ASSERT_EQ(run.m_code, 0) << run.m_output;
    const json told = json::parse(run.m_output);
    const double weight = 250 * 9.81;
    for (const char* name : {"pins, all", "hook"})
    {
        const json& sensor = told["sensors"][name];
        EXPECT_NEAR(sensor["force"][1].get<double>(), weight, 0.01 * weight) << name;
        EXPECT_GT(sensor["largestForce"].get<double>(), 1.1 * weight) << name << ", as it was let go";
        EXPECT_GT(sensor["largestForceAt"].get<double>(), 0) << name;
    }
    EXPECT_NEAR(told["sensors"]["pins, all"]["moment"][2].get<double>(), -weight, 0.01 * weight) << "a metre beside";
    EXPECT_NEAR(told["sensors"]["hook"]["moment"][2].get<double>(), 0, 0.01 * weight);
    EXPECT_THAT(told["files"].dump(), HasSubstr("sensors.csv"));
    std::istringstream table(folder.read("run/sensors.csv"));
    std::string line;
    std::getline(table, line);
    EXPECT_THAT(line, HasSubstr("time [s],\"pins, all force x [N]\""));
    int lines = 0;
    for (std::string next; std::getline(table, next); ++lines) line = next;
    EXPECT_EQ(lines, told["steps"].get<int>());
    std::vector<double> last;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) last.push_back(std::stod(cell));
    ASSERT_EQ(last.size(), 13u);
    EXPECT_NEAR(last[0], 3, 1e-6);
    EXPECT_NEAR(last[2], told["sensors"]["pins, all"]["force"][1].get<double>(), 1e-3);
    EXPECT_THAT(folder.read("run/elements_000010.vtu"), HasSubstr("Name=\"reaction_force\""));
}

TEST(ProgramSensors, AreRejectedWithoutHeldNodes)
{
    const TemporaryFolder folder;
    const auto refusal = [&](const std::string& sensor)
    {
        const std::string scene = folder.write("scene.json", hangingScene(sensor));
        const ProgramRun run = bulletfem("simulate '" + scene + "' --seconds 1 -o '" + folder.path("run") + "'");
        EXPECT_EQ(run.m_code, 1);
        return run.m_output;
    };
    EXPECT_THAT(refusal(R"({ "name": "a", "body": "other" })"),
                HasSubstr("the sensor 'a' finds no node of 'other' that is pinned there; add 'pins'"));
    EXPECT_THAT(refusal(R"({ "name": "a", "body": "column", "nodes": { "low": [5, 5, 5], "high": [6, 6, 6] } })"),
                HasSubstr("move or enlarge its box"));
    EXPECT_THAT(refusal(R"({ "name": "a", "body": "column", "to": "hook" })"),
                HasSubstr("the sensor 'a' finds no node of 'column' that is anchored to 'hook'; add an anchor"));
}

}  // namespace
}  // namespace bullet_fem
