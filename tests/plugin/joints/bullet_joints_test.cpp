// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bullet's joints in islands with FEM bodies in contact, where they are solved as rows of the contact problem.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h"
#include "plugin/scenes/loaded_rigid_scene.h"

namespace bullet_fem
{
namespace
{

using Loaded = LoadedRigidScene;

constexpr Vec3 kTray = Loaded::kTray;
constexpr double kTrayMass = Loaded::kTrayMass, kWeight = Loaded::kWeight;
constexpr double kTrayInertia = kTrayMass * 0.16 / 6;  // about the vertical [kg m2]
const btVector3 kUp(0, 0, 1), kAlongY(0, 1, 0);

/// A tray at the origin, and a payload on it.
class TrayScene : public Loaded
{
public:
    explicit TrayScene(Coupling coupling = Coupling::coupled, Payload payload = Payload::soft)
        : Loaded(coupling, payload), m_tray(addLoadedTray())
    {
    }

    /// Of the payload about the vertical through the origin [kg m2].
    double payloadInertia() const
    {
        double sum = 0;
        for (int i = 0; i < m_softPayloads[0]->m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = m_softPayloads[0]->m_nodes[i];
            sum += (std::pow(double(node.m_x.x()), 2) + std::pow(double(node.m_x.y()), 2)) / double(node.m_im);
        }
        return sum;
    }

    double height() const { return double(m_tray.getCenterOfMassPosition().z()); }

    btRigidBody& m_tray;
};

/// A frame whose x-axis is vertical.
btTransform upright()
{
    return btTransform(btQuaternion(kAlongY, -SIMD_HALF_PI));
}

class JointsOfBoth : public testing::TestWithParam<Coupling>
{
};

TEST_P(JointsOfBoth, CarryAPayloadFromAPoint)
{
    TrayScene scene(GetParam());
    auto& joint = scene.join<btPoint2PointConstraint>(scene.m_tray, btVector3(0, 0, 1));
    scene.m_world.step(120);
    EXPECT_TRUE(scene.touches());
    EXPECT_LT(norm(Loaded::forceOf(joint) - Vec3{0, 0, kWeight}), 0.01 * kWeight);
    EXPECT_NEAR(scene.height(), 0, 1e-3);
}

TEST_P(JointsOfBoth, CarryAPayloadRigidly)
{
    TrayScene scene(GetParam());
    auto& joint = scene.join<btFixedConstraint>(scene.m_tray, btTypedConstraint::getFixedBody(),
                                                btTransform::getIdentity(), btTransform::getIdentity());
    scene.m_world.step(120);
    EXPECT_TRUE(scene.touches());
    EXPECT_LT(norm(Loaded::forceOf(joint) - Vec3{0, 0, kWeight}), 0.01 * kWeight);
    EXPECT_NEAR(scene.height(), 0, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Couplings, JointsOfBoth, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return couplingName(suite.param); });

// The tray turns about the vertical with the payload on it.
TEST(HingeMotor, AcceleratesByItsTorqueUntilItsSpeed)
{
    constexpr double kTorque = 0.2, kSpeed = 3;  // [N m], [rad/s]
    TrayScene scene;
    auto& hinge = scene.join<btHingeConstraint>(scene.m_tray, btVector3(0, 0, 0), kUp);
    scene.m_world.step(30);
    hinge.enableAngularMotor(true, btScalar(kSpeed), btScalar(kTorque * double(kStep)));
    const double inertia = kTrayInertia + scene.payloadInertia();
    const auto spin = [&] { return std::fabs(double(scene.m_tray.getAngularVelocity().z())); };
    scene.m_world.step(20);
    EXPECT_NEAR(spin(), kTorque / inertia * 20 * double(kStep), 0.03 * kTorque / inertia * 20 * double(kStep));
    scene.m_world.step(60);
    EXPECT_NEAR(spin(), kSpeed, 2e-3 * kSpeed);
    EXPECT_TRUE(scene.touches());
}

/// A tray tilts about y at one of its edges, with the payload anchored to it: the other limit of the hinge.
class HingeLimit : public testing::TestWithParam<int>
{
};

TEST_P(HingeLimit, StopsAndHoldsALoad)
{
    constexpr double kLimit = 0.3;  // [rad]
    const double arm = 0.3 * GetParam();
    Loaded scene(Coupling::coupled);
    btRigidBody& tray = scene.addBox(kTray, kTrayMass, {arm, 0, 0});
    scene.anchorPayload(tray, {arm, 0, kTray.z / 2});
    auto& hinge = scene.join<btHingeConstraint>(tray, btVector3(btScalar(-arm), 0, 0), kAlongY);
    hinge.setLimit(btScalar(-kLimit), btScalar(kLimit));
    double farthest = 0;
    for (int k = 0; k < 120; ++k)
    {
        scene.m_world.step();
        farthest = std::max(farthest, std::fabs(double(hinge.getHingeAngle())));
    }
    EXPECT_LT(farthest, kLimit + 4 * double(kStep));  // at some 4 rad/s Bullet finds the limit a step late
    EXPECT_NEAR(std::fabs(double(hinge.getHingeAngle())), kLimit, 5e-3);
    EXPECT_LT(tray.getAngularVelocity().length(), 5e-3);
    EXPECT_LT(norm(Loaded::forceOf(hinge) - Vec3{0, 0, kWeight}), 0.01 * kWeight);
}

INSTANTIATE_TEST_SUITE_P(Sides, HingeLimit, testing::Values(-1, 1),
                         [](const auto& suite) { return suite.param > 0 ? "upper" : "lower"; });

/// A tray on a vertical slider.
class SliderScene : public TrayScene
{
public:
    SliderScene() : m_slider(join<btSliderConstraint>(m_tray, upright(), true))
    {
        m_slider.setLowerLinLimit(btScalar(-0.1));
        m_slider.setUpperLinLimit(btScalar(0.5));
        m_slider.setLowerAngLimit(0);
        m_slider.setUpperAngLimit(0);
    }

