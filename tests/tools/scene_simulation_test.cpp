// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// All actions of the window, without a window.
#include "tools/scene/scene_simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <utility>

#include "io/temporary_folder.h"
#include "tools/mesh_files.h"
#include "tools/scene_run.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;

const char* const kBlockOnGround = R"({ "step": 0.01, "softBodies": [
    { "name": "block", "mesh": { "box": [1, 0.4, 1], "tets": 200 }, "material": "rubber", "position": [0, 0.2, 0] }],
    "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }] })";

// Stress at rest on it does not depend on how the block came there.
const char* const kBlockOnIce = R"({ "step": 0.01, "softBodies": [
    { "name": "block", "mesh": { "box": [1, 0.4, 1], "tets": 200 }, "material": "rubber", "position": [0, 0.2, 0] }],
    "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] }, "friction": 0 }] })";

class SceneSimulationTest : public testing::Test
{
protected:
    void begin(const SceneDescription& scene, const SceneHistorySettings& history = {10, 1u << 28u})
    {
        m_simulation.reset();
        m_world = std::make_unique<SceneWorld>(scene);
        SceneSimulationSettings settings;
        settings.m_history = history;
        settings.m_meshes.m_cage.m_targetTets = 200;
        settings.m_meshes.m_cage.m_maxTets = 5000000;
        settings.m_meshes.m_bake.m_material = Material::rubber();
        m_simulation = std::make_unique<SceneSimulation>(*m_world, settings);
    }
    void begin(const std::string& json) { begin(parseScene(json, ".")); }
    void steps(int count)
    {
        for (int k = 0; k < count; ++k) m_simulation->step();
    }
    /// Waits as a user would while files are loaded.
    void waitUntilOpened()
    {
        for (; !m_simulation->progress().m_text.empty(); std::this_thread::sleep_for(std::chrono::milliseconds(1)))
            m_simulation->update();
    }
    Vec3 rigidAt(int i) const { return vec3(std::as_const(*m_world).rigid(i).getWorldTransform().getOrigin()); }
    double lowest(int soft) const
    {
        double least = 1e9;
        for (int i = 0; i < m_world->soft(soft).m_nodes.size(); ++i)
            least = std::min(least, double(m_world->soft(soft).m_nodes[i].m_x.y()));
        return least;
    }
    static PictureRay downAt(double x, double z) { return {{x, 5, z}, {x, -5, z}}; }

    TemporaryFolder m_folder;
    std::unique_ptr<SceneWorld> m_world;
    std::unique_ptr<SceneSimulation> m_simulation;
};

TEST_F(SceneSimulationTest, DrawsTheWayBetweenTheLastTwoStates)
{
    begin(R"({ "gravity": [0, 0, 0], "step": 0.02, "softBodies": [
        { "name": "block", "mesh": { "box": [1, 1, 1], "tets": 40 }, "velocity": [10, 0, 0] }] })");
    steps(3);
    const auto foremost = [this]
    {
        double x = -1e9;
        for (const Vec3& position : m_simulation->scene().m_meshes[0].m_positions) x = std::max(x, position.x);
        return x;
    };
    const double now = foremost();
    m_simulation->setDrawnTime(-0.5);
    EXPECT_NEAR(foremost(), now - 0.1, 1e-5);
    m_simulation->setDrawnTime(0);
    EXPECT_EQ(foremost(), now);
}

