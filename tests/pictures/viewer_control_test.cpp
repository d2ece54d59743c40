// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/viewer_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cctype>
#include <fstream>
#include <iterator>

#include "io/temporary_folder.h"
#include "pictures/ball_simulation.h"
#include "tools/pictures/viewer.h"
#include "tools/pictures/viewer_panel.h"

namespace bullet_fem
{
namespace
{

constexpr PictureSize kSize{640, 480};

class ViewerControlTest : public testing::Test
{
protected:
    void send(const std::vector<ViewerEvent>& events)
    {
        for (const ViewerEvent& event : events) m_control.handle(event, kSize);
    }
    ViewerEvent moveTo(const Vec3& point) const
    {
        const PicturePoint p = projected(m_control.camera(), kSize, point);
        return ViewerEvent::move(p.m_x, p.m_y);
    }
    double distance() const { return norm(m_control.camera().m_eye - m_control.camera().m_target); }

    BallSimulation m_simulation;
    ViewerControl m_control{m_simulation};
    const PictureCamera m_start = m_simulation.m_scene.m_camera;
};

TEST(ViewerTimes, TellTheTimeOfAStepAndNotOfAFrame)
{
    ViewerTimes times;
    times.add(20, 4, 60);
    EXPECT_EQ(times.m_step[0], 5);
    EXPECT_EQ(times.m_frame, 60);
    times.add(0, 0, 16);
    EXPECT_EQ(times.m_next, 1) << "a pause has no steps";
    EXPECT_EQ(times.m_frame, 16);
}

TEST_F(ViewerControlTest, LeftButtonDragsTheHitBody)
{
    send({moveTo({0.4, 0.5, 0}), ViewerEvent::press()});
    EXPECT_TRUE(m_control.dragging());
    EXPECT_GT(m_simulation.m_rayLength, norm(m_simulation.m_centre - m_start.m_eye))
        << "the ray goes through the scene";
    send({moveTo({-0.5, 0.9, 0})});
    EXPECT_NEAR(norm(m_simulation.m_centre - Vec3{-0.5, 0.9, 0}), 0, 1e-9);
    send({ViewerEvent::release(MouseButton::right)});
    EXPECT_TRUE(m_simulation.m_held) << "by the left button still";
    send({ViewerEvent::release()});
    EXPECT_FALSE(m_simulation.m_held);
    send({moveTo({0, 0, 0})});
    EXPECT_EQ(m_simulation.m_moves, 1);
    EXPECT_EQ(norm(m_control.camera().m_eye - m_start.m_eye), 0) << "the camera stood still";
}

TEST_F(ViewerControlTest, LeftButtonOrbitsElsewhere)
{
    const double before = distance();
    send({moveTo({-0.8, 0, 0}), ViewerEvent::press(), moveTo({-0.5, 0.2, 0}), ViewerEvent::release()});
    EXPECT_NEAR(distance(), before, 1e-12);
    EXPECT_LT(m_control.camera().m_eye.x, -0.1) << "the scene follows the mouse to the right";
    EXPECT_LT(m_control.camera().m_eye.y, m_start.m_eye.y) << "and upwards";
    EXPECT_EQ(m_simulation.m_moves, 0);
    send({ViewerEvent::key(ViewerKey::resetView)});
    EXPECT_EQ(norm(m_control.camera().m_eye - m_start.m_eye), 0);
}

TEST_F(ViewerControlTest, RightButtonPansAndTheTargetFollowsTheMouse)
{
    const PicturePoint before = projected(m_control.camera(), kSize, {0, 0, 0});
    send({ViewerEvent::move(100, 100), ViewerEvent::press(MouseButton::right), ViewerEvent::move(150, 130)});
    const PicturePoint after = projected(m_control.camera(), kSize, {0, 0, 0});
    EXPECT_NEAR(after.m_x - before.m_x, 50, 0.5);
    EXPECT_NEAR(after.m_y - before.m_y, 30, 0.5);
}

TEST_F(ViewerControlTest, WheelZooms)
{
    const double before = distance();
    send({ViewerEvent::scroll(2)});
    EXPECT_NEAR(distance(), 0.81 * before, 1e-12);
    send({ViewerEvent::scroll(-2)});
    EXPECT_NEAR(distance(), before, 1e-12);
}

TEST_F(ViewerControlTest, KeysPauseAndStep)
{
    EXPECT_EQ(m_control.takeSteps(3), 3);
    send({ViewerEvent::key(ViewerKey::pause)});
    EXPECT_EQ(m_control.takeSteps(3), 0);
    send({ViewerEvent::key(ViewerKey::step), ViewerEvent::key(ViewerKey::step)});
    EXPECT_EQ(m_control.takeSteps(3), 2);
    EXPECT_EQ(m_control.takeSteps(3), 0);
    send({ViewerEvent::key(ViewerKey::pause)});
    EXPECT_EQ(m_control.takeSteps(1), 1);
    send({ViewerEvent::key(ViewerKey::step)});
    EXPECT_TRUE(m_control.paused()) << "a single step pauses";
    send({ViewerEvent::key(ViewerKey::wireframe), ViewerEvent::key(ViewerKey::panel),
          ViewerEvent::key(ViewerKey::close)});
    EXPECT_TRUE(m_control.wireframe() && !m_control.panelShown() && m_control.closing());
}

double distanceTo(const Vec3& point, const PictureRay& ray)
{
    const Vec3 along = (1 / norm(ray.m_to - ray.m_from)) * (ray.m_to - ray.m_from);
    return norm(cross(point - ray.m_from, along));
}

TEST_F(ViewerControlTest, OtherKeysReachTheSimulationWithTheCursor)
{
    send({moveTo({0.4, 0.5, 0}), ViewerEvent::key(ViewerKey::box)});
    EXPECT_NEAR(distanceTo({0.4, 0.5, 0}, m_simulation.m_cursor), 0, 1e-9);
    EXPECT_FALSE(m_control.paused());
    for (const ViewerKey key : {ViewerKey::ball, ViewerKey::forces, ViewerKey::stress, ViewerKey::cancel})
        send({ViewerEvent::key(key)});
    EXPECT_THAT(m_simulation.m_keys, testing::ElementsAre(ViewerKey::box, ViewerKey::ball, ViewerKey::forces,
                                                          ViewerKey::stress, ViewerKey::cancel));
    send({ViewerEvent::key(ViewerKey::help), ViewerEvent::key(ViewerKey::film)});
    EXPECT_TRUE(m_control.helpShown() && m_control.filming());
    send({ViewerEvent::key(ViewerKey::help), ViewerEvent::key(ViewerKey::film)});
    EXPECT_FALSE(m_control.helpShown() || m_control.filming());
    EXPECT_EQ(m_simulation.m_keys.size(), 5u);
}

TEST_F(ViewerControlTest, GoingBackInTimePausesAndLetsGo)
{
    send({moveTo({0.4, 0.5, 0}), ViewerEvent::press(), ViewerEvent::key(ViewerKey::earlier)});
    EXPECT_TRUE(m_control.paused());
    EXPECT_FALSE(m_control.dragging() || m_simulation.m_held);
    send({ViewerEvent::key(ViewerKey::pause), ViewerEvent::key(ViewerKey::later)});
    EXPECT_TRUE(m_control.paused());
    EXPECT_THAT(m_simulation.m_keys, testing::ElementsAre(ViewerKey::earlier, ViewerKey::later));
    send({ViewerEvent::key(ViewerKey::pause)});
    EXPECT_EQ(m_control.takeSteps(2), 2) << "it runs on";
}

TEST_F(ViewerControlTest, FilesAreDroppedAtTheCursor)
{
    send({moveTo({-0.2, 0.3, 0}), ViewerEvent::drop({"a.off", "b.msh"})});
    EXPECT_THAT(m_simulation.m_files, testing::ElementsAre("a.off", "b.msh"));
    EXPECT_NEAR(distanceTo({-0.2, 0.3, 0}, m_simulation.m_cursor), 0, 1e-9);
}

TEST_F(ViewerControlTest, ChangedViewMovesTheCamera)
{
    m_simulation.m_scene.m_camera.m_eye = {0, 3, 9};
    m_control.update();
    EXPECT_EQ(norm(m_control.camera().m_eye - m_start.m_eye), 0);
    m_simulation.m_views = 1;
    m_control.update();
    EXPECT_EQ(norm(m_control.camera().m_eye - Vec3{0, 3, 9}), 0);
    send({ViewerEvent::scroll(3)});
    const double zoomed = distance();
    m_control.update();
    EXPECT_EQ(distance(), zoomed) << "once";
}

TEST(ViewerKeys, AllAreListedInHelpAndDocument)
{
    ASSERT_EQ(viewerKeys().size(), static_cast<std::size_t>(ViewerKey::close) + 1);
    EXPECT_EQ(viewerKeys()[static_cast<std::size_t>(ViewerKey::box)].m_keys, "B");
    EXPECT_EQ(viewerKeys()[static_cast<std::size_t>(ViewerKey::close)].m_keys, "Escape");
    std::ifstream file(BULLETFEM_TOOL_DOCUMENT);
    const std::string document{std::istreambuf_iterator<char>(file), {}}, help = "\n" + viewerHelpText();
    for (const ViewerHelp& line : viewerKeys())
    {
        EXPECT_NE(line.m_meaning, "");
        EXPECT_THAT(help, testing::HasSubstr("\n  " + line.m_keys + "  "));
        std::string label = line.m_keys;
        if (label.size() > 2) label[0] = static_cast<char>(std::tolower(label[0]));
        EXPECT_THAT(document, testing::HasSubstr("\n| " + label + " | "));
    }
}

TEST(ViewerWithoutDisplay, ReportsTheMissingDisplay)
{
    unsetenv("DISPLAY");
    BallSimulation simulation;
    EXPECT_THAT(messageOf<std::runtime_error>([&] { Viewer viewer(simulation); }),
                testing::AllOf(testing::HasSubstr("DISPLAY"), testing::HasSubstr("xvfb-run")));
}

}  // namespace
}  // namespace bullet_fem
