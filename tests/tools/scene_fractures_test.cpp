// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Fracture of bodies in scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/io/surface_file.h"
#include "tools/scene/scene_frames.h"
#include "tools/scene/scene_history.h"
#include "tools/scene_run.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

constexpr double kPullOfAll = 100;  // [N]; on a section of .04 m2

// A bar of 1 x .2 x .2 m and 40 kg, clamped at its left end, under a force to the right on all its mass.
std::string pulledBar(const std::string& fracture, const std::string& more = "")
{
    return R"({ "gravity": [0, 0, 0], "step": 0.01, "softBodies": [{ "name": "bar",
      "mesh": { "box": [1, 0.2, 0.2], "cell": 0.1 }, "material": { "young": 1e5, "poisson": 0, "stiffnessDamping": 0.05 },
      "pins": [{ "low": [-1, -1, -1], "high": [-0.49, 1, 1] }])" +
           fracture + R"( }], "forces": [{ "body": "bar", "force": [)" + std::to_string(kPullOfAll) + ", 0, 0] }]" +
           more + " }";
}

std::string strengthOf(double tension)
{
    return R"(, "fracture": { "tension": )" + std::to_string(tension) + " }";
}

// Speed of the nodes that start to the right of the middle: the crack has copies of nodes.
double speedOfRight(const SceneRun& run)
{
    double momentum = 0, mass = 0;
    for (int i = 0; i < run.nodeCount(0); ++i)
    {
        const btSoftBody::Node& node = run.m_world.soft(0).m_nodes[i];
        if (node.m_x.x() < 0.1 || node.m_im <= 0) continue;
        momentum += double(node.m_v.x()) / double(node.m_im);
        mass += 1 / double(node.m_im);
    }
    return momentum / mass;
}

double freeMassOf(const SceneRun& run)
{
    double mass = 0;
    for (int i = 0; i < run.nodeCount(0); ++i)
        if (const double im = double(run.m_world.soft(0).m_nodes[i].m_im); im > 0) mass += 1 / im;
    return mass;
}

TEST(SceneFractures, AreReadAsTheyAreWritten)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    const SceneDescription other = parseScene(otherScene(), folder.path(""));
    const SceneFracture& fracture = other.m_softBodies[4].m_fracture;
    EXPECT_EQ(fracture.m_tension, 3e4);
    EXPECT_EQ(fracture.m_mostCracks, 4);
    EXPECT_FALSE(fracture.m_partsTouch);
    EXPECT_EQ(other.m_softBodies[0].m_fracture.m_tension, 0);
    const SceneFracture usual = parseScene(pulledBar(strengthOf(8)), ".").m_softBodies[0].m_fracture;
    EXPECT_EQ(usual.m_mostCracks, 1);
    EXPECT_TRUE(usual.m_partsTouch);
}

// The clamp bears F / A minus the pinned nodes' share; a suddenly applied load at most doubles that.
TEST(SceneFractures, ABarHoldsAtMoreThanItBearsAndSplitsAtLess)
{
    SceneRun holds(pulledBar(strengthOf(2.5 * kPullOfAll / 0.04))),
        splits(pulledBar(strengthOf(0.5 * kPullOfAll / 0.04)));
    const int nodes = splits.nodeCount(0);
    EXPECT_EQ(holds.until(1).m_world.fractures().count(), 0);
    splits.until(1);
    ASSERT_EQ(splits.m_world.fractures().bodies().size(), 1u);
    const SceneSplits& what = splits.m_world.fractures().bodies()[0];
    EXPECT_EQ(what.m_body, &splits.m_world.soft(0));
    EXPECT_EQ(what.m_nodes, nodes);
    EXPECT_GE(what.m_count, 1);
    EXPECT_GE(what.m_parts, 2);
    EXPECT_EQ(nodes + int(what.m_copyOf.size()), splits.nodeCount(0));
    for (std::size_t n = 0; n < what.m_copyOf.size(); ++n) EXPECT_LT(what.m_copyOf[n], nodes + int(n));
    EXPECT_EQ(btFemFracture::splits(splits.m_world.fem()).size(), 0) << "the world has read them";
}

