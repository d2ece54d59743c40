// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Values that a program writes to Bullet's contact points, in islands with FEM bodies in contact: a contact that is not
// finite is left out or has no friction, and the rest is solved.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "plugin/scenes/loaded_rigid_scene.h"

namespace bullet_fem
{
namespace
{

struct BadPointCase
{
    const char* m_name;
    std::function<void(btManifoldPoint&)> m_write;
    bool m_carries;  // the contact still carries
};

const btScalar kNoNumber = std::numeric_limits<btScalar>::quiet_NaN();

std::vector<BadPointCase> badPoints()
{
    const auto direct = [](btManifoldPoint& point, const btVector3& d, const btVector3& e)
    {
        point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
        point.m_lateralFrictionDir1 = d;
        point.m_lateralFrictionDir2 = e;
    };
    const btVector3 x(1, 0, 0), y(0, 1, 0), none(0, 0, 0);
    return {{"nanFriction", [](btManifoldPoint& point) { point.m_combinedFriction = kNoNumber; }, true},
            {"negativeFriction", [](btManifoldPoint& point) { point.m_combinedFriction = -1; }, true},
            {"nanRestitution", [](btManifoldPoint& point) { point.m_combinedRestitution = kNoNumber; }, false},
            {"nanRollingFriction", [](btManifoldPoint& point) { point.m_combinedRollingFriction = kNoNumber; }, true},
            {"nanSpinningFriction",
             [](btManifoldPoint& point)
             {
                 point.m_combinedRollingFriction = btScalar(0.01);
                 point.m_combinedSpinningFriction = kNoNumber;
             },
             true},
            {"nanMotion",
             [=](btManifoldPoint& point)
             {
                 direct(point, x, y);
                 point.m_contactMotion1 = kNoNumber;
             },
             true},
            {"nanDirection", [=](btManifoldPoint& point) { direct(point, x * kNoNumber, y); }, true},
            {"noDirection", [=](btManifoldPoint& point) { direct(point, none, none); }, true},
            {"equalDirections", [=](btManifoldPoint& point) { direct(point, x, x); }, true},
            {"nanCfm",
             [](btManifoldPoint& point)
             {
                 point.m_contactPointFlags |= BT_CONTACT_FLAG_HAS_CONTACT_CFM;
                 point.m_contactCFM = kNoNumber;
             },
             false}};
}

std::function<void(btManifoldPoint&)>* g_write = nullptr;

bool writePoint(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int, const btCollisionObjectWrapper*, int,
                int)
{
    (*g_write)(point);
    return true;
}

class BadPoints : public testing::TestWithParam<BadPointCase>
{
protected:
    BadPoints()
    {
        g_write = &m_write;
        gContactAddedCallback = writePoint;
    }
    ~BadPoints() override { gContactAddedCallback = nullptr; }

    std::function<void(btManifoldPoint&)> m_write = GetParam().m_write;
};

// A tray on a bad tray on the ground.
TEST_P(BadPoints, LeaveTheRestSolved)
{
    LoadedRigidScene scene(Coupling::coupled);
    scene.m_world.addFloorBox();
    const double height = LoadedRigidScene::kTray.z / 2;
    btRigidBody& tray = scene.addLoadedTray({0, 0, height});
    btRigidBody& bad = scene.addBox({0.05, 0.05, 0.05}, 0.1, {0.15, 0, LoadedRigidScene::kTray.z + 0.025});
    bad.setCollisionFlags(bad.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        ASSERT_TRUE(scene.allFinite({&tray})) << k;
    }
    EXPECT_TRUE(scene.touches());
    EXPECT_LT(tray.getLinearVelocity().length(), 1e-2);
    EXPECT_NEAR(double(tray.getCenterOfMassPosition().z()), height, 2e-3);
    if (!GetParam().m_carries) return;
    EXPECT_NEAR(double(bad.getCenterOfMassPosition().z()), 2 * height + 0.025, 5e-3);
}

INSTANTIATE_TEST_SUITE_P(Cases, BadPoints, testing::ValuesIn(badPoints()),
                         [](const auto& suite) { return suite.param.m_name; });

}  // namespace
}  // namespace bullet_fem