TEST_F(SceneSimulationTest, BoxesAndBallsFallAtTheCursor)
{
    begin(kBlockOnGround);
    m_simulation->act(ViewerKey::box, downAt(2, 0.3));
    m_simulation->act(ViewerKey::ball, downAt(0.1, -0.1));
    EXPECT_EQ(m_simulation->message(), "");
    ASSERT_EQ(m_world->rigidCount(), 3);
    const double radius = 0.5 * std::sqrt(1 + 0.16 + 1), size = 0.22 * radius;  // of the block, and of the added ball
    EXPECT_NEAR(norm(rigidAt(1) - Vec3{2, 1.5 * size, 0.3}), 0, 1e-3) << "its own size above the ground";
    EXPECT_NEAR(norm(rigidAt(2) - Vec3{0.1, 0.4 + 1.5 * size, -0.1}), 0, 1e-3) << "above the block";
    EXPECT_NEAR(1 / double(m_world->rigid(1).getInvMass()), 500 * size * size * size, 1e-3);
    EXPECT_NEAR(1 / double(m_world->rigid(2).getInvMass()), 500 * 3.14159265 / 6 * size * size * size, 1e-3);
    EXPECT_EQ(m_simulation->scene().m_meshes.size(), 3u) << "all are drawn";
    steps(150);
    EXPECT_NEAR(rigidAt(1).y, 0.5 * size, 3e-3) << "on the ground";
    EXPECT_NEAR(rigidAt(2).y, 0.4 + 0.5 * size, 6e-3) << "on the block";
    EXPECT_EQ(m_simulation->scene().m_meshes.size(), 3u);
}

TEST_F(SceneSimulationTest, BoxesAppearBeforeTheCameraWithoutATarget)
{
    begin(kBlockOnGround);
    m_simulation->act(ViewerKey::box, {{0, 1, 4}, {0, 9, -16}});
    EXPECT_NEAR(norm(rigidAt(1) - Vec3{0, 4.2, -4}), 0, 1e-5);
}

TEST_F(SceneSimulationTest, AFileBecomesABody)
{
    writeBall(m_folder.path("ball.off"), 0.3, 10);
    begin(emptyScene());
    const int view = m_simulation->views();
    m_simulation->open(m_folder.path("ball.off"));
    EXPECT_THAT(m_simulation->progress().m_text, HasSubstr("ball.off: "));
    EXPECT_EQ(m_world->softCount(), 0);
    steps(2);  // the window responds while it is made
    waitUntilOpened();
    ASSERT_EQ(m_world->softCount(), 1);
    EXPECT_THAT(m_simulation->message(), testing::AllOf(HasSubstr(" tetrahedra, 0."), HasSubstr(" m long: ball.off")));
    EXPECT_NE(m_simulation->views(), view) << "the camera goes there";
    EXPECT_GT(lowest(0), 0.01);
    EXPECT_LT(lowest(0), 0.2);
    const double E = m_simulation->parameters()[0].m_value;
    EXPECT_NEAR(E, Material::rubber().m_youngModulus, 1);
    steps(150);
    EXPECT_NEAR(lowest(0), 0, 2e-3) << "it lies on the ground";
    m_simulation->setParameter(0, 0.5 * E);
    EXPECT_NEAR(m_simulation->parameters()[0].m_value, 0.5 * E, 1);
    steps(50);
    EXPECT_NEAR(lowest(0), 0, 2e-3);

    m_simulation->open({m_folder.path("ball.off"), m_folder.path("ball.off")}, downAt(0, 0));
    EXPECT_THAT(m_simulation->progress().m_text, HasSubstr("1 more to come"));
    waitUntilOpened();
    ASSERT_EQ(m_world->softCount(), 3);
    EXPECT_GT(lowest(1), 0.55) << "above the first";
    EXPECT_GT(lowest(2), lowest(1) + 0.5);
    steps(100);
    EXPECT_GT(lowest(2), -5e-3);
}

TEST_F(SceneSimulationTest, LargeAndSmallMeshesAreQuestioned)
{
    writeBall(m_folder.path("millimetres.off"), 300, 8);
    begin(emptyScene());
    m_simulation->open(m_folder.path("millimetres.off"));
    waitUntilOpened();
    EXPECT_THAT(m_simulation->message(), HasSubstr("--scale"));
    m_simulation->scene();
    EXPECT_TRUE(valid(m_simulation->scene(), m_simulation->scene().m_camera));
}

