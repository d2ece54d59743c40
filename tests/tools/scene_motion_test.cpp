// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Prescribed motion in scenes: bodies without mass with a speed over time, and motors; also soft cylinders.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/scene_run.h"

namespace bullet_fem
{
namespace
{

Vec3 placeOf(const SceneRun& run, int rigid)
{
    return vec3(run.m_world.rigid(rigid).getWorldTransform().getOrigin());
}

// The displacement is the integral of the piecewise linear speed: 1/2 0.6 1 + 0.6 0.5 along x, 2 0.3 against z. A jump
// to 3 rad/s for 0.4 s rotates by 1.2 rad.
TEST(SceneMotion, ABodyWithoutMassFollowsItsSpeedOverTime)
{
    SceneRun run(R"({ "step": 0.01, "rigidBodies": [{ "name": "plate", "shape": { "box": [1, 1, 1] },
      "position": [0, 1, 0], "velocity": [[1.5, [0.6, 0, 0]], [0.5, [0, 0, 0]], [2, [0.6, 0, 0]], [2, [0, 0, -2]], [2.3, [0, 0, -2]], [2.3, [0, 0, 0]]],
      "spin": [[1, [0, 0, 0]], [1, [0, 3, 0]], [1.4, [0, 3, 0]], [1.4, [0, 0, 0]]] }] })");
    run.until(0.5);
    EXPECT_NEAR(norm(placeOf(run, 0) - Vec3{0, 1, 0}), 0, 1e-9);
    run.until(1);
    EXPECT_NEAR(norm(placeOf(run, 0) - Vec3{0.3 * 0.25, 1, 0}), 0, 1e-6);
    run.until(3);
    EXPECT_NEAR(norm(placeOf(run, 0) - Vec3{0.6, 1, -0.6}), 0, 1e-5);
    EXPECT_NEAR(run.m_world.rigid(0).getOrientation().getAngle(), 1.2, 1e-4);
    EXPECT_NEAR(run.m_world.rigid(0).getOrientation().getAxis().y(), 1, 1e-4);
}

// The plate rests until it sleeps with all bodies on it or tied to it; then it moves.
TEST(SceneMotion, SleepingBodiesMoveWithTheirPlate)
{
    SceneRun run(R"({ "softBodies": [
        { "name": "lies", "mesh": { "box": [0.2, 0.2, 0.2], "tets": 100 }, "position": [0, 0.1, 0] },
        { "name": "hangs", "mesh": { "box": [0.2, 0.2, 0.2], "tets": 100 }, "position": [0, -0.2, 0] }],
      "rigidBodies": [{ "name": "plate", "shape": { "box": [1, 0.2, 1] }, "position": [0, -0.1, 0],
        "velocity": [[6, [0, 0, 0]], [6, [0, 0.5, 0]], [7, [0, 0.5, 0]], [7, [0, 0, 0]]] }],
      "constraints": [{ "kind": "anchor", "soft": "hangs", "rigid": "plate", "nodes": { "low": [-1, -0.2, -1], "high": [1, 0, 1] } }] })");
    run.until(5.9);
    EXPECT_FALSE(run.m_world.soft(0).isActive()) << "otherwise the test is empty";
    EXPECT_FALSE(run.m_world.soft(1).isActive());
    const Vec3 lay = run.node(0, 0), hung = run.node(1, 0);
    run.until(8);
    EXPECT_NEAR(placeOf(run, 0).y, 0.4, 1e-5);
    EXPECT_NEAR(run.node(0, 0).y - lay.y, 0.5, 2e-3);
    EXPECT_NEAR(run.node(1, 0).y - hung.y, 0.5, 2e-3);
}

// Without gravity along the axis a motor's force F moves a mass m by F t^2 / (2 m), up to its maximum speed.
TEST(SceneMotion, ASliderGoesByItsMotor)
{
    const std::string scene = R"({ "step": 0.01, "rigidBodies": [
        { "name": "sledge", "shape": { "box": [0.6, 0.3, 0.2] }, "mass": 2, "position": [3, 4, 5], "rotation": { "axis": [1, 2, 3], "degrees": 50 } }],
      "constraints": [{ "kind": "slider", "body": "sledge", "pivot": [3, 4.5, 5], "axis": [-2, 0, 0], "speed": 0.5, "force": )";
    SceneRun weak(scene + "1 }] }"), strong(scene + "50 }] }"), loose(scene + "0 }] }");
    const btQuaternion turned = weak.m_world.rigid(0).getOrientation();
    weak.until(0.6);
    EXPECT_NEAR(placeOf(weak, 0).x, 3 - 1. / 2 * 0.6 * 0.6 / 2, 0.003);
    strong.until(2);
    EXPECT_NEAR(strong.m_world.rigid(0).getLinearVelocity().x(), -0.5, 1e-3) << "along the axis";
    EXPECT_NEAR(placeOf(strong, 0).x, 3 - 0.5 * 2, 0.02);
    loose.until(2);
    EXPECT_NEAR(placeOf(loose, 0).x, 3, 1e-3) << "no motor";
    for (SceneRun* run : {&weak, &strong, &loose})
    {
        EXPECT_NEAR(placeOf(*run, 0).y, 4, 2e-3) << "carried";
        EXPECT_NEAR(placeOf(*run, 0).z, 5, 2e-3);
        EXPECT_NEAR(run->m_world.rigid(0).getOrientation().angleShortestPath(turned), 0, 2e-3);
    }
}