    btSliderConstraint& m_slider;
};

TEST(Slider, StopsAtItsLimitAndHoldsALoad)
{
    SliderScene scene;
    scene.m_world.step(180);
    EXPECT_NEAR(std::fabs(scene.height()), 0.1, 3e-3);
    EXPECT_LT(scene.m_tray.getLinearVelocity().length(), 1e-3);
    EXPECT_NEAR(norm(Loaded::forceOf(scene.m_slider)), kWeight, 0.01 * kWeight);
    EXPECT_TRUE(scene.touches());
}

TEST(Slider, LiftsWithItsMotorIfThatIsStrongEnough)
{
    for (const double share : {0.9, 2.0})
    {
        SliderScene scene;
        scene.m_slider.setPoweredLinMotor(true);
        scene.m_slider.setTargetLinMotorVelocity(btScalar(0.2));
        scene.m_slider.setMaxLinMotorForce(btScalar(share * kWeight));
        scene.m_world.step(60);
        const double speed = double(scene.m_tray.getLinearVelocity().z());
        if (share > 1)
            EXPECT_NEAR(std::fabs(speed), 0.2, 2e-3);
        else
            EXPECT_LT(scene.height(), 0);
    }
}

/// A tray that a btGeneric6DofSpring2Constraint leaves free along z.
class SpringScene : public TrayScene
{
public:
    explicit SpringScene(Payload payload = Payload::soft)
        : TrayScene(payload == Payload::soft ? Coupling::coupled : Coupling::swap, payload),
          m_joint(join<btGeneric6DofSpring2Constraint>(m_tray, btTransform::getIdentity()))
    {
        for (int axis = 0; axis < 6; ++axis) m_joint.setLimit(axis, 0, 0);
        m_joint.setLimit(2, 1, -1);
    }

