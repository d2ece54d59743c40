// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The gallery scenes demos/<name>/<name>.json reproduce the main figure of their C++ demos.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bullet_fem/btFemVectors.h"
#include "tools/program_run.h"
#include "tools/scene/scene_reader.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{
namespace
{

/// The value that a demo program prints beside a figure's or check's name; NaN if it prints none.
double figureOf(const std::string& name, double seconds, const std::string& figure)
{
    const ProgramRun run =
        runShell("'" BULLETFEM_DEMO_PROGRAMS "/bulletfem_demo_" + name + "' --seconds " + std::to_string(seconds));
    EXPECT_EQ(run.m_code, 0) << run.m_output;
    const std::size_t at = run.m_output.find("\n  " + figure + " ");
    if (at == std::string::npos) return NAN;
    std::string value = run.m_output.substr(at + 3 + figure.size(), 60);
    value.erase(0, value.find_first_not_of(' '));
    if (value.rfind("ok: ", 0) == 0) value.erase(0, 4);
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    return end == value.c_str() ? NAN : number;
}

struct DemoScene
{
    explicit DemoScene(const std::string& name)
        : m_scene(readScene(BULLETFEM_DEMO_SOURCES "/" + name + "/" + name + ".json")), m_world(m_scene)
    {
    }
    void until(double seconds)
    {
        while (m_world.time() < seconds - 1e-9) m_world.step();
    }
    Vec3 rigid(const std::string& name) const
    {
        for (int i = 0; i < m_world.rigidCount(); ++i)
            if (m_scene.m_rigidBodies[i].m_name == name) return vec3(m_world.rigid(i).getCenterOfMassPosition());
        ADD_FAILURE() << "no rigid body " << name;
        return {};
    }
    const btSoftBody& soft(const std::string& name) const
    {
        for (int i = 0; i < m_world.softCount(); ++i)
            if (m_scene.m_softBodies[i].m_name == name) return m_world.soft(i);
        throw std::runtime_error("no soft body " + name);
    }
    /// Mass-weighted mean of the nodes' positions or velocities.
    Vec3 mean(const std::string& name, btVector3 btSoftBody::Node::*vector) const
    {
        const btSoftBody& body = soft(name);
        Vec3 sum;
        double mass = 0;
        for (int i = 0; i < body.m_nodes.size(); ++i)
        {
            if (body.m_nodes[i].m_im <= 0) continue;
            mass += 1 / double(body.m_nodes[i].m_im);
            sum += (1 / double(body.m_nodes[i].m_im)) * vec3(body.m_nodes[i].*vector);
        }
        return (1 / mass) * sum;
    }
    Vec3 centre(const std::string& name) const { return mean(name, &btSoftBody::Node::m_x); }
    /// Extent of the bounding box of the nodes.
    Vec3 size(const std::string& name) const
    {
        const btSoftBody& body = soft(name);
        btVector3 low = body.m_nodes[0].m_x, high = low;
        for (int i = 1; i < body.m_nodes.size(); ++i)
        {
            low.setMin(body.m_nodes[i].m_x);
            high.setMax(body.m_nodes[i].m_x);
        }
        return vec3(high - low);
    }
    double gasOf(const std::string& name) const
    {
        btAlignedObjectArray<btFemActuatorReport> air;
        m_world.fem().getActuators(&soft(name), air);
        return air.size() == 1 ? double(air[0].m_volume) : NAN;
    }

