// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies of scenes in fragments, and welds between bodies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/scene/scene_history.h"
#include "tools/scene_run.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

constexpr double kGravityOfScenes = 9.81;  // [m/s2]

// A bar of 1 x .2 x .2 m, 100 kPa and 40 kg, held at its left end.
std::string clampedBar(const std::string& pieces, const std::string& more, const std::string& gravity = "[0, 0, 0]")
{
    return R"({ "gravity": )" + gravity + R"(, "step": 0.01, "softBodies": [{ "name": "bar",
      "mesh": { "box": [1, 0.2, 0.2], "cell": 0.1 },
      "material": { "young": 1e5, "poisson": 0, "massDamping": 4, "stiffnessDamping": 0.05, "bending": "plain" },
      "pins": [{ "low": [-1, -1, -1], "high": [-0.49, 1, 1] }])" +
           pieces + " }]" + more + " }";
}

// A force on its right end, along x.
std::string pull(double force)
{
    return R"(, "forces": [{ "body": "bar", "nodes": { "low": [0.49, -1, -1], "high": [1, 1, 1] }, "force": [)" +
           std::to_string(force) + ", 0, 0] }]";
}

double massOf(const SceneRun& run)
{
    double mass = 0;
    for (int i = 0; i < run.m_world.softCount(); ++i) mass += double(run.m_world.soft(i).getTotalMass());
    return mass;
}

double lowestOf(const SceneRun& run)
{
    double lowest = 1e30;
    for (int i = 0; i < run.m_world.softCount(); ++i)
        for (int n = 0; n < run.nodeCount(i); ++n) lowest = std::min(lowest, run.node(i, n).y);
    return lowest;
}

// Largest x of a node.
double farthestOf(const SceneRun& run)
{
    double farthest = -1e30;
    for (int i = 0; i < run.m_world.softCount(); ++i)
        for (int n = 0; n < run.nodeCount(i); ++n) farthest = std::max(farthest, run.node(i, n).x);
    return farthest;
}

int weldCount(const SceneRun& run)
{
    int count = 0;
    btAlignedObjectArray<btFemWeldReport> welds;
    for (int i = 0; i < run.m_world.softCount(); ++i)
        if (btFemWelds::welds(run.m_world.fem(), &run.m_world.soft(i), welds)) count += welds.size();
    return count;
}

TEST(SceneWelds, AreReadAsTheyAreWritten)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    const SceneDescription scene = parseScene(fullScene(), folder.path(""));
    ASSERT_EQ(scene.m_welds.size(), 1u);
    const SceneWeld& weld = scene.m_welds[0];
    EXPECT_EQ(weld.m_a, "block");
    EXPECT_EQ(weld.m_b, "scan");
    EXPECT_EQ(weld.m_reach, 0.5);
    EXPECT_EQ(weld.m_strength.m_breakForce, 7);
    EXPECT_EQ(weld.m_strength.m_breakStress, 8e3);
    EXPECT_EQ(weld.m_strength.m_breakStretch, 0.25);
    EXPECT_EQ(weld.m_strength.m_compliance, 1e-6);
    const SceneDescription other = parseScene(otherScene(), folder.path(""));
    const ScenePieces& pieces = other.m_softBodies[3].m_pieces;
    EXPECT_EQ(pieces.m_cells, 7);
    EXPECT_EQ(pieces.m_seed, 3);
    EXPECT_EQ(pieces.m_strength.m_breakForce, 10);
    EXPECT_EQ(pieces.m_strength.m_breakStress, 2e3);
    EXPECT_EQ(pieces.m_strength.m_breakStretch, 0.01);
    EXPECT_EQ(pieces.m_strength.m_compliance, 1e-7);
    EXPECT_EQ(other.m_softBodies[0].m_pieces.m_cells, 0);
    const ScenePieces never = parseScene(clampedBar(R"(, "pieces": { "cells": 4 })", ""), ".").m_softBodies[0].m_pieces;
    EXPECT_EQ(never.m_seed, 1);
    EXPECT_TRUE(std::isinf(never.m_strength.m_breakForce));
    EXPECT_TRUE(std::isinf(never.m_strength.m_breakStress));
    EXPECT_TRUE(std::isinf(never.m_strength.m_breakStretch));
}

