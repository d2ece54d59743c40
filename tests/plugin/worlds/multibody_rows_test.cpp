// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rows of Bullet's multibodies in islands with FEM bodies, where they are solved in the contact problem: motors,
// limits, gears, joints to rigid bodies and contacts of links.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "BulletDynamics/Featherstone/btMultiBodyGearConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "BulletDynamics/Featherstone/btMultiBodyPoint2Point.h"
#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/multibody_scene.h"

namespace bullet_fem
{
namespace
{

const btVector3 kUp(0, 0, 1), kNone(0, 0, 0);
const btVector3 kPlate(btScalar(0.3), btScalar(0.3), btScalar(0.05));  // half edges [m]
constexpr double kPlateMass = 10, kCubeEdge = 0.2;

/// Plates on vertical sliders of one fixed multibody, with soft cubes on them.
class PlateScene
{
public:
    explicit PlateScene(const btFemSolverInfo& info = btFemSolverInfo()) : m_fem(info), m_world(m_fem) {}

    /// Plates at heights [m] side by side along x.
    void addPlates(const std::vector<double>& heights)
    {
        m_plates = new btMultiBody(int(heights.size()), 0, kNone, true, false);
        for (int k = 0; k < int(heights.size()); ++k)
            m_plates->setupPrismatic(k, btScalar(kPlateMass), boxInertia(btScalar(kPlateMass), kPlate), -1, kNoTurn,
                                     kUp, btVector3(btScalar(k), 0, btScalar(heights[k])), kNone, false);
        m_world.addMultiBody(m_plates);
        for (int k = 0; k < int(heights.size()); ++k)
            m_colliders.push_back(&m_world.addCollider(*m_plates, k, new btBoxShape(kPlate)));
    }

    /// Its lower face is at a height [m].
    btSoftBody& addCube(double x, double lowest, double density = 1000)
    {
        SoftBox box;
        box.m_size = {kCubeEdge, kCubeEdge, kCubeEdge};
        box.m_cells = {3, 3, 3};
        box.m_center = {x, 0, lowest + kCubeEdge / 2};
        box.m_density = btScalar(density);
        m_cubes.push_back(&m_world.addSoft(makeSoftBox(m_world.info(), m_fem, box)));
        return *m_cubes.back();
    }

    btRigidBody& addBox(double mass, const Vec3& center, double half = 0.1)
    {
        RigidSettings settings;
        settings.m_mass = btScalar(mass);
        settings.m_transform = at(btScalar(center.x), btScalar(center.y), btScalar(center.z));
        return m_world.addRigid(new btBoxShape(btVector3(btScalar(half), btScalar(half), btScalar(half))), settings);
    }

    btMultiBodyJointMotor& addMotor(int plate, double force = 1e5)
    {
        return m_world.addConstraint<btMultiBodyJointMotor>(m_plates, plate, btScalar(0), btScalar(force) * kStep);
    }

    double plateSpeed(int k) const { return m_plates->getJointVel(k); }