    SceneDescription m_scene;
    SceneWorld m_world;
};

// Tolerances are 1e-3, from four printed digits, unless a comment gives another reason.
TEST(DemoScenes, BallsHaveTheSpeedOfTheDemo)
{
    DemoScene scene("balls");
    scene.until(2);
    const double angle = 8 * SIMD_RADS_PER_DEG;
    for (const char* name : {"soft", "medium", "hard"})
    {
        const Vec3 velocity = scene.mean(name, &btSoftBody::Node::m_v);
        const double speed = velocity.x * std::cos(angle) - velocity.y * std::sin(angle);
        EXPECT_NEAR(speed / figureOf("balls", 2, std::string(name) + " ball: speed"), 1, 0.02) << name;
    }
}

// The crates settle at places that depend on rounded initial positions.
TEST(DemoScenes, BridgeHasTheSagOfTheDemo)
{
    DemoScene scene("bridge");
    scene.until(7);
    const double span = 5 * 0.4 + 6 * 0.2, sag = (1.5 - scene.rigid("plank2").y) / span;
    EXPECT_NEAR(sag / figureOf("bridge", 7, "sag / span"), 1, 0.02);
}

TEST(DemoScenes, ClayKeepsTheDentOfTheDemo)
{
    DemoScene scene("dents");
    const btSoftBody& clay = scene.soft("clay");
    std::vector<int> top;
    for (int i = 0; i < clay.m_nodes.size(); ++i)
        if (clay.m_nodes[i].m_x.y() > 0.149) top.push_back(i);
    scene.until(1.7);
    double depth = 0;
    for (const int i : top)
    {
        const Vec3 x = vec3(clay.m_nodes[i].m_x);
        if (std::hypot(x.x + 0.08, x.z + 0.13) < 0.05625) depth = std::max(depth, 0.15 - x.y);
    }
    const double radius = 0.12, weight = 7850 * 4. / 3 * SIMD_PI * std::pow(radius, 3) * 9.81;
    const double formula = radius - std::sqrt(radius * radius - weight / (3 * 5e3 * SIMD_PI));
    EXPECT_GT(depth, 0.02);
    EXPECT_NEAR(depth / formula / figureOf("dents", 1.75, "dent 3: depth / formula"), 1, 0.05);
}

TEST(DemoScenes, FingersFillAndLiftTheBallAsInTheDemo)
{
    DemoScene scene("finger");
    const double empty = scene.gasOf("finger0"), low = scene.centre("ball").y;
    scene.until(3.5);
    EXPECT_NEAR(scene.gasOf("finger0") / empty / figureOf("finger", 3.5, "volume of the air / empty"), 1, 0.01);
    EXPECT_NEAR((scene.centre("ball").y - low) / 0.1 / figureOf("finger", 3.5, "rise / way of the palm"), 1, 0.02);
}

// Motors keep the wheels' speed, and so the car's, apart from the flattening of the tyres.
TEST(DemoScenes, CarHasTheSpeedOfTheDemo)
{
    DemoScene scene("car");
    double lowest = 1;
    while (scene.m_world.time() < 6 - 1e-9)
    {
        scene.m_world.step();
        for (const char* hub : {"hub0", "hub1", "hub2", "hub3"}) lowest = std::min(lowest, scene.rigid(hub).y);
    }
    const double before = scene.rigid("chassis").x;
    scene.m_world.step();
    const double speed = (scene.rigid("chassis").x - before) / scene.m_scene.m_step;
    EXPECT_NEAR(speed / figureOf("car", 6, "speed"), 1, 0.03);
    EXPECT_NEAR(lowest / 0.4 / figureOf("car", 6, "lowest hub / radius of the tyre"), 1, 0.02);
}

// The scene has rigid bodies on sliders in place of a multibody.
TEST(DemoScenes, GripperLiftsAndPressesAsInTheDemo)
{
    DemoScene scene("gripper");
    const double low = scene.centre("fruit").y;
    double narrowest = 1;
    while (scene.m_world.time() < 4 - 1e-9)
    {
        if (scene.m_world.time() > 3.5) narrowest = std::min(narrowest, scene.size("fruit").x / 0.12);
        scene.m_world.step();
    }
    EXPECT_NEAR((scene.centre("fruit").y - low) / (0.15 * 1.5) / figureOf("gripper", 4, "rise / way of the palm"), 1,
                0.02);
    EXPECT_NEAR(narrowest / figureOf("gripper", 4, "width of the fruit / at rest"), 1, 0.01);
}

TEST(DemoScenes, RingIsDrawnAsFarAsInTheDemo)
{
    DemoScene scene("squeeze");
    scene.until(3);
    EXPECT_NEAR(scene.centre("ring").x / figureOf("squeeze", 3, "centre behind the rollers"), 1, 0.03);
}

// Its cells differ in length, and its first contact with the ground depends on the preceding swing.
TEST(DemoScenes, RollIsThrownAsInTheDemo)
{
    DemoScene scene("throw");
    scene.until(3 + scene.m_scene.m_step);  // still held in the step that begins at 3 s
    const Vec3 from = scene.centre("roll"), velocity = scene.mean("roll", &btSoftBody::Node::m_v);
    EXPECT_NEAR(norm(velocity) / figureOf("throw", 5, "speed when it is let go"), 1, 0.01);
    Vec3 to = from;
    while (scene.m_world.fem().contacts(&scene.soft("roll")).size() == 0 && scene.m_world.time() < 5)
    {
        to = scene.centre("roll");
        scene.m_world.step();
    }
    EXPECT_NEAR((to.x - from.x) / figureOf("throw", 5, "way of its flight"), 1, 0.05);
}

// The scene's hands pull at once; in the program the loaf comes to rest before.
TEST(DemoScenes, LoafTearsAtThePullOfTheDemo)
{
    DemoScene scene("tearing");
    double mass = 0, pull = 0;
    for (int i = 0; i < scene.m_world.softCount(); ++i) mass += double(scene.m_world.soft(i).getTotalMass());
    const btRigidBody* hand = &scene.m_world.rigid(2);
    while (scene.m_world.time() < scene.m_scene.m_seconds - 1e-9)
    {
        scene.m_world.step();
        double force = 0;
        for (int i = 0; i < scene.m_world.softCount(); ++i)
        {
            const auto& anchors = scene.m_world.fem().anchors(&scene.m_world.soft(i));
            for (int k = 0; k < anchors.size(); ++k)
                if (anchors[k].m_object == hand) force += double(anchors[k].m_impulse.x()) / scene.m_scene.m_step;
        }
        pull = std::max(pull, force);
    }
    const double bears = 4e3 * mass / 250 / 0.36;
    EXPECT_NEAR(pull / bears / figureOf("tearing", 2, "largest pull / what a section bears"), 1, 0.05);
    double torn = 0;
    for (int k = 0; k < btFemWelds::breaks(scene.m_world.fem()).size(); ++k)
        torn += btFemWelds::breaks(scene.m_world.fem())[k].m_left == 0 ? 1 : 0;
    EXPECT_GT(torn, 3) << "welds";
}

// The scene's specimens have no wide ends: the whole specimen breaks above its middle, where it carries more weight.
TEST(DemoScenes, SpecimensPartAtThePullOfTheDemo)
{
    DemoScene scene("tensile");
    const btRigidBody* head = &scene.m_world.rigid(2);
    double pull = 0, weight = double(scene.soft("whole").getTotalMass()) * 9.81;
    while (scene.m_world.time() < scene.m_scene.m_seconds - 1e-9)
    {
        scene.m_world.step();
        double force = 0;
        const auto& anchors = scene.m_world.fem().anchors(&scene.soft("whole"));
        for (int k = 0; k < anchors.size(); ++k)
            if (anchors[k].m_object == head) force += double(anchors[k].m_impulse.y()) / scene.m_scene.m_step;
        pull = std::max(pull, force - weight / 2);
    }
    ASSERT_EQ(scene.m_world.fractures().bodies().size(), 2u);
    for (const SceneSplits& body : scene.m_world.fractures().bodies()) EXPECT_EQ(body.m_parts, 2);
    const double bears = 2e4 * 0.14 * 0.05;
    EXPECT_NEAR(pull / bears / figureOf("tensile", 2.2, "whole: pull / strength x area"), 1, 0.05);
}

// The final place of each toy depends on its initial rotation.
TEST(DemoScenes, TheCrowdFillsThePit)
{
    DemoScene scene("crowd");
    ASSERT_EQ(scene.m_world.softCount(), 100);
    scene.until(4);
    double carried = 0, weight = 0, farthest = 0;
    const int samples = 60;
    for (int k = 0; k < samples; ++k)
    {
        scene.m_world.step();
        for (int i = 0; i < scene.m_world.softCount(); ++i)
            for (int j = 0; j < scene.m_world.rigidCount(); ++j)
                carried +=
                    double(scene.m_world.fem().contactForce(&scene.m_world.soft(i), &scene.m_world.rigid(j)).y());
    }
    for (int i = 0; i < scene.m_world.softCount(); ++i)
    {
        const Vec3 centre = scene.centre("bear." + std::to_string(i));
        weight += double(scene.m_world.soft(i).getTotalMass()) * 9.81;
        farthest = std::max({farthest, std::abs(centre.x), std::abs(centre.z)});
    }
    EXPECT_NEAR(carried / samples / weight, 1, 0.03);
    EXPECT_NEAR(farthest / figureOf("crowd", 5, "farthest centre from the middle"), 1, 0.05);
}

TEST(DemoScenes, TowerHasTheHeightOfTheDemo)
{
    DemoScene scene("tower");
    scene.until(2.5);
    EXPECT_NEAR((scene.rigid("board3").y + 0.06) / 1.48 / figureOf("tower", 2.5, "height at rest / at the start"), 1,
                0.002);
    scene.until(4.5);
    EXPECT_LT(scene.rigid("board3").y, 0.74) << "knocked down";
}

TEST(DemoScenes, DogWalksAsFarAsInTheDemo)
{
    DemoScene scene("walker");
    const double step = scene.m_scene.m_step;
    scene.until(1.5 - step);
    const double from = scene.centre("dog").x;
    scene.until(3);
    const double period = 0.5, way = (scene.centre("dog").x - from) / (1.5 + step) * period;
    EXPECT_NEAR(way / figureOf("walker", 3, "way of a period"), 1, 0.05);
}

}  // namespace
}  // namespace bullet_fem
