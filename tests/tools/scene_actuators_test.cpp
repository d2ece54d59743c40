// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Chambers, cables, fibres and expansions in scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/scene_run.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

using Reports = btAlignedObjectArray<btFemActuatorReport>;

Reports reportsOf(SceneRun& run)
{
    Reports reports;
    run.m_world.fem().getActuators(&run.m_world.soft(0), reports);
    return reports;
}

// A body of this mesh with these actuators, without gravity.
std::string floating(const std::string& mesh, const std::string& actuators, const std::string& more = "")
{
    return R"({ "gravity": [0, 0, 0], "softBodies": [{ "name": "pad", "mesh": )" + mesh +
           R"(, "material": { "young": 1e5, "poisson": 0.3, "stiffnessDamping": 0.02, "bending": "plain" })" + more +
           R"( }], "actuators": [)" + actuators + "] }";
}

const char* const kHollow =
    R"({ "box": [0.3, 0.3, 0.3], "cell": 0.05, "holes": [{ "low": [-0.05, -0.05, -0.05], "high": [0.05, 0.05, 0.05] }] })";
const char* const kBar = R"({ "box": [0.4, 0.1, 0.1], "cell": 0.05 })";

double lengthOf(SceneRun& run)
{
    double longest = 0;
    for (int i = 0; i < run.nodeCount(0); ++i) longest = std::max(longest, norm(run.node(0, i) - run.node(0, 0)));
    return longest;
}

TEST(SceneCurve, IsStraightBetweenItsPoints)
{
    const SceneCurve curve = {{{1, 10}, {2, 20}, {2, 40}, {4, 0}}};
    const double times[] = {0, 1, 1.5, 2, 3, 4, 9}, values[] = {10, 10, 15, 40, 20, 0, 0};
    for (int k = 0; k < 7; ++k) EXPECT_EQ(curve.at(times[k]), values[k]) << times[k];
}

TEST(SceneActuators, AreReadAsTheyAreWritten)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    const SceneDescription scene = parseScene(fullScene(), folder.path(""));
    ASSERT_EQ(scene.m_actuators.size(), 4u);
    const SceneActuator &chamber = scene.m_actuators[0], &cable = scene.m_actuators[1], &fibres = scene.m_actuators[2],
                        &expansion = scene.m_actuators[3];
    EXPECT_EQ(chamber.m_kind, SceneActuator::Kind::chamber);
    EXPECT_EQ(chamber.m_body, "block");
    EXPECT_EQ(chamber.m_cavity, 1);
    EXPECT_EQ(chamber.m_sealedFrom, 2);
    EXPECT_EQ(chamber.m_value.at(1), 10000);
    EXPECT_EQ(cable.m_points.size(), 3u);
    EXPECT_EQ(cable.m_points[2].y, 3);
    EXPECT_EQ(cable.m_stiffness, 500);
    EXPECT_EQ(cable.m_value.at(7), 0.4);
    EXPECT_EQ(fibres.m_kind, SceneActuator::Kind::fibres);
    EXPECT_FALSE(fibres.m_everywhere);
    EXPECT_EQ(fibres.m_box.m_high.y, 0);
    EXPECT_EQ(fibres.m_direction.y, 2);
    EXPECT_EQ(fibres.m_value.at(0), 3000);
    EXPECT_EQ(expansion.m_value.at(0), 0.02);
    const SceneDescription other = parseScene(otherScene(), folder.path(""));
    EXPECT_EQ(other.m_actuators[0].m_stiffness, 0);
    EXPECT_EQ(other.m_actuators[0].m_value.at(0), 5);
    ASSERT_EQ(scene.m_softBodies[0].m_mesh.m_holes.size(), 1u);
    EXPECT_EQ(scene.m_softBodies[0].m_mesh.m_holes[0].m_low.z, 1);
}

// The chamber is inflated, then sealed: the gas stays after the prescribed pressure ends.
TEST(SceneActuators, AChamberIsPumpedUpAndSealed)
{
    SceneRun run(floating(kHollow, R"({ "kind": "chamber", "body": "pad", "pressure": [[0, 0], [1, 8000], [2, 0]],
                                       "sealedFrom": 1 })"));
    const double V0 = double(reportsOf(run)[0].m_volume);
    EXPECT_NEAR(V0, 1e-3, 1e-8);
    run.until(0.5);
    EXPECT_NEAR(reportsOf(run)[0].m_pressure, 4000, 200);
    run.until(1);
    const double V1 = reportsOf(run)[0].m_volume;
    EXPECT_GT(V1, 1.02 * V0);
    run.until(3);
    EXPECT_NEAR(reportsOf(run)[0].m_volume, V1, 0.01 * V1);
    EXPECT_NEAR(reportsOf(run)[0].m_pressure, 8000, 400);
}