TEST(SceneWelds, FragmentsKeepMassMotionAndPinsOfTheBody)
{
    SceneRun run(clampedBar(R"(, "pieces": { "cells": 5, "seed": 2 }, "velocity": [0, 0, 3], "friction": 0.7)", ""));
    const std::vector<SceneSoftBody>& bodies = run.m_world.description().m_softBodies;
    ASSERT_GE(run.m_world.softCount(), 5);
    ASSERT_EQ(int(bodies.size()), run.m_world.softCount());
    EXPECT_EQ(bodies[0].m_name, "bar.0");
    EXPECT_EQ(bodies[4].m_name, "bar.4");
    EXPECT_EQ(bodies[4].m_whole, "bar");
    EXPECT_GE(weldCount(run), 4);
    SceneRun whole(clampedBar("", ""));
    EXPECT_NEAR(massOf(run), massOf(whole), 1e-3);
    int held = 0;
    double momentum = 0;
    for (int i = 0; i < run.m_world.softCount(); ++i)
    {
        momentum += run.momentum(i).z;
        EXPECT_EQ(run.m_world.soft(i).m_cfg.kDF, btScalar(0.7));
        for (int n = 0; n < run.nodeCount(i); ++n)
            held += run.m_world.soft(i).m_nodes[n].m_im == 0 && run.node(i, n).x < -0.49 ? 1 : 0;
    }
    EXPECT_GE(held, 9);
    EXPECT_NEAR(momentum, 3 * massOf(run), 1e-3 * momentum);
}

// Welds without a limit: the bar bends as one body.
TEST(SceneWelds, FragmentsBendAsTheWhole)
{
    SceneRun whole(clampedBar("", "", "[0, -1, 0]")),
        cut(clampedBar(R"(, "pieces": { "cells": 5 })", "", "[0, -1, 0]"));
    const double before = lowestOf(whole);
    const double sag = before - lowestOf(whole.until(4));
    EXPECT_GT(sag, 0.05);
    EXPECT_NEAR(before - lowestOf(cut.until(4)), sag, 0.01 * sag);
}

// F / A is 2500 Pa: with welds of twice that strength the bar stretches by F / (E A), with welds of half of it, it
// tears.
TEST(SceneWelds, FragmentsTearAtTheirStress)
{
    const auto run = [](double stress)
    { return clampedBar(R"(, "pieces": { "cells": 5, "breakStress": )" + std::to_string(stress) + " }", pull(100)); };
    SceneRun holds(run(5000)), tears(run(1250));
    const int welds = weldCount(holds);
    // The corners, with equal forces as the other nodes, are displaced slightly further.
    EXPECT_NEAR(farthestOf(holds.until(4)) - 0.5, 2500 / 1e5, 0.05 * 2500 / 1e5);
    EXPECT_EQ(weldCount(holds), welds);
    EXPECT_EQ(btFemWelds::breaks(holds.m_world.fem()).size(), 0);
    EXPECT_GT(farthestOf(tears.until(2)), 1.5) << "it flies";
    EXPECT_LT(weldCount(tears), welds);
}

// A cube of 8 kg hangs from a fixed one by a weld of this strength.
std::string hangingCube(const std::string& strength)
{
    const std::string cube = R"("mesh": { "box": [0.2, 0.2, 0.2], "cell": 0.1 },
        "material": { "young": 1e6, "poisson": 0.3, "stiffnessDamping": 0.05 })";
    return R"({ "step": 0.01, "softBodies": [
      { "name": "upper", )" +
           cube + R"(, "position": [0, 2, 0], "pins": [{ "low": [-1, 2.09, -1], "high": [1, 3, 1] }] },
      { "name": "lower", )" +
           cube + R"(, "position": [0, 1.8, 0] }],
      "welds": [{ "a": "upper", "b": "lower")" +
           strength + "}] }";
}

TEST(SceneWelds, TwoBodiesHangTogetherByTheirWeight)
{
    SceneRun run(hangingCube(R"(, "breakForce": 200, "reach": 0.01)"));
    btAlignedObjectArray<btFemWeldReport> welds;
    ASSERT_TRUE(btFemWelds::welds(run.until(3).m_world.fem(), &run.m_world.soft(0), welds));
    ASSERT_EQ(welds.size(), 1);
    EXPECT_EQ(welds[0].m_nodes, 9);
    const double weight = 8 * kGravityOfScenes;
    EXPECT_NEAR(double(welds[0].m_force.y()), -weight, 0.01 * weight);
    EXPECT_GT(lowestOf(run), 1.69);
}

TEST(SceneWelds, AWeldBreaksAtItsForceAndIsThereAgainBackInTime)
{
    SceneRun run(hangingCube(R"(, "breakForce": 70)"));
    SceneHistorySettings settings;
    settings.m_stepsBetween = 1;
    SceneHistory history(run.m_world, settings);
    while (run.m_world.time() < 1 - 1e-9) history.step();
    EXPECT_EQ(weldCount(run), 0);
    EXPECT_LT(lowestOf(run), 0) << "it falls";
    const double fallen = lowestOf(run);
    while (history.earlier())
    {
    }
    EXPECT_EQ(run.m_world.steps(), 0);
    EXPECT_EQ(weldCount(run), 1);
    while (run.m_world.time() < 1 - 1e-9) history.step();
    EXPECT_EQ(weldCount(run), 0);
    EXPECT_EQ(lowestOf(run), fallen);
}