// The broken-off part is accelerated by its share of the force, which includes copies of nodes.
TEST(SceneFractures, ForcesPullAtCopiesOfNodesToo)
{
    SceneRun run(pulledBar(strengthOf(0.5 * kPullOfAll / 0.04)));
    const double acceleration = kPullOfAll / freeMassOf(run);
    run.until(1.5);
    ASSERT_GE(run.m_world.fractures().bodies()[0].m_parts, 2);
    const double before = speedOfRight(run);
    EXPECT_NEAR((speedOfRight(run.until(2)) - before) / 0.5, acceleration, 0.002 * acceleration);
}

// A force on some nodes stays on them and their copies: a stub of the bar splits along its length under it.
TEST(SceneFractures, ForceKeepsItsSizeIfItsNodesSplit)
{
    SceneRun run(R"({ "gravity": [0, 0, 0], "step": 0.01, "softBodies": [{ "name": "bar",
      "mesh": { "box": [0.4, 0.2, 0.2], "cell": 0.1 }, "material": { "young": 1e5 }, "fracture": { "tension": 300 } }],
      "forces": [{ "body": "bar", "nodes": { "low": [-1, -1, -1], "high": [-0.15, 1, 1] }, "force": [0, 30, 0] },
                 { "body": "bar", "nodes": { "low": [-0.05, -1, -1], "high": [0.05, 1, 1] }, "force": [0, -50, 0] },
                 { "body": "bar", "nodes": { "low": [0.15, -1, -1], "high": [1, 1, 1] }, "force": [0, 30, 0] }] })");
    run.until(1);
    ASSERT_GT(run.m_world.fractures().count(), 0);
    EXPECT_NEAR(run.momentum(0).y, 10, 0.01) << "(30 - 50 + 30) N for a second";
}

TEST(SceneFractures, PartsCollideUnlessDisabled)
{
    SceneRun usual(pulledBar(strengthOf(1250)));
    SceneRun apart(pulledBar(R"(, "fracture": { "tension": 1250, "partsTouch": false, "mostCracks": 3 })"));
    ASSERT_GE(usual.until(1).m_world.fractures().bodies()[0].m_parts, 2);
    ASSERT_GE(apart.until(1).m_world.fractures().bodies()[0].m_parts, 2);
    const auto touches = [](SceneRun& run)
    { return (run.m_world.soft(0).m_cfg.collisions & btSoftBody::fCollision::CL_SELF) != 0; };
    EXPECT_TRUE(touches(usual));
    EXPECT_FALSE(touches(apart));
}

