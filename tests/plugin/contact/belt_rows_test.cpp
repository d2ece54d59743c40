// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A conveyor belt by Bullet's contact motion, with a soft payload on the tray that it takes along.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "plugin/scenes/loaded_rigid_scene.h"

namespace bullet_fem
{
namespace
{

constexpr double kBelt = 1.5;  // speed of the belt [m/s]

// Bullet's belts: a target velocity along the first direction of friction.
bool runBelt(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int, const btCollisionObjectWrapper*, int,
             int)
{
    point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
    point.m_lateralFrictionDir1 = btVector3(1, 0, 0);
    point.m_lateralFrictionDir2 = btVector3(0, 1, 0);
    point.m_contactMotion1 = btScalar(kBelt);
    return true;
}

class Belt : public testing::Test
{
protected:
    Belt() { gContactAddedCallback = runBelt; }
    ~Belt() override { gContactAddedCallback = nullptr; }

    static std::vector<double> speeds(Coupling coupling, LoadedRigidScene::Payload payload)
    {
        LoadedRigidScene scene(coupling, payload);
        scene.m_world.bullet().getSolverInfo().m_solverMode |=
            SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
        btRigidBody& ground = scene.m_world.addFloorBox();
        ground.setCollisionFlags(ground.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
        const btRigidBody& tray = scene.addLoadedTray({0, 0, LoadedRigidScene::kTray.z / 2}, 0.5);
        std::vector<double> speeds;
        for (int k = 0; k < 60; ++k)
        {
            scene.m_world.step();
            speeds.push_back(double(tray.getLinearVelocity().x()));
        }
        return speeds;
    }
};

TEST_F(Belt, TakesTheTrayAsInBulletsWorld)
{
    const std::vector<double> twin = speeds(Coupling::swap, LoadedRigidScene::Payload::rigid);
    const std::vector<double> ours = speeds(Coupling::coupled, LoadedRigidScene::Payload::soft);
    ASSERT_NEAR(std::fabs(twin.back()), kBelt, 1e-3);
    EXPECT_NEAR(ours.back(), twin.back(), 2e-3);
    for (std::size_t k = 3; k < 15; ++k) EXPECT_NEAR(ours[k], twin[k], 0.1 * kBelt) << k;
}

}  // namespace
}  // namespace bullet_fem
