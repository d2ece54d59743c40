// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A scene in a window, controlled by a scripted mouse. Needs a display: use xvfb-run if there is none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <thread>

#include "io/temporary_folder.h"
#include "tools/mesh_files.h"
#include "tools/pictures/viewer.h"
#include "tools/scene/scene_simulation.h"
#include "tools/scene_run.h"

namespace bullet_fem
{
namespace
{

class SceneViewer : public testing::Test
{
protected:
    void SetUp() override
    {
        if (!getenv("DISPLAY")) GTEST_SKIP() << "there is no display, and no xvfb-run";
    }
    void open(const std::string& json)
    {
        m_run = std::make_unique<SceneRun>(json);
        SceneSimulationSettings how;
        how.m_meshes.m_cage.m_targetTets = 300;
        how.m_meshes.m_bake.m_material = Material::rubber();
        m_simulation.emplace(m_run->m_world, how);
        ViewerSettings settings;
        settings.m_size = {800, 600};
        m_viewer = std::make_unique<Viewer>(*m_simulation, settings);
        m_viewer->frame(0);
    }
    void play(const ViewerEvent& event, int steps = 1)
    {
        m_viewer->inject(event);
        EXPECT_TRUE(m_viewer->frame(steps));
    }
    ViewerEvent moveTo(const Vec3& point) const
    {
        const PicturePoint p = projected(m_viewer->control().camera(), m_viewer->size(), point);
        return ViewerEvent::move(p.m_x, p.m_y);
    }
    void slide(std::size_t index, double share)
    {
        const PictureRectangle area = m_viewer->sliderArea(index);
        ASSERT_GT(area.m_width, 50);
        play(ViewerEvent::move(area.m_x + share * area.m_width, area.m_y + 0.5 * area.m_height), 0);
        play(ViewerEvent::press(), 0);
        play(ViewerEvent::release(), 0);
    }
    Vec3 middle() const
    {
        Vec3 sum;
        for (int i = 0; i < m_run->nodeCount(0); ++i) sum += m_run->node(0, i);
        return (1. / m_run->nodeCount(0)) * sum;
    }

    std::unique_ptr<SceneRun> m_run;
    std::optional<SceneSimulation> m_simulation;
    std::unique_ptr<Viewer> m_viewer;
};

const char* const kCube = R"({ "step": 0.01, "softBodies": [
    { "name": "cube", "mesh": { "box": [0.4, 0.4, 0.4], "tets": 300 }, "material": "rubber", "position": [0, 0.2, 0], "friction": 0.3 },
    { "name": "other", "mesh": { "box": [0.2, 0.2, 0.2], "tets": 100 }, "material": "jelly", "position": [1, 0.1, 0] }],
    "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }], "camera": { "direction": [0, 0.4, 1] } })";

TEST_F(SceneViewer, AScriptedDragPullsTheBodyAlong)
{
    open(kCube);
    const Image before = m_viewer->screenshot();
    std::set<std::array<int, 3>> colours;
    for (int y = 0; y < before.m_size.m_height; ++y)
        for (int x = 0; x < before.m_size.m_width; ++x) colours.insert(before.at(x, y));
    EXPECT_GT(colours.size(), 500u) << "bodies, ground, shadow, sky and the panel";

    play(ViewerEvent::key(ViewerKey::panel), 0);  // objects under the panel cannot be picked
    const Vec3 hold{0, 0.3, 0.2};
    play(moveTo(hold));
    play(ViewerEvent::press());
    EXPECT_TRUE(m_viewer->control().dragging());
    for (int k = 1; k <= 5; ++k) play(moveTo(hold + Vec3{-0.1 * k, 0.04 * k, 0}), 10);
    m_viewer->frame(50);
    EXPECT_LT(middle().x, -0.3);
    EXPECT_GT(middle().y, 0.22) << "lifted";
    EXPECT_NEAR(m_run->momentum(1).x, 0, 0.01) << "the other body was not held";
    play(ViewerEvent::release());
    EXPECT_FALSE(m_viewer->control().dragging());
    m_viewer->frame(100);
    EXPECT_NEAR(middle().y, 0.2, 0.02) << "let go, it lies on the ground again";
    EXPECT_NE(m_viewer->screenshot().m_pixels, before.m_pixels);
}

TEST_F(SceneViewer, MouseBesideABodyTurnsTheCamera)
{
    open(kCube);
    const Vec3 eye = m_viewer->control().camera().m_eye;
    play(ViewerEvent::move(790, 590), 0);
    play(ViewerEvent::press(), 0);
    EXPECT_FALSE(m_viewer->control().dragging());
    play(ViewerEvent::move(700, 590), 0);
    EXPECT_GT(norm(m_viewer->control().camera().m_eye - eye), 0.01);
}

TEST_F(SceneViewer, BodiesStopAcceleratingWithoutGravity)
{
    open(
        R"({ "step": 0.01, "softBodies": [{ "name": "cube", "mesh": { "box": [0.4, 0.4, 0.4], "tets": 300 }, "material": "rubber" }],
             "rigidBodies": [{ "name": "ball", "shape": { "sphere": 0.2 }, "mass": 1, "position": [1, 0, 0] }] })");
    m_viewer->frame(10);
    const double mass = m_run->m_world.soft(0).getTotalMass(), fallen = -9.81 * 0.1;
    EXPECT_NEAR(m_run->momentum(0).y / mass, fallen, 1e-3);
    slide(3, 0);
    EXPECT_EQ(m_simulation->parameters()[3].m_value, 0);
    m_viewer->frame(30);
    EXPECT_NEAR(m_run->momentum(0).y / mass, fallen, 1e-3);
    EXPECT_NEAR(m_run->m_world.rigid(0).getLinearVelocity().y(), fallen, 1e-3);
    slide(3, 0.9);
    EXPECT_NEAR(m_simulation->parameters()[3].m_value, 27, 1);
    m_viewer->frame(10);
    EXPECT_NEAR(m_run->momentum(0).y / mass, fallen - m_simulation->parameters()[3].m_value * 0.1, 0.01);
}