TEST_F(SceneSimulationTest, ABrokenFileIsASentenceAndTheNextOneIsOpened)
{
    std::ofstream(m_folder.path("broken.off")) << "OFF\n3 1 0\n0 0 0\n";
    std::ofstream(m_folder.path("noise.stl")) << std::string(200000, '\x8f');
    writeBall(m_folder.path("ball.off"), 0.3, 8);
    begin(kBlockOnGround);
    for (const char* name : {"broken.off", "noise.stl", "missing.msh", "", "x.json"})
    {
        m_simulation->open({m_folder.path(name)}, downAt(0, 0));
        waitUntilOpened();
        EXPECT_THAT(m_simulation->message(), HasSubstr(name));
        EXPECT_NE(m_simulation->message(), "");
        EXPECT_EQ(m_world->softCount(), 1);
        steps(1);
    }
    m_simulation->open({m_folder.path("broken.off"), m_folder.path("ball.off")}, downAt(0, 0));
    waitUntilOpened();
    EXPECT_EQ(m_world->softCount(), 2);
}

TEST_F(SceneSimulationTest, OpeningIsGivenUpAtOnce)
{
    writeBall(m_folder.path("ball.off"), 0.3, 60);
    writeBall(m_folder.path("small.off"), 0.3, 6);
    begin(kBlockOnGround);
    m_simulation->open({m_folder.path("ball.off"), m_folder.path("small.off")}, downAt(0, 0));
    m_simulation->act(ViewerKey::cancel, downAt(0, 0));
    EXPECT_THAT(m_simulation->message(), HasSubstr("ball.off was given up"));
    EXPECT_THAT(m_simulation->progress().m_text, HasSubstr("small.off")) << "the next one";
    waitUntilOpened();
    EXPECT_EQ(m_world->softCount(), 2);
    EXPECT_THAT(m_simulation->message(), HasSubstr("small.off"));
    m_simulation->act(ViewerKey::cancel, downAt(0, 0));
    EXPECT_EQ(m_simulation->message(), "") << "no action to cancel";
}

// The arrows are nodal forces in newtons; their sum is the weight.
TEST_F(SceneSimulationTest, ForcesAreArrowsWithALegend)
{
    begin(kBlockOnGround);
    steps(150);
    EXPECT_TRUE(m_simulation->scene().m_arrows.empty());
    m_simulation->act(ViewerKey::forces, downAt(0, 0));
    const PictureScene& scene = m_simulation->scene();
    ASSERT_EQ(scene.m_arrows.size(), 1u);
    Vec3 sum;
    double longest = 0;
    for (const PictureArrow& arrow : scene.m_arrows[0].m_arrows)
    {
        sum += arrow.m_vector;
        longest = std::max(longest, norm(arrow.m_vector));
    }
    const double weight = 9.81 * double(m_world->soft(0).getTotalMass());
    EXPECT_NEAR(norm(sum - Vec3{0, weight, 0}), 0, 0.02 * weight);
    EXPECT_EQ(scene.m_arrows[0].m_title + " [" + scene.m_arrows[0].m_unit + "]", "contact force [N]");
    EXPECT_NEAR(scene.m_arrows[0].m_longest, longest, 1e-6 * longest) << "the legend's range begins with what is shown";
    m_simulation->act(ViewerKey::forces, downAt(0, 0));
    EXPECT_TRUE(m_simulation->scene().m_arrows.empty());
}

TEST_F(SceneSimulationTest, StressIsColoursWithALegend)
{
    begin(kBlockOnGround);
    steps(100);
    EXPECT_TRUE(m_simulation->scene().m_meshes[0].m_scalars.empty());
    m_simulation->act(ViewerKey::stress, downAt(0, 0));
    const PictureScene& scene = m_simulation->scene();
    ASSERT_EQ(scene.m_meshes[0].m_scalars.size(), scene.m_meshes[0].m_positions.size());
    EXPECT_EQ(scene.m_colourScale.m_unit, "Pa");
    const double atFoot = 1000 * 9.81 * 0.4;  // rho g h [Pa] of the weight above
    EXPECT_GT(scene.m_colourScale.m_high, 0.3 * atFoot);
    EXPECT_LT(scene.m_colourScale.m_high, 3 * atFoot);
    m_simulation->act(ViewerKey::stress, downAt(0, 0));
    EXPECT_TRUE(m_simulation->scene().m_meshes[0].m_scalars.empty());
}

