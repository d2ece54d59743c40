// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rows of Bullet's joints that no solver can satisfy, in islands with FEM bodies in contact: the rest is solved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "plugin/scenes/loaded_rigid_scene.h"

namespace bullet_fem
{
namespace
{

using Info = btTypedConstraint::btConstraintInfo2;

/// A constraint between a body and the world with rows that a test writes.
class WrittenRows : public btTypedConstraint
{
public:
    WrittenRows(btRigidBody& body, int count, std::function<void(Info&)> write)
        : btTypedConstraint(POINT2POINT_CONSTRAINT_TYPE, body), m_count(count), m_write(std::move(write))
    {
    }
    void getInfo1(btConstraintInfo1* info) override { info->m_numConstraintRows = m_count, info->nub = 6 - m_count; }
    void getInfo2(btConstraintInfo2* info) override { m_write(*info); }
    void setParam(int, btScalar, int) override {}
    btScalar getParam(int, int) const override { return 0; }

private:
    int m_count;
    std::function<void(Info&)> m_write;
};

struct BadCase
{
    const char* m_name;
    std::function<void(Info&)> m_write;  // of one row; the others are well-formed and without target
};

void alongX(Info& info)
{
    info.m_J1linearAxis[0] = 1;
    info.m_constraintError[0] = 0;
}

const btScalar kNan = std::numeric_limits<btScalar>::quiet_NaN(), kInf = std::numeric_limits<btScalar>::infinity();

std::vector<BadCase> badCases()
{
    return {{"zeroJacobian", [](Info& info) { info.m_constraintError[0] = 1; }},
            {"nanAxis",
             [](Info& info)
             {
                 alongX(info);
                 info.m_J1linearAxis[1] = kNan;
             }},
            {"infiniteAxis", [](Info& info) { info.m_J1angularAxis[2] = kInf; }},
            {"nanTarget",
             [](Info& info)
             {
                 alongX(info);
                 info.m_constraintError[0] = kNan;
             }},
            {"infiniteTarget",
             [](Info& info)
             {
                 alongX(info);
                 info.m_constraintError[0] = kInf;
             }},
            {"negativeCfm",
             [](Info& info)
             {
                 alongX(info);
                 info.cfm[0] = -1000;
             }},
            {"nanCfm",
             [](Info& info)
             {
                 alongX(info);
                 info.cfm[0] = kNan;
             }},
            {"contradictoryLimits",
             [](Info& info)
             {
                 alongX(info);
                 info.m_constraintError[0] = 1;
                 info.m_lowerLimit[0] = 1;
                 info.m_upperLimit[0] = -1;
             }},
            {"nanLimits",
             [](Info& info)
             {
                 alongX(info);
                 info.m_lowerLimit[0] = info.m_upperLimit[0] = kNan;
             }},
            {"tinyAxis", [](Info& info)
             {
                 info.m_J1linearAxis[0] = btScalar(1e-30);
                 info.m_constraintError[0] = 1;
             }}};
}

class BadRows : public testing::TestWithParam<BadCase>
{
};

TEST_P(BadRows, LeaveTheRestSolved)
{
    LoadedRigidScene scene(Coupling::coupled);
    btRigidBody& tray = scene.addLoadedTray();
    const auto& hanger = scene.join<btPoint2PointConstraint>(tray, btVector3(0, 0, 1));
    btRigidBody& pendulum = scene.addBox({0.1, 0.1, 0.1}, 1, {0, 0, -0.5});
    const auto& link = scene.join<btPoint2PointConstraint>(tray, pendulum, btVector3(0, 0, btScalar(-0.25)),
                                                           btVector3(0, 0, btScalar(0.25)));
    scene.join<WrittenRows>(tray, 1, GetParam().m_write);
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        ASSERT_TRUE(scene.allFinite({&tray, &pendulum})) << k;
    }
    EXPECT_TRUE(scene.touches());
    EXPECT_NEAR(LoadedRigidScene::forceOf(hanger).z, LoadedRigidScene::kWeight + kGravity,
                0.01 * LoadedRigidScene::kWeight);
    EXPECT_NEAR(LoadedRigidScene::forceOf(link).z, -kGravity, 0.01 * kGravity);
    EXPECT_LT(tray.getLinearVelocity().length(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Cases, BadRows, testing::ValuesIn(badCases()),
                         [](const auto& suite) { return suite.param.m_name; });

/// Fixed joints of a tray with the world, with frames that are apart by these offsets [m].
double heightOfTwice(const std::vector<double>& offsets, double& fastest, double& force)
{
    LoadedRigidScene scene(Coupling::coupled);
    btRigidBody& tray = scene.addLoadedTray();
    for (const double offset : offsets)
        scene.join<btFixedConstraint>(tray, btTypedConstraint::getFixedBody(), btTransform::getIdentity(),
                                      at(0, 0, btScalar(offset)));
    fastest = force = 0;
    for (int k = 0; k < 120; ++k)
    {
        scene.m_world.step();
        EXPECT_TRUE(scene.allFinite({&tray})) << k;
        fastest = std::max(fastest, double(tray.getLinearVelocity().length()));
    }
    EXPECT_TRUE(scene.touches());
    for (const auto& joint : scene.m_joints) force += LoadedRigidScene::forceOf(*joint).z;
    return double(tray.getCenterOfMassPosition().z());
}

TEST(JointsGivenTwice, ShareTheLoadIfTheyAgree)
{
    double fastest = 0, force = 0;
    EXPECT_NEAR(heightOfTwice({0, 0}, fastest, force), 0, 1e-4);
    EXPECT_LT(fastest, 1e-3);
    EXPECT_NEAR(force, LoadedRigidScene::kWeight, 0.01 * LoadedRigidScene::kWeight);
}

TEST(JointsGivenTwice, CompromiseIfTheyDoNot)
{
    double fastest = 0, force = 0;
    const double height = heightOfTwice({0, 0.01}, fastest, force);
    EXPECT_GT(height, -0.002);
    EXPECT_LT(height, 0.012);
    EXPECT_LT(fastest, 0.2);  // Bullet's error correction: 0.2 of 1 cm a step at 60 Hz is 0.12 m/s
    EXPECT_NEAR(force, LoadedRigidScene::kWeight, 0.05 * LoadedRigidScene::kWeight);
}

}  // namespace
}  // namespace bullet_fem