// A slider changes one value, and keeps values in which bodies differ.
TEST_F(SceneViewer, MaterialSlidersKeepHiddenValues)
{
    open(kCube);
    const double mass = m_run->m_world.soft(0).getTotalMass();
    EXPECT_NEAR(m_simulation->parameters()[0].m_value, Material::rubber().m_youngModulus, 1);
    slide(2, 0.5);
    EXPECT_NEAR(m_simulation->parameters()[2].m_value, 0.05, 0.005);
    EXPECT_NEAR(m_simulation->parameters()[0].m_value, Material::rubber().m_youngModulus, 1);
    m_viewer->frame(100);
    EXPECT_EQ(m_run->m_world.soft(0).getTotalMass(), mass);
    double top = 0;
    for (int i = 0; i < m_run->nodeCount(1); ++i) top = std::max(top, m_run->node(1, i).y);
    EXPECT_LT(top, 0.19) << "jelly sags by rho g h^2 / 2 E = 20 mm under its weight, rubber would by 0.1 mm";
    EXPECT_THAT(m_simulation->status(), testing::HasSubstr("tetrahedra"));
}

// A user's minute in the window: a mesh, a ball onto it, back in time, and a file that cannot be opened.
TEST_F(SceneViewer, ADroppedMeshIsHitByABallAndTimeGoesBack)
{
    open(R"({ "step": 0.01, "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }] })");
    const TemporaryFolder folder;
    writeBall(folder.path("ball.off"), 0.3, 10);
    const Vec3 eye = m_viewer->control().camera().m_eye;
    play(ViewerEvent::drop({folder.path("ball.off")}), 0);
    for (int k = 0; k < 2000 && !m_simulation->progress().m_text.empty(); ++k)
    {
        m_viewer->frame(0);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_EQ(m_run->m_world.softCount(), 1) << m_simulation->message();
    m_viewer->frame(60);
    EXPECT_GT(norm(m_viewer->control().camera().m_eye - eye), 0.01) << "the view is of the mesh";

    const double top = 2 * middle().y;
    play(moveTo(middle()), 0);
    play(ViewerEvent::key(ViewerKey::ball), 0);
    ASSERT_EQ(m_run->m_world.rigidCount(), 2);
    const auto ballHeight = [&] { return double(m_run->m_world.rigid(1).getWorldTransform().getOrigin().y()); };
    const double start = ballHeight();
    EXPECT_GT(start, 0.5 * top);
    play(ViewerEvent::key(ViewerKey::forces), 0);
    play(ViewerEvent::key(ViewerKey::stress), 0);
    const Image before = m_viewer->screenshot();
    m_viewer->frame(40);
    EXPECT_LT(ballHeight(), start - 0.05);
    EXPECT_NE(m_viewer->screenshot().m_pixels, before.m_pixels);
    for (int k = 0; k < 8; ++k) play(ViewerEvent::key(ViewerKey::earlier), 5);
    EXPECT_TRUE(m_viewer->control().paused());
    EXPECT_NEAR(ballHeight(), start, 1e-6);
    play(ViewerEvent::key(ViewerKey::step), 5);
    EXPECT_EQ(m_run->m_world.steps(), 61) << "one step, from there";

    play(ViewerEvent::drop({folder.path("missing.off")}), 0);
    for (int k = 0; k < 2000 && !m_simulation->progress().m_text.empty(); ++k) m_viewer->frame(0);
    EXPECT_THAT(m_simulation->message(), testing::HasSubstr("missing.off"));
    EXPECT_EQ(m_run->m_world.softCount(), 1);
}

}  // namespace
}  // namespace bullet_fem
