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
    bool m_carries;            // the contact still carries
    bool m_isFlagged = false;  // at rest
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
             false, true}};
}

bool isFlagged(const LoadedRigidScene& scene)
{
    return (scene.m_world.fem().stepReport(scene.m_softPayloads.front()).m_flags & BT_FEM_BAD_CONSTRAINT) != 0;
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
    bool anyFlagged = false;
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        ASSERT_TRUE(scene.allFinite({&tray})) << k;
        anyFlagged = anyFlagged || isFlagged(scene);
    }
    EXPECT_EQ(anyFlagged, GetParam().m_isFlagged);
    EXPECT_TRUE(scene.touches());
    EXPECT_LT(tray.getLinearVelocity().length(), 1e-2);
    EXPECT_NEAR(double(tray.getCenterOfMassPosition().z()), height, 2e-3);
    if (!GetParam().m_carries) return;
    EXPECT_NEAR(double(bad.getCenterOfMassPosition().z()), 2 * height + 0.025, 5e-3);
}

// A motor of negative largest impulse has a lower limit above the upper one.
TEST(BadMotor, IsLeftOutAndFlaggedWhileItIsBad)
{
    for (const Coupling coupling : {Coupling::swap, Coupling::coupled})
    {
        LoadedRigidScene scene(coupling);
        scene.m_world.addFloorBox();
        btRigidBody& tray = scene.addLoadedTray({0, 0, LoadedRigidScene::kTray.z / 2});
        btRigidBody& flap = scene.addBox({0.05, 0.05, 0.05}, 0.1, {0.25, 0, 0.2});
        auto& hinge = scene.join<btHingeConstraint>(tray, flap, btVector3(btScalar(0.25), 0, btScalar(0.175)),
                                                    btVector3(0, 0, 0), btVector3(0, 1, 0), btVector3(0, 1, 0));
        tray.setActivationState(DISABLE_DEACTIVATION);
        scene.m_softPayloads.front()->setActivationState(DISABLE_DEACTIVATION);
        for (const bool isBad : {false, true, false})
        {
            hinge.enableAngularMotor(isBad, 1, -1);
            for (int k = 0; k < 20; ++k)
            {
                scene.m_world.step();
                ASSERT_TRUE(scene.allFinite({&tray, &flap})) << k;
            }
            EXPECT_EQ(isFlagged(scene), isBad) << couplingName(coupling);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Cases, BadPoints, testing::ValuesIn(badPoints()),
                         [](const auto& suite) { return suite.param.m_name; });

}  // namespace
}  // namespace bullet_fem