TEST(SceneActuators, ACableOfATensionBendsABar)
{
    SceneRun run(
        floating(kBar,
                 R"({ "kind": "cable", "body": "pad", "through": [[-0.2, 0.05, 0], [0, 0.05, 0], [0.2, 0.05, 0]],
                               "tension": [[0, 0], [0.5, 4]] })"));
    EXPECT_EQ(reportsOf(run)[0].m_tension, 0);
    run.until(2);
    EXPECT_NEAR(reportsOf(run)[0].m_tension, 4, 1e-6);
    EXPECT_LT(reportsOf(run)[0].m_length, 0.395);
}

TEST(SceneActuators, ElasticCableIsWoundUp)
{
    SceneRun run(floating(kBar, R"({ "kind": "cable", "body": "pad", "through": [[-0.2, 0, 0], [0.2, 0, 0]],
                                    "stiffness": 1e5, "restLength": [[0, 0.4], [1, 0.39]] })"));
    run.until(3);
    EXPECT_NEAR(reportsOf(run)[0].m_length, 0.39, 5e-4);
    EXPECT_GT(reportsOf(run)[0].m_tension, 1);
}

// The strain is -a / E along the fibres, which lie along the turned bar.
TEST(SceneActuators, FibresShortenATurnedBar)
{
    SceneRun run(floating(kBar, R"({ "kind": "fibres", "body": "pad", "direction": [0, 1, 0], "activation": 5000 })",
                          R"(, "rotation": { "axis": [0, 0, 1], "degrees": 90 })"));
    const double before = lengthOf(run);
    run.until(3);
    const double L = 0.4 * (1 - 0.05), W = 0.1 * (1 + 0.3 * 0.05);
    EXPECT_NEAR(before, std::sqrt(0.16 + 2 * 0.01), 1e-6);
    EXPECT_NEAR(lengthOf(run), std::sqrt(L * L + 2 * W * W), 2e-4);
}

TEST(SceneActuators, ARegionExpands)
{
    SceneRun run(floating(kBar, R"({ "kind": "expansion", "body": "pad", "strain": [[0, 0], [1, 0.05]],
                                    "region": { "low": [0, -1, -1], "high": [1, 1, 1] } })"));
    run.until(3);
    const double middle = 0.2 * 1.05 + 0.2;
    EXPECT_NEAR(lengthOf(run), std::sqrt(middle * middle + 0.02), 0.01);
    EXPECT_GT(lengthOf(run), 0.425);
}

std::string refusalOf(const std::string& mesh, const std::string& actuator)
{
    return messageOf<std::exception>([&] { SceneRun run(floating(mesh, actuator)); });
}

TEST(SceneActuators, AreRejectedIfTheBodyLacksTheirParts)
{
    EXPECT_EQ(refusalOf(kBar, R"({ "kind": "chamber", "body": "pad", "pressure": 1 })"),
              "'pad': it has no cavity for a chamber; give its mesh a closed inner surface");
    EXPECT_EQ(refusalOf(kHollow, R"({ "kind": "chamber", "body": "pad", "pressure": 1, "cavity": 1 })"),
              "'pad': it has no cavity 1 for a chamber, but 1, counted from 0");
    const char* const nowhere = R"("region": { "low": [5, 5, 5], "high": [6, 6, 6] })";
    EXPECT_EQ(refusalOf(kBar, std::string(R"({ "kind": "expansion", "body": "pad", "strain": 0.1, )") + nowhere + "}"),
              "'pad': the region of an actuator holds no element's middle at the start; move or enlarge it");
    EXPECT_EQ(refusalOf(kBar, R"({ "kind": "cable", "body": "pad", "through": [[0, 0, 0], [1, 0, 0]] })"),
              "actuators[0] must have one of: tension, stiffness");
    EXPECT_EQ(refusalOf(kBar, R"({ "kind": "cable", "body": "pad", "through": [[0, 0, 0]], "tension": 1 })"),
              "actuators[0].through is [[0,0,0]]; it must be an array of at least two places");
    EXPECT_EQ(refusalOf(kBar, R"({ "kind": "fibres", "body": "pad", "direction": [1, 0, 0], "activation": [[1]] })"),
              "actuators[0].activation[0] is [1]; it must be a pair [seconds, value]");
    EXPECT_EQ(refusalOf(kBar, R"({ "kind": "expansion", "body": "pad", "strain": -1 })"),
              "actuators[0].strain is -1; it must be a number in [-0.9, 9]");
    EXPECT_EQ(refusalOf(kBar, R"({ "kind": "expansion", "body": "ground", "strain": 0 })"),
              "actuators[0].body is \"ground\"; it must be the name of a soft body");
}

}  // namespace
}  // namespace bullet_fem