TEST_F(SceneSimulationTest, TheRangeGrowsAtOnceAndFallsBackWhenAnImpactIsOver)
{
    begin(kBlockOnIce);
    m_simulation->act(ViewerKey::stress, downAt(0, 0));
    const auto range = [&] { return m_simulation->scene().m_colourScale.m_high; };
    steps(100);
    for (int k = 0; k < 400; ++k, m_simulation->scene()) m_simulation->step();
    const double atRest = range();
    m_world->soft(0).addVelocity({0, -4, 0});
    double most = 0;
    for (int k = 0; k < 20; ++k)
    {
        m_simulation->step();
        most = std::max(most, range());
    }
    EXPECT_GT(most, 5 * atRest);
    for (int k = 0; k < 100; ++k, range()) m_simulation->step();
    EXPECT_GT(range(), 0.4 * most);
    EXPECT_LT(range(), 0.75 * most);
    for (int k = 0; k < 1500; ++k, range()) m_simulation->step();
    EXPECT_NEAR(range(), atRest, 0.05 * atRest);
}

TEST_F(SceneSimulationTest, KeysLeadBackInTimeAlsoWhileABodyIsHeld)
{
    begin(kBlockOnGround);
    steps(20);
    ASSERT_TRUE(m_simulation->beginDrag({{0, 0.2, 5}, {0, 0.2, -5}}));
    m_simulation->moveDrag({{0, 0.9, 5}, {0, 0.9, -5}});
    const PictureRay anywhere = downAt(0, 0);
    steps(25);  // in states 30 and 40 a body is held
    EXPECT_THAT(m_simulation->status(), HasSubstr("Kept since 0.00 s"));
    for (const int step : {40, 30, 20, 10, 0})
    {
        m_simulation->act(ViewerKey::earlier, anywhere);
        EXPECT_EQ(m_simulation->message(), "");
        EXPECT_EQ(m_world->steps(), step);
    }
    EXPECT_THAT(m_simulation->status(), HasSubstr("Back in time: 0.00 s of 0.45 s"));
    m_simulation->act(ViewerKey::earlier, anywhere);
    EXPECT_THAT(m_simulation->message(), HasSubstr("Nothing earlier"));
    m_simulation->act(ViewerKey::later, anywhere);
    EXPECT_EQ(m_world->steps(), 10);
    EXPECT_EQ(m_simulation->message(), "");
    steps(40);
    EXPECT_NEAR(lowest(0), 0, 1e-3) << "without support";
    m_simulation->act(ViewerKey::later, anywhere);
    EXPECT_THAT(m_simulation->message(), HasSubstr("latest"));
}

TEST_F(SceneSimulationTest, WarningsKeepFlagsOnceRaised)
{
    begin(kBlockOnGround);
    steps(2);
    EXPECT_EQ(m_simulation->warnings(), "");
    SceneDescription sunken = parseScene(kBlockOnGround, ".");
    sunken.m_softBodies[0].m_pose.m_position.y = 0.17;
    begin(sunken);
    steps(60);
    EXPECT_THAT(m_simulation->warnings(), HasSubstr("block: deep penetration, 0.01 s to "));
    EXPECT_EQ(m_world->fem().stepReport(&m_world->soft(0)).m_flags, 0) << "it is over";
}

TEST_F(SceneSimulationTest, ChangedMaterialRestartsTheHistory)
{
    begin(kBlockOnGround);
    steps(30);
    m_simulation->setParameter(3, 3);
    EXPECT_EQ(m_simulation->history().count(), 4) << "gravity is negligible";
    EXPECT_NEAR(m_simulation->parameters()[3].m_value, 3, 1e-12);
    m_simulation->setParameter(0, 2e6);
    EXPECT_EQ(m_simulation->history().count(), 1);
    m_simulation->act(ViewerKey::earlier, downAt(0, 0));
    EXPECT_THAT(m_simulation->message(), HasSubstr("Nothing earlier"));
    steps(20);
    m_simulation->act(ViewerKey::earlier, downAt(0, 0));
    EXPECT_EQ(m_simulation->message(), "");
}

}  // namespace
}  // namespace bullet_fem