    btFemSoftBodySolver m_fem;
    CoupledLinkWorld m_world;
    btMultiBody* m_plates = nullptr;
    std::vector<btMultiBodyLinkCollider*> m_colliders;
    std::vector<btSoftBody*> m_cubes;
};

// 200 kg on a cube of 8 kg on the plate.
TEST(MultiBodyRows, AMotorHoldsAWeightThroughASoftBody)
{
    PlateScene scene;
    scene.addPlates({0});
    btMultiBodyJointMotor& motor = scene.addMotor(0);
    btSoftBody& cube = scene.addCube(0, 0.0501);
    btRigidBody& load = scene.addBox(200, {0, 0, 0.3503});
    scene.m_world.step(180);
    const double weight = (200 + massOf(cube)) * kGravity;
    for (int frame = 0; frame < 30; ++frame)
    {
        scene.m_world.step();
        EXPECT_NEAR(scene.m_fem.contactForce(&cube, scene.m_colliders[0]).z(), weight, 2e-3 * weight);
        EXPECT_NEAR(motor.getAppliedImpulse(0) / kStep, weight + kPlateMass * kGravity, 2e-3 * weight);
        EXPECT_LT(std::fabs(scene.plateSpeed(0)), 5e-4);  // the contact tolerance, 3e-3 g h
        EXPECT_LT(load.getLinearVelocity().length(), 1e-3);
    }
}

TEST(MultiBodyRows, AMotorBeyondItsForceGivesWay)
{
    PlateScene scene;
    scene.addPlates({0});
    btSoftBody& cube = scene.addCube(0, 0.0501);
    const double mass = kPlateMass + massOf(cube), force = 0.8 * mass * kGravity;
    btMultiBodyJointMotor& motor = scene.addMotor(0, force);
    scene.m_world.step(60);
    const double before = scene.plateSpeed(0);
    scene.m_world.step(30);
    EXPECT_NEAR(scene.plateSpeed(0) - before, -0.2 * kGravity * 30 * double(kStep), 0.02);
    EXPECT_NEAR(motor.getAppliedImpulse(0) / kStep, force, 1e-4 * force);
}

// The plate and its cube fall to the lower limit.
TEST(MultiBodyRows, ALimitStopsAndHoldsALoad)
{
    PlateScene scene;
    scene.addPlates({0});
    auto& limit =
        scene.m_world.addConstraint<btMultiBodyJointLimitConstraint>(scene.m_plates, 0, btScalar(-0.1), btScalar(0.2));
    limit.setMaxAppliedImpulse(btScalar(1e4));
    btSoftBody& cube = scene.addCube(0, 0.0501);
    double lowest = 0;
    for (int frame = 0; frame < 180; ++frame)
    {
        scene.m_world.step();
        lowest = std::min(lowest, double(scene.m_plates->getJointPos(0)));
    }
    const double weight = massOf(cube) * kGravity;
    double force = 0;
    for (int frame = 0; frame < 60; ++frame, scene.m_world.step())
        force += scene.m_fem.contactForce(&cube, scene.m_colliders[0]).z() / 60;
    EXPECT_NEAR(force, weight, 0.02 * weight);
    EXPECT_GT(lowest, -0.1 - 0.03);  // at most one step of its fall beyond the limit
    EXPECT_NEAR(scene.m_plates->getJointPos(0), -0.1, 2e-3);
}

// One plate rises as the other sinks; the heavier cube pulls both: a = (M - m) g / (M + m + 2 plates).
TEST(MultiBodyRows, AGearPassesOnTheWeightOfASoftBody)
{
    PlateScene scene;
    scene.addPlates({0, 0});
    auto& gear = scene.m_world.addConstraint<btMultiBodyGearConstraint>(
        scene.m_plates, 0, scene.m_plates, 1, kNone, kNone, btMatrix3x3::getIdentity(), btMatrix3x3::getIdentity());
    gear.setGearRatio(1);
    gear.setMaxAppliedImpulse(btScalar(1e4));
    btMultiBodyJointMotor& motor = scene.addMotor(0);
    const double heavy = massOf(scene.addCube(0, 0.0501, 2000)), light = massOf(scene.addCube(1, 0.0501));
    scene.m_world.step(120);
    EXPECT_NEAR(motor.getAppliedImpulse(0) / kStep, (heavy - light) * kGravity, 0.01 * heavy * kGravity);
    EXPECT_LT(std::fabs(scene.plateSpeed(1)), 1e-4);
    motor.setMaxAppliedImpulse(0);
    scene.m_world.step(30);
    const double acceleration = (heavy - light) * kGravity / (heavy + light + 2 * kPlateMass);
    EXPECT_NEAR(scene.plateSpeed(0), -acceleration * 30 * double(kStep), 0.03 * acceleration);
    EXPECT_NEAR(scene.plateSpeed(1), -scene.plateSpeed(0), 1e-4);
}

// A box on the plate, which rests on a soft cube.
TEST(MultiBodyRows, ALinkBetweenASoftBodyAndARigidOneCarriesIt)
{
    PlateScene scene;
    scene.m_world.addFloorBox(btScalar(-0.2501));
    btSoftBody& cube = scene.addCube(0, -0.2501);
    scene.addPlates({0});
    btRigidBody& load = scene.addBox(40, {0.02, 0, 0.1501});
    scene.m_world.step(180);
    const double weight = (40 + kPlateMass) * kGravity;
    for (int frame = 0; frame < 30; ++frame)
    {
        scene.m_world.step();
        EXPECT_NEAR(scene.m_fem.contactForce(&cube, scene.m_colliders[0]).z(), -weight, 3e-3 * weight);
        EXPECT_LT(load.getLinearVelocity().length(), 1e-3);
        EXPECT_LT(std::fabs(scene.plateSpeed(0)), 1e-3);
    }
}

// The box slides on the plate with the deceleration mu g.
TEST(MultiBodyRows, LinksRubOnRigidBodies)
{
    PlateScene scene;
    scene.addPlates({0});
    scene.addMotor(0);
    scene.m_colliders[0]->setFriction(btScalar(0.5));
    scene.addCube(0.2, 0.0501);
    btRigidBody& box = scene.addBox(5, {-0.2, 0, 0.101}, 0.05);
    box.setFriction(btScalar(0.4));
    scene.m_world.step(30);
    box.setLinearVelocity({0, btScalar(0.5), 0});
    scene.m_world.step(2);  // before it tilts, and Bullet removes contact points behind it
    EXPECT_NEAR(box.getLinearVelocity().y(), 0.5 - 0.2 * kGravity * 2 * double(kStep), 1e-3);
    scene.m_world.step(30);
    EXPECT_LT(box.getLinearVelocity().length(), 1e-3);
}

// A ball with a soft cube on it spins on the floor, and stops.
TEST(MultiBodyRows, SpinningFrictionOfALinkStopsIt)
{
    PlateScene scene;
    scene.m_world.addFloorBox(0);
    const btVector3 inertia(btScalar(0.1), btScalar(0.1), btScalar(0.1));
    auto* ball = new btMultiBody(0, 10, inertia, false, false);
    ball->setBasePos(btVector3(0, 0, btScalar(0.2)));
    scene.m_world.addMultiBody(ball);
    btMultiBodyLinkCollider& collider = scene.m_world.addCollider(*ball, -1, new btSphereShape(btScalar(0.2)));
    collider.setSpinningFriction(btScalar(0.02));
    scene.m_world.rigid(0).setSpinningFriction(btScalar(1));
    btSoftBody& cube = scene.addCube(0, 0.39);
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() < 0.4) cube.appendDeformableAnchor(i, &collider);
    scene.m_world.step(30);
    ASSERT_GT(scene.m_fem.anchors(&cube).size(), 0);
    ball->setBaseOmega(btVector3(0, 0, 2));
    scene.m_world.step(120);
    EXPECT_LT(std::fabs(ball->getBaseOmega().z()), 0.05);
}

// A rigid box hangs on a link by a point-to-point joint, with a soft cube on the plate.
TEST(MultiBodyRows, AJointBetweenALinkAndARigidBodyHolds)
{
    PlateScene scene;
    scene.addPlates({0});
    btMultiBodyJointMotor& motor = scene.addMotor(0);
    btSoftBody& cube = scene.addCube(0, 0.0501);
    btRigidBody& load = scene.addBox(30, {0, 0, -0.4});
    auto& joint = scene.m_world.addConstraint<btMultiBodyPoint2Point>(
        scene.m_plates, 0, &load, btVector3(0, 0, btScalar(-0.1)), btVector3(0, 0, btScalar(0.3)));
    joint.setMaxAppliedImpulse(btScalar(1e4));
    scene.m_world.step(120);
    const double weight = (30 + massOf(cube) + kPlateMass) * kGravity;
    for (int frame = 0; frame < 30; ++frame)
    {
        scene.m_world.step();
        EXPECT_NEAR(motor.getAppliedImpulse(0) / kStep, weight, 1e-3 * weight);
        const btVector3 pivot = load.getWorldTransform() * btVector3(0, 0, btScalar(0.3));
        EXPECT_LT((pivot - btVector3(0, 0, scene.m_plates->getJointPos(0) - btScalar(0.1))).length(), 1e-4);
    }
}

TEST(MultiBodyRows, HaveEqualBitsForAnyNumberOfThreads)
{
    std::vector<std::vector<btScalar>> results;
    for (const int threads : {1, 2, 3})
    {
        btFemSolverInfo info;
        info.m_threads = threads;
        PlateScene scene(info);
        scene.addPlates({0, 0});
        scene.addMotor(0);
        scene.addMotor(1);
        for (const int x : {0, 1}) scene.addCube(x, 0.06);
        scene.addBox(5, {0.02, 0.01, 0.37});
        btRigidBody& box = scene.addBox(5, {0.78, 0.01, 0.11}, 0.05);
        scene.m_world.step(60);
        std::vector<btScalar> bits;
        for (const btSoftBody* cube : scene.m_cubes)
            for (int i = 0; i < cube->m_nodes.size(); ++i)
                for (int c = 0; c < 3; ++c) bits.push_back(cube->m_nodes[i].m_x[c]);
        for (int c = 0; c < 3; ++c) bits.push_back(box.getLinearVelocity()[c]);
        for (int k = 0; k < 2; ++k) bits.push_back(scene.m_plates->getJointVel(k));
        results.push_back(bits);
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

/// A motor that a program set badly.
struct BadMotorCase
{
    const char* m_name;
    btScalar m_velocity, m_maxImpulse;
};

class BadMotors : public testing::TestWithParam<BadMotorCase>
{
};

// The bad motor belongs to a plate of its own multibody; the other one is held as usual.
TEST_P(BadMotors, LeaveTheRestSolved)
{
    PlateScene scene;
    scene.addPlates({0, 0});
    scene.addMotor(0);
    btMultiBodyJointMotor& bad = scene.addMotor(1);
    bad.setVelocityTarget(GetParam().m_velocity);
    bad.setMaxAppliedImpulse(GetParam().m_maxImpulse);
    btSoftBody& cube = scene.addCube(0, 0.0501);
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        ASSERT_TRUE(allFinite(cube)) << k;
        ASSERT_TRUE(std::isfinite(scene.plateSpeed(0)) && std::isfinite(scene.plateSpeed(1))) << k;
    }
    EXPECT_LT(std::fabs(scene.plateSpeed(0)), 1e-4);
    EXPECT_NEAR(scene.m_fem.contactForce(&cube, scene.m_colliders[0]).z(), massOf(cube) * kGravity,
                0.01 * massOf(cube) * kGravity);
}

const btScalar kNoNumber = std::numeric_limits<btScalar>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(Cases, BadMotors,
                         testing::Values(BadMotorCase{"nanSpeed", kNoNumber, 100},
                                         BadMotorCase{"nanForce", 0, kNoNumber},
                                         BadMotorCase{"contradictoryLimits", 0, -100},
                                         BadMotorCase{"infiniteSpeed", std::numeric_limits<btScalar>::infinity(), 100}),
                         [](const auto& suite) { return suite.param.m_name; });

}  // namespace
}  // namespace bullet_fem