// Writers and pictures show elements with their present nodes, crack faces, and displacements from the initial
// positions.
TEST(SceneFractures, FramesShowSplitElementsAndDisplacements)
{
    SceneRun run(pulledBar(strengthOf(1250)));
    SceneFrames frames(run.m_world);
    const std::vector<Vec3> rest = frames.volumes()[0].m_positions;
    const std::size_t triangles = frames.surfaces()[0].m_triangles.size(), tets = frames.volumes()[0].m_tets.size();
    run.until(1.2);
    frames.update();
    SceneFrames later(run.m_world);  // of a moving scene
    const std::vector<Vec3> restOfLater = later.volumes()[0].m_positions;
    run.until(1.5);
    frames.update();
    later.update();
    const BodyFrame &volume = frames.volumes()[0], &surface = frames.surfaces()[0];
    ASSERT_EQ(int(volume.m_positions.size()), run.nodeCount(0));
    ASSERT_GT(volume.m_positions.size(), rest.size());
    EXPECT_EQ(volume.m_tets.size(), tets);
    EXPECT_GT(surface.m_triangles.size(), triangles);
    EXPECT_EQ(int(surface.m_triangles.size()), run.m_world.soft(0).m_faces.size());
    EXPECT_EQ(surface.m_nodeStress.size(), surface.m_positions.size());
    EXPECT_TRUE(surface.m_triangles == later.surfaces()[0].m_triangles);
    const std::vector<int>& copyOf = run.m_world.fractures().bodies()[0].m_copyOf;
    std::vector<Vec3> began = rest;
    for (const int node : copyOf) began.push_back(began[node]);
    for (std::size_t n = 0; n < volume.m_positions.size(); ++n)
    {
        EXPECT_LT(norm(volume.m_positions[n] - volume.m_displacement[n] - began[n]), 1e-12);
        const Vec3 there = n < restOfLater.size() ? restOfLater[n] : volume.m_positions[n];
        EXPECT_LT(norm(there - (later.volumes()[0].m_positions[n] - later.volumes()[0].m_displacement[n])), 1e-12);
    }
    for (const Tet& tet : volume.m_tets)  // no element spans a crack
    {
        const auto [low, high] = std::minmax_element(
            tet.begin(), tet.end(), [&](int a, int b) { return volume.m_positions[a].x < volume.m_positions[b].x; });
        EXPECT_LT(volume.m_positions[*high].x - volume.m_positions[*low].x, 0.15);
    }
}

// A split cannot be undone: the history begins at the last one.
TEST(SceneFractures, HistoryRestartsAtASplit)
{
    SceneRun run(pulledBar(strengthOf(1250)));
    SceneHistorySettings settings;
    settings.m_stepsBetween = 5;
    SceneHistory history(run.m_world, settings);
    while (run.m_world.time() < 1.5 - 1e-9) history.step();
    ASSERT_GT(run.m_world.fractures().count(), 0);
    EXPECT_GT(history.since(), 0.05);
    EXPECT_LT(history.since(), 1.5);
    const double end = run.node(0, run.nodeCount(0) - 1).x;
    while (history.earlier())
    {
    }
    EXPECT_NEAR(run.m_world.time(), history.since(), 1e-9);
    EXPECT_GT(run.m_world.fractures().count(), 0);
    while (run.m_world.time() < 1.5 - 1e-9) history.step();
    EXPECT_EQ(run.node(0, run.nodeCount(0) - 1).x, end);
}

TEST(SceneFractures, FragmentsSplitToo)
{
    SceneRun run(pulledBar(strengthOf(1250) + R"(, "pieces": { "cells": 3 })"));
    EXPECT_GE(run.m_world.fractures().bodies().size(), 3u);
    EXPECT_GT(run.until(1).m_world.fractures().count(), 0);
}

// For a baked file the program does not know in advance whether a surface is embedded.
TEST(SceneFractures, BakedBodySplitsButBakedSurfaceIsRejected)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    const std::string scene = R"({ "softBodies": [{ "name": "cube", "mesh": { "baked": "body.bfem" },
      "fracture": { "tension": 2000 } }], "forces": [{ "body": "cube", "force": [2e4, 0, 0], "nodes": { "low": [0.9, -1, -1], "high": [2, 2, 2] } },
      { "body": "cube", "force": [-2e4, 0, 0], "nodes": { "low": [-1, -1, -1], "high": [0.1, 2, 2] } }] })";
    SceneRun run(scene, folder.path(""));
    EXPECT_GT(run.until(0.5).m_world.fractures().count(), 0);
    const SurfaceMesh surface = readSurfaceFile(folder.path("cube.off"));
    CageSettings settings;
    settings.m_targetTets = 100;
    writeBakedBody(folder.path("body.bfem"), bakeBody(makeCage(surface, settings), surface, {}));
    EXPECT_THAT(messageOf<std::exception>([&] { SceneRun refused(scene, folder.path("")); }),
                testing::AllOf(testing::HasSubstr("'cube': "), testing::HasSubstr("embedded surface")));
}

}  // namespace
}  // namespace bullet_fem