TEST(SceneWelds, JoinABodyToEveryFragmentInContact)
{
    std::string scene = hangingCube("");
    const std::string lower = R"("position": [0, 1.8, 0])";
    scene.insert(scene.find(lower), R"("pieces": { "cells": 6, "breakForce": 1e6 }, )");
    SceneRun run(scene);
    ASSERT_GT(run.m_world.softCount(), 5);
    btAlignedObjectArray<btFemWeldReport> welds;
    ASSERT_TRUE(btFemWelds::welds(run.until(3).m_world.fem(), &run.m_world.soft(0), welds));
    EXPECT_GE(welds.size(), 2) << "six cells have more than one at the top";
    double force = 0;
    for (int k = 0; k < welds.size(); ++k) force += double(welds[k].m_force.y());
    const double weight = 8 * kGravityOfScenes;
    EXPECT_NEAR(force, -weight, 0.01 * weight);
}

TEST(SceneWelds, AnchorsOfAFragmentedBodyHoldItsFragments)
{
    SceneRun run(clampedBar(R"(, "pieces": { "cells": 5 })",
                            R"(, "rigidBodies": [{ "name": "hand", "shape": { "box": [0.1, 0.3, 0.3] },
      "position": [0.55, 0, 0], "velocity": [0.05, 0, 0] }], "constraints": [{ "kind": "anchor", "soft": "bar",
      "rigid": "hand", "nodes": { "low": [0.49, -1, -1], "high": [1, 1, 1] } }])"));
    run.until(1);
    double force = 0;
    for (int i = 0; i < run.m_world.softCount(); ++i)
        for (int k = 0; k < run.m_world.fem().anchors(&run.m_world.soft(i)).size(); ++k)
        {
            const btFemAnchorReport& anchor = run.m_world.fem().anchors(&run.m_world.soft(i))[k];
            if (anchor.m_object == &run.m_world.rigid(0)) force += double(anchor.m_impulse.x()) / 0.01;
        }
    // E A (l / L + beta l' / L), and a remainder of the wave.
    EXPECT_NEAR(force, 1e5 * 0.04 * (0.05 + 0.05 * 0.05), 20);
    EXPECT_NEAR(farthestOf(run), 0.55, 1e-3);
}

// Regions of the cube's lower half, label 1, and of its upper one, label -2.
TEST(SceneWelds, FragmentsHaveTheRegionsOfTheirElements)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    SceneRun run(R"({ "softBodies": [{ "name": "layers", "mesh": { "tetrahedra": "regions.msh" },
      "materials": { "1": { "density": 1000 }, "-2": { "density": 3000 } }, "pieces": { "cells": 4 } }] })",
                 folder.path(""));
    ASSERT_GE(run.m_world.softCount(), 4);
    EXPECT_NEAR(massOf(run), 2000, 0.01);
    int upper = 0, all = 0;
    for (int i = 0; i < run.m_world.softCount(); ++i)
    {
        const std::vector<int>& labels = run.m_world.regionLabels(i);
        const btSoftBody& piece = run.m_world.soft(i);
        ASSERT_EQ(int(labels.size()), piece.m_tetras.size());
        for (int e = 0; e < piece.m_tetras.size(); ++e)
        {
            double y = 0;
            for (const btSoftBody::Node* node : piece.m_tetras[e].m_n) y += double(node->m_x.y()) / 4;
            EXPECT_EQ(labels[e], y < 0.5 ? 1 : -2);
            upper += labels[e] == -2;
            ++all;
        }
    }
    EXPECT_EQ(all, 40);
    EXPECT_EQ(upper, 20);
}

TEST(SceneWelds, AreRejectedForMissingParts)
{
    const auto refusalOf = [](const std::string& scene)
    { return messageOf<std::exception>([&] { SceneRun run(scene); }); };
    using testing::AllOf;
    using testing::HasSubstr;
    std::string apart = hangingCube("");
    apart.replace(apart.find("[0, 1.8, 0]"), 11, "[0, 1.7, 0]");
    EXPECT_THAT(refusalOf(apart), AllOf(HasSubstr("'upper': its weld to 'lower': "), HasSubstr("no face")));
    EXPECT_THAT(refusalOf(clampedBar(R"(, "pieces": { "cells": 5000 })", "")),
                AllOf(HasSubstr("'bar': "), HasSubstr("5000")));
}

}  // namespace
}  // namespace bullet_fem
