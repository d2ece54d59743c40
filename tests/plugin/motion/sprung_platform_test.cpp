// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Soft bodies on light rigid bodies with Bullet's joints: in staggered coupling, too, the joints carry the load.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h"
#include "bullet_fem/btFemHelpers.h"
#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kSpring = 1000, kDamper = 100;  // of the joint [N/m], [N s/m]
constexpr double kCubeMass = 32;                 // [kg]
constexpr double kCubeSide = 0.32;               // [m]

btFemSolverInfo withDamping(double numericalDamping)
{
    btFemSolverInfo info;
    info.m_numericalDamping = info.m_contactDamping = btScalar(numericalDamping);
    return info;
}

/// A plate on a spring, with a cube on it.
class SprungPlatform
{
public:
    SprungPlatform(Coupling coupling, double mass, double numericalDamping)
        : m_world(WorldClass::softRigid, coupling, {0, 0, btScalar(-kGravity)}, withDamping(numericalDamping)),
          m_plate(m_world.addRigid(new btBoxShape({.5f, .5f, .05f}), {btScalar(mass), at(0, 0, btScalar(-0.05))}))
    {
        m_plate.setActivationState(DISABLE_DEACTIVATION);
        btRigidBody& ground = m_world.addFloorBox(-3);
        m_joint = std::make_unique<btGeneric6DofSpring2Constraint>(
            ground, m_plate, ground.getWorldTransform().inverse() * m_plate.getWorldTransform(),
            btTransform::getIdentity());
        m_joint->setLinearLowerLimit({0, 0, 1});  // free along z
        m_joint->setLinearUpperLimit({0, 0, -1});
        m_joint->setAngularLowerLimit({0, 0, 0});
        m_joint->setAngularUpperLimit({0, 0, 0});
        m_joint->enableSpring(2, true);
        m_joint->setStiffness(2, btScalar(kSpring));
        m_joint->setDamping(2, btScalar(kDamper));
        m_joint->setEquilibriumPoint(2, 0);
        m_world.bullet().addConstraint(m_joint.get(), true);

        const btScalar half(kCubeSide / 2);
        m_cube = &m_world.addSoft(btFemHelpers::createBox(m_world.info(), {0, 0, half}, {half, half, half}, half / 2));
        btFemMaterial material;
        material.m_youngModulus = btScalar(1e5);
        material.m_density = btScalar(kCubeMass / (kCubeSide * kCubeSide * kCubeSide));
        material.m_stiffnessDamping = btScalar(0.01);
        m_world.fem().setMaterial(m_cube, material);
        m_cube->setActivationState(DISABLE_DEACTIVATION);
    }

    ~SprungPlatform() { m_world.bullet().removeConstraint(m_joint.get()); }
    SprungPlatform(const SprungPlatform&) = delete;
    SprungPlatform& operator=(const SprungPlatform&) = delete;

    double sink() const { return -0.05 - double(m_plate.getCenterOfMassPosition().z()); }
    double speed() const { return m_plate.getLinearVelocity().length(); }

    std::vector<btScalar> run(int steps)
    {
        std::vector<btScalar> bits;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (const auto& part : {bitsOf(*m_cube), bitsOf(m_plate)})
                bits.insert(bits.end(), part.begin(), part.end());
        }
        return bits;
    }

    FemWorld m_world;
    btRigidBody& m_plate;
    std::unique_ptr<btGeneric6DofSpring2Constraint> m_joint;
    btSoftBody* m_cube = nullptr;
};

class LoadedPlatform : public testing::TestWithParam<std::tuple<Coupling, double, double>>
{
};

// Reactions applied after Bullet has moved the plate act on the joint's damper as motion: in staggered coupling a plate
// of 5 kg had 1 m/s at rest and sank by .258 m instead of .363 m, one of 10 kg .5 m/s and .359 m instead of .412 m.
TEST_P(LoadedPlatform, SinksByItsLoadAndStandsStill)
{
    const auto& [coupling, mass, damping] = GetParam();
    SprungPlatform scene(coupling, mass, damping);
    scene.m_world.step(900);
    // Bullet limits a spring's stiffness to mass / (16 h^2).
    const double softest = mass / 16 / (double(kStep) * double(kStep));
    const double load = (mass + massOf(*scene.m_cube)) * kGravity;
    const double expected = load / std::min(kSpring, softest);
    EXPECT_NEAR(scene.sink(), expected, 0.02 * expected);
    EXPECT_LT(scene.speed(), 0.01);
    const double weight = massOf(*scene.m_cube) * kGravity;
    EXPECT_NEAR(scene.m_world.fem().contactForce(scene.m_cube, &scene.m_plate).z(), weight, 0.01 * weight);

    for (int k = 0; k < 30; ++k) scene.m_world.bullet().stepSimulation(3 * kStep, 3, kStep);  // sub-steps share forces
    EXPECT_NEAR(scene.sink(), expected, 0.02 * expected);
    EXPECT_EQ(scene.m_plate.getTotalForce().length(), 0);
}

