// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/viewer_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include "io/temporary_folder.h"
#include "pictures/ball_simulation.h"
#include "tools/pictures/viewer.h"

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

TEST_F(ViewerControlTest, LeftButtonDragsWhatItHits)
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

TEST(ViewerWithout, ADisplaySaysSo)
{
    unsetenv("DISPLAY");
    BallSimulation simulation;
    EXPECT_THAT(messageOf<std::runtime_error>([&] { Viewer viewer(simulation); }),
                testing::AllOf(testing::HasSubstr("DISPLAY"), testing::HasSubstr("xvfb-run")));
}

}  // namespace
}  // namespace bullet_fem
