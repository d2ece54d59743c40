// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kSoftFriction = 0.5, kPadFriction = 1;
constexpr double kPadOnCube = kSoftFriction * kPadFriction;  // Coulomb's mu [-]
constexpr double kLiftSpeed = 0.2;                           // [m/s]
constexpr double kPedestal = 0.3;                            // [m]

/// A kinematic carriage with two dynamic pads on sliders along x, and a soft cube of 1 kg between them on a pedestal.
/// The pads reach far below the cube, so that a sliding cube stays between them for a while.
class Gripper
{
public:
    Gripper() : m_world(m_fem, Coupling::coupled)
    {
        RigidSettings settings;
        settings.m_transform = at(0, 0, btScalar(0.15));
        addRigidBox(m_world, {0.08, 0.08, 0.3}, settings);
        SoftBox cube;
        cube.m_size = {0.1, 0.1, 0.1};
        cube.m_center = {0, 0, kPedestal + 0.05};
        cube.m_youngModulus = btScalar(1e5);
        cube.m_friction = btScalar(kSoftFriction);
        m_cube = &addSoftBox(m_world, m_fem, cube);

        settings.m_transform = at(0, 0, 1);
        m_carriage = &addRigidBox(m_world, {0.1, 0.1, 0.1}, settings);
        m_carriage->setCollisionFlags(m_carriage->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        for (const int side : {0, 1})
        {
            settings.m_mass = 1;
            settings.m_friction = btScalar(kPadFriction);
            settings.m_transform = at(btScalar(side == 0 ? -0.071 : 0.071), 0, btScalar(kPedestal));
            m_pads[side] = &addRigidBox(m_world, {0.04, 0.14, 0.26}, settings);
            const btTransform inCarriage = m_carriage->getWorldTransform().inverse() * settings.m_transform;
            m_sliders[side] = std::make_unique<btSliderConstraint>(*m_carriage, *m_pads[side], inCarriage,
                                                                   btTransform::getIdentity(), true);
            m_sliders[side]->setLowerLinLimit(1);  // free
            m_sliders[side]->setUpperLinLimit(-1);
            m_sliders[side]->setLowerAngLimit(0);  // held
            m_sliders[side]->setUpperAngLimit(0);
            m_world.world().addConstraint(m_sliders[side].get());
        }
    }
    ~Gripper()
    {
        for (auto& slider : m_sliders) m_world.world().removeConstraint(slider.get());
    }

    double weight() const { return massOf(*m_cube) * kGravity; }
    double height() const { return centerOf(*m_cube).z; }
    // Position of the cube's centre in the gripper's frame [m].
    Vec3 hold() const { return centerOf(*m_cube) - vec3(m_carriage->getWorldTransform().getOrigin()); }
    Vec3 forceOf(int side) const { return vec3(m_fem.contactForce(m_cube, m_pads[side])); }
    double speed() const { return velocityOf(*m_cube).z; }

    // Steps with the pads pushed together by `push` [N], and the carriage moving upwards at `speed` [m/s].
    void step(double push, double speed, int count = 1)
    {
        for (int k = 0; k < count; ++k)
        {
            for (const int side : {0, 1})
                m_pads[side]->applyCentralForce(btVector3(static_cast<btScalar>(side == 0 ? push : -push), 0, 0));
            m_height += speed * kStep;
            m_carriage->getMotionState()->setWorldTransform(at(0, 0, static_cast<btScalar>(m_height)));
            m_world.step();
        }
    }

    // Closes within half a second, and lifts smoothly by 0.1 m.
    void lift(double push)
    {
        step(push, 0, 30);
        for (int k = 1; k <= 30; ++k) step(push, kLiftSpeed * k / 30);
        step(push, kLiftSpeed, 15);
        for (int k = 29; k >= 0; --k) step(push, kLiftSpeed * k / 30);
        step(push, 0, 30);
    }

private:
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody* m_cube;
    btRigidBody* m_carriage;
    btRigidBody* m_pads[2];
    std::unique_ptr<btSliderConstraint> m_sliders[2];
    double m_height = 1;  // of the carriage [m]
};

// Monolithic coupling: pads held by joints and pushed by forces are in contact with the cube.
TEST(CoupledGripper, HoldsTheLoadThatFrictionCarries)
{
    Gripper gripper;
    const double push = 1.25 * gripper.weight() / (2 * kPadOnCube);
    gripper.lift(push);
    EXPECT_NEAR(gripper.height(), kPedestal + 0.05 + 0.15, 0.01);
    const Vec3 held = gripper.hold();
    for (int frame = 0; frame < 180; ++frame)
    {
        gripper.step(push, 0);
        EXPECT_NEAR(gripper.forceOf(0).x, push, 0.01 * push) << "frame " << frame;
        EXPECT_NEAR(gripper.forceOf(1).x, -push, 0.01 * push) << "frame " << frame;
        EXPECT_NEAR(gripper.forceOf(0).z + gripper.forceOf(1).z, gripper.weight(), 0.01 * gripper.weight());
        EXPECT_LT(norm(gripper.hold() - held), 1.5e-3) << "frame " << frame;  // creep of a third of a mm a second
    }
}

TEST(CoupledGripper, DropsHeavyLoadsWithTheNetAcceleration)
{
    Gripper gripper;
    gripper.lift(1.25 * gripper.weight() / (2 * kPadOnCube));
    const double push = 0.75 * gripper.weight() / (2 * kPadOnCube), start = gripper.height();
    gripper.step(push, 0, 6);  // the cube widens
    const double before = gripper.speed();
    const int frames = 8;
    for (int frame = 0; frame < frames; ++frame)
    {
        gripper.step(push, 0);
        for (const int side : {0, 1})
        {
            EXPECT_NEAR(std::fabs(gripper.forceOf(side).x), push, 0.01 * push) << "frame " << frame;
            EXPECT_NEAR(gripper.forceOf(side).z, kPadOnCube * push, 0.01 * push) << "frame " << frame;
        }
    }
    EXPECT_NEAR(gripper.speed() - before, -0.25 * kGravity * frames * kStep, 0.05 * 0.25 * kGravity * frames * kStep);
    gripper.step(push, 0, 60);
    EXPECT_LT(gripper.height(), start - 0.1);
}

}  // namespace
}  // namespace bullet_fem