INSTANTIATE_TEST_SUITE_P(Masses, LoadedPlatform,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(5.0, 10.0, 50.0), testing::Values(0.0, 1.0)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) + "_" +
                                    std::to_string(int(std::get<1>(suite.param))) + "kg_" +
                                    (std::get<2>(suite.param) > 0 ? "euler" : "secondOrder");
                         });

// The reaction predicted for the next step is part of the state.
TEST(SprungPlatform, ContinuesFromASavedStateToTheBit)
{
    SprungPlatform scene(Coupling::swap, 5, 1);
    scene.m_world.step(45);
    std::vector<unsigned char> state;
    scene.m_world.fem().saveState(state);
    const BulletState bullet(scene.m_world);
    const std::vector<btScalar> bits = scene.run(60);
    scene.m_world.fem().restoreState(state.data(), state.size());
    bullet.restore(scene.m_world);
    EXPECT_TRUE(scene.run(60) == bits);
}

// A cube hits a plate on a spring to another body; no external force acts on the three.
TEST(SprungPlatform, KeepsTheMomentum)
{
    FemWorld world(WorldClass::softRigid, Coupling::swap, {0, 0, 0}, withDamping(1));
    btRigidBody& plate = world.addRigid(new btBoxShape({.5f, .5f, .05f}), {5, at(0, 0, btScalar(-0.05))});
    btRigidBody& other = world.addRigid(new btBoxShape({.5f, .5f, .5f}), {50, at(0, 0, -2)});
    for (btRigidBody* body : {&plate, &other}) body->setActivationState(DISABLE_DEACTIVATION);
    btGeneric6DofSpring2Constraint joint(other, plate, at(0, 0, btScalar(1.95)), btTransform::getIdentity());
    joint.setLinearLowerLimit({0, 0, 1});
    joint.setLinearUpperLimit({0, 0, -1});
    joint.enableSpring(2, true);
    joint.setStiffness(2, btScalar(kSpring));
    joint.setDamping(2, btScalar(kDamper));
    joint.setEquilibriumPoint(2, 0);
    world.bullet().addConstraint(&joint, true);
    const btScalar half(kCubeSide / 2);
    btSoftBody& cube =
        world.addSoft(btFemHelpers::createBox(world.info(), {0, 0, 2 * half}, {half, half, half}, half / 2));
    cube.setActivationState(DISABLE_DEACTIVATION);
    cube.setVelocity({0, 0, -2});
    const double momentum = motionOf(cube).m_linear.z;
    double pushed = 0, worst = 0;
    for (int k = 0; k < 120; ++k)
    {
        world.step();
        pushed += world.fem().contactForce(&cube, &plate).z() > 0;
        const double sum = motionOf(cube).m_linear.z + motionOf(plate).m_linear.z + motionOf(other).m_linear.z;
        worst = std::max(worst, std::fabs(sum / momentum - 1));
    }
    world.bullet().removeConstraint(&joint);
    EXPECT_GT(pushed, 20);  // steps, so that some reactions were predicted
    EXPECT_LT(worst, 1e-5);
}

// Removing the load removes its reaction.
TEST(SprungPlatform, ComesBackWhenTheLoadIsGone)
{
    SprungPlatform scene(Coupling::swap, 5, 1);
    scene.m_world.step(600);
    scene.m_cube->translate({5, 0, 0});
    scene.m_world.step();
    EXPECT_LT(scene.speed(), 2 * kSpring * scene.sink() / 5 * double(kStep));  // the spring's velocity change in a step
    scene.m_world.step(600);
    EXPECT_NEAR(scene.sink(), 5 * kGravity / kSpring, 1e-3);
}

}  // namespace
}  // namespace bullet_fem