    btGeneric6DofSpring2Constraint& m_joint;
};

TEST(Spring2, ExtendsByTheLoad)
{
    constexpr double kStiffness = 1000;  // [N/m]
    SpringScene scene;
    scene.m_joint.enableSpring(2, true);
    scene.m_joint.setStiffness(2, btScalar(kStiffness), false);
    scene.m_joint.setDamping(2, 50, false);
    scene.m_joint.setEquilibriumPoint(2, 0);
    scene.m_world.step(240);
    EXPECT_NEAR(scene.height(), -kWeight / kStiffness, 0.01 * kWeight / kStiffness);
    EXPECT_TRUE(scene.touches());
}

TEST(Spring2, DrivesItsServoToTheTarget)
{
    SpringScene scene;
    scene.m_joint.enableMotor(2, true);
    scene.m_joint.setServo(2, true);
    scene.m_joint.setMaxMotorForce(2, btScalar(2 * kWeight));
    scene.m_joint.setTargetVelocity(2, btScalar(0.5));
    scene.m_joint.setServoTarget(2, btScalar(0.2));
    scene.m_world.step(150);
    EXPECT_NEAR(std::fabs(scene.height()), 0.2, 2e-3);
    EXPECT_LT(scene.m_tray.getLinearVelocity().length(), 2e-3);
    EXPECT_NEAR(norm(Loaded::forceOf(scene.m_joint)), kWeight, 0.01 * kWeight);
}

// An arm with a payload falls to the limit of swing.
TEST(ConeTwist, StopsAtItsSwing)
{
    constexpr double kSwing = 0.5, kArm = 0.3;  // [rad], [m]
    Loaded scene(Coupling::coupled);
    btRigidBody& arm = scene.addBox({2 * kArm, 0.1, 0.05}, kTrayMass, {kArm, 0, 0});
    scene.anchorPayload(arm, {2 * kArm - Loaded::kEdge, 0, 0.025});
    auto& joint = scene.join<btConeTwistConstraint>(
        arm, btTransform(btQuaternion::getIdentity(), btVector3(btScalar(-kArm), 0, 0)));
    joint.setLimit(btScalar(kSwing), btScalar(kSwing), btScalar(0.1));
    double steepest = 0;
    for (int k = 0; k < 40; ++k)  // until Bullet lets go of the limit for a step, again and again
    {
        scene.m_world.step();
        const Vec3 along = vec3(arm.getWorldTransform().getBasis().getColumn(0));
        steepest = std::max(steepest, std::acos(std::min(along.x, 1.0)));
    }
    const Vec3 pivot = vec3(arm.getWorldTransform()(btVector3(btScalar(-kArm), 0, 0)));
    EXPECT_LT(norm(pivot), 2e-3);
    EXPECT_GT(steepest, 0.9 * kSwing);
    EXPECT_LT(steepest, 1.15 * kSwing);
    EXPECT_LT(arm.getAngularVelocity().length(), 0.01);
    EXPECT_LT(norm(Loaded::forceOf(joint) - Vec3{0, 0, kWeight}), 0.02 * kWeight);
}

TEST(Gear, KeepsItsRatio)
{
    constexpr double kRatio = 2;
    TrayScene scene;
    btRigidBody& wheel = scene.addBox({0.3, 0.3, 0.05}, 1, {1, 0, 0});
    auto& hinge = scene.join<btHingeConstraint>(scene.m_tray, btVector3(0, 0, 0), kUp);
    scene.join<btHingeConstraint>(wheel, btVector3(0, 0, 0), kUp);
    scene.join<btGearConstraint>(scene.m_tray, wheel, kUp, kUp, btScalar(kRatio));
    hinge.enableAngularMotor(true, 2, btScalar(0.5 * double(kStep)));
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        const double spin = double(scene.m_tray.getAngularVelocity().z());
        ASSERT_NEAR(spin + kRatio * double(wheel.getAngularVelocity().z()), 0, 2e-3) << k;
    }
    EXPECT_NEAR(std::fabs(double(scene.m_tray.getAngularVelocity().z())), 2, 0.02);
    EXPECT_TRUE(scene.touches());
}

// A joint is given a threshold when the payload rests.
TEST(BreakingThreshold, HoldsBelowAndBreaksAboveTheLoad)
{
    for (const double share : {0.97, 1.03})
    {
        TrayScene scene;
        auto& joint = scene.join<btPoint2PointConstraint>(scene.m_tray, btVector3(0, 0, 1));
        scene.m_world.step(120);
        joint.setBreakingImpulseThreshold(btScalar(share * kWeight * double(kStep)));
        scene.m_world.step(60);
        EXPECT_EQ(joint.isEnabled(), share > 1) << share;
        if (share > 1)
            EXPECT_NEAR(scene.height(), 0, 1e-3);
        else
            EXPECT_LT(scene.height(), -1);
    }
}

}  // namespace
}  // namespace bullet_fem