// The second slider is mounted on the first one's body; after a rest in which all bodies sleep, the motors wake them.
TEST(SceneMotion, MotorsFollowTheirSpeedsAndWakeSleepingBodies)
{
    SceneRun run(R"({ "step": 0.01, "gravity": [0, 0, 0], "rigidBodies": [
        { "name": "lift", "shape": { "box": [1, 0.1, 1] }, "mass": 3 },
        { "name": "cart", "shape": { "box": [0.2, 0.2, 0.2] }, "mass": 1, "position": [0, 0.2, 0] },
        { "name": "wheel", "shape": { "sphere": 0.2 }, "mass": 1, "position": [4, 0, 0] }],
      "constraints": [
        { "kind": "slider", "body": "lift", "pivot": [0, 0, 0], "axis": [0, 1, 0], "speed": [[4, 0], [5, 0.4]], "force": 500 },
        { "kind": "slider", "body": "cart", "to": "lift", "pivot": [0, 0.2, 0], "axis": [1, 0, 0], "speed": [[4, 0], [4, 0.2]], "force": 500 },
        { "kind": "hinge", "body": "wheel", "pivot": [4, 0, 0], "axis": [0, 0, 1], "speed": [[4, 0], [5, -3]], "torque": 50 }] })");
    run.until(3.9);
    for (const int k : {0, 1, 2}) EXPECT_FALSE(run.m_world.rigid(k).isActive()) << "otherwise the test is empty";
    run.until(6);
    EXPECT_NEAR(placeOf(run, 0).y, 0.2 + 0.4, 2e-3);
    EXPECT_NEAR(placeOf(run, 1).y, 0.2 + 0.2 + 0.4, 2e-3) << "rides on the lift";
    EXPECT_NEAR(placeOf(run, 1).x - placeOf(run, 0).x, 0.2 * 2, 2e-3);
    EXPECT_NEAR(run.m_world.rigid(2).getAngularVelocity().z(), -3, 1e-3);
}

// A weight on a spring hangs m g / k below the moving target; after the release it falls.
TEST(SceneMotion, ASpringHoldsMovesAndLetsGo)
{
    SceneRun run(R"({ "step": 0.01, "softBodies": [
        { "name": "weight", "mesh": { "box": [0.2, 0.2, 0.2], "cell": 0.1 }, "material": { "young": 1e7, "density": 500 } }],
      "springs": [{ "body": "weight", "at": [0, 0.12, 0], "target": [[1, [0, 0.1, 0]], [2, [0.3, 0.6, 0]]], "stiffness": 2000, "damping": 300, "from": 0, "to": 4 }] })");
    const auto top = run.nodesIn(0, {{-0.01, 0.09, -0.01}, {0.01, 0.11, 0.01}});
    ASSERT_EQ(top.size(), 1u);
    const double mass = 500 * 0.008, sag = mass * 9.81 / 2000;
    run.until(1);
    EXPECT_NEAR(run.node(0, top[0]).y, 0.1 - sag, 0.01 * sag);
    run.until(4);
    EXPECT_NEAR(run.node(0, top[0]).y, 0.6 - sag, 0.01 * sag);
    EXPECT_NEAR(run.node(0, top[0]).x, 0.3, 0.01);
    const Vec3 momentum = run.momentum(0);
    run.until(4.5);
    EXPECT_NEAR(run.momentum(0).y - momentum.y, -mass * 9.81 * 0.5, 0.01 * mass * 9.81 * 0.5);
}

// With a limited force it does not lift a heavier weight.
TEST(SceneMotion, ASpringPullsNoMoreThanItsForce)
{
    const auto heightAfter = [](const std::string& force)
    {
        SceneRun run(
            R"({ "softBodies": [{ "name": "weight", "mesh": { "box": [0.2, 0.2, 0.2], "cell": 0.1 }, "material": { "density": 500 },
            "position": [0, 0.1, 0] }], "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }],
          "springs": [{ "body": "weight", "at": [0, 0.2, 0], "target": [0, 0.7, 0], "stiffness": 1000, "damping": 100, "force": )" +
            force + " }] }");
        run.until(1.5);
        return run.node(0, run.nodeCount(0) / 2).y;
    };
    EXPECT_LT(heightAfter("30"), 0.12) << "it weighs 39 N";
    EXPECT_GT(heightAfter("60"), 0.4);
}

// The curved surface is faceted: the volume is that of a prism over a polygon of 4 n corners, n cells across.
TEST(SceneMotion, ACylinderStandsOnY)
{
    const auto scene = [](const std::string& size)
    {
        return R"({ "softBodies": [{ "name": "drum", "mesh": { "cylinder": { "radius": 0.2, "height": 0.5 }, )" + size +
               R"(, "scale": 2 }, "material": { "density": 100 } }] })";
    };
    const SceneRun byCell(scene(R"("cell": 0.1)")), byCount(scene(R"("tets": 5000)"));
    EXPECT_EQ(byCell.m_world.soft(0).m_tetras.size(), 6 * 8 * 8 * 10);
    EXPECT_NEAR(byCount.m_world.soft(0).m_tetras.size(), 5000, 1000);
    Vec3 high;
    double wide = 0, mass = 0;
    for (int i = 0; i < byCell.nodeCount(0); ++i)
    {
        const Vec3 x = byCell.node(0, i);
        for (int c = 0; c < 3; ++c) high[c] = std::max(high[c], std::abs(x[c]));
        wide = std::max(wide, std::hypot(x.x, x.z));
        mass += 1 / double(byCell.m_world.soft(0).m_nodes[i].m_im);
    }
    EXPECT_NEAR(norm(high - Vec3{0.4, 0.5, 0.4}), 0, 1e-6);
    EXPECT_NEAR(wide, 0.4, 1e-6);
    const double corners = 4 * 8, area = corners / 2 * 0.4 * 0.4 * std::sin(2 * SIMD_PI / corners);
    EXPECT_NEAR(mass / (100 * area * 1), 1, 2e-3);
}

}  // namespace
}  // namespace bullet_fem
