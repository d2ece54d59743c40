// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Contact scenes with the low-memory factor fulfil the bounds of the full factor: several scenes of other tests with
// both.
#include <gtest/gtest.h>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

btFemSolverInfo withChoice(btFemFactorChoice choice)
{
    btFemSolverInfo info;
    info.m_factorChoice = choice;
    return info;
}

class ContactWithEitherFactor : public testing::TestWithParam<btFemFactorChoice>
{
protected:
    // Expects that the path was taken, and no fault flags.
    void expectHealthy(const btSoftBody& body) const
    {
        const btFemStepReport& report = m_fem.stepReport(&body);
        EXPECT_EQ(report.m_lowMemory, GetParam() == btFemFactorChoice::lowMemory);
        EXPECT_EQ(report.m_flags, 0);
    }

    btFemSoftBodySolver m_fem{withChoice(GetParam())};
};

// Two rows of nodes are compressed: the surface's compliance is much larger in contact than beside it.
TEST_P(ContactWithEitherFactor, ACylinderCarriesACubeToItsWeight)
{
    SoftWorld world(m_fem);
    RigidSettings settings;
    settings.m_transform = at(0, 0, -3);
    btRigidBody& cylinder = world.addRigid(new btCylinderShape(btVector3(3, 3, 3)), settings);
    SoftBox box;
    box.m_center = {0, 0, 0.51};
    btSoftBody& cube = addSoftBox(world, m_fem, box);
    const double weight = massOf(cube) * kGravity;
    world.step(240);
    for (int frame = 0; frame < 60; ++frame)
    {
        world.step();
        EXPECT_LT(norm(vec3(m_fem.contactForce(&cube, &cylinder)) - Vec3{0, 0, weight}), 1e-3 * weight) << frame;
        EXPECT_LT(m_fem.stepReport(&cube).m_deepestPenetration, 1e-4);
    }
    expectHealthy(cube);
}

// Coulomb's law on both sides of the friction angle, mu = .4.
TEST_P(ContactWithEitherFactor, FrictionHoldsAndBrakesByCoulombsLaw)
{
    constexpr double kRampFriction = 0.4;
    for (const double steepness : {0.95, 1.3})
    {
        SCOPED_TRACE(steepness);
        const double slope = std::atan(steepness * kRampFriction), sine = std::sin(slope), cosine = std::cos(slope);
        const Vec3 downhill = {cosine, 0, -sine};
        const btQuaternion tilt(btVector3(0, 1, 0), btScalar(slope));
        SoftWorld world(m_fem);
        world.addRigid(new btStaticPlaneShape(quatRotate(tilt, btVector3(0, 0, 1)), 0));
        btSoftBody* cube = btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.5)),
                                                   btVector3(0.5, 0.5, 0.5), btScalar(0.25));
        cube->rotate(tilt);
        cube->m_cfg.kDF = btScalar(kRampFriction);
        m_fem.setMaterial(cube, btFemMaterial());
        world.addSoft(cube);
        world.step(180);
        const double before = dot(velocityOf(*cube), downhill);
        world.step(60);
        const double excess = std::max(0.0, sine - kRampFriction * cosine);
        EXPECT_NEAR((dot(velocityOf(*cube), downhill) - before) / (60 * kStep), kGravity * excess,
                    0.01 * kGravity * sine);
        expectHealthy(*cube);
    }
}

// 1 GPa: the factor's error is mostly in the rigid rotation.
TEST_P(ContactWithEitherFactor, AStiffBallLeavesAtItsShareOfTheSpeed)
{
    SoftWorld world(m_fem, btVector3(0, 0, 0));
    btRigidBody& floor = world.addFloorBox();
    floor.setRestitution(btScalar(0.75));
    btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.2, 4));
    ball->translate(btVector3(0, 0, btScalar(0.3)));
    ball->setRestitution(btScalar(0.8));
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e9);
    material.m_stiffnessDamping = btScalar(0.0005);
    m_fem.setMaterial(ball, material);
    world.addSoft(ball);
    ball->setVelocity(btVector3(0, 0, -2));
    world.step(30);
    const double speed = 2 * 0.75 * 0.8;
    EXPECT_NEAR(velocityOf(*ball).z, speed, 0.05 * speed);
    expectHealthy(*ball);
}

// Meshes that do not match, so that contact points lie on faces.
TEST_P(ContactWithEitherFactor, ASoftBodyCarriesAnotherToItsWeight)
{
    SoftWorld world(m_fem);
    SoftBox below, above;
    below.m_center = {0, 0, 0.5};
    above.m_center = {0.02, -0.03, 1.351};
    below.m_friction = above.m_friction = btScalar(0.2);
    above.m_size = {0.7, 0.7, 0.7};
    above.m_cells = {3, 3, 3};
    btSoftBody &lower = addSoftBox(world, m_fem, below), &upper = addSoftBox(world, m_fem, above);
    clampBelow(lower, 0.01);
    const double weight = massOf(upper) * kGravity;
    world.step(360);
    for (int frame = 0; frame < 60; ++frame)
    {
        world.step();
        const Vec3 force = vec3(m_fem.contactForce(&upper, &lower)),
                   reaction = vec3(m_fem.contactForce(&lower, &upper));
        EXPECT_LT(norm(force - Vec3{0, 0, weight}), 1e-3 * weight) << frame;
        EXPECT_LT(norm(force + reaction), 1e-6 * weight);
        EXPECT_LT(m_fem.stepReport(&upper).m_deepestPenetration, 1e-3);
        EXPECT_LT(norm(velocityOf(upper)), 1e-4);
    }
    expectHealthy(lower);
    expectHealthy(upper);
}

// Rigid, soft, rigid, with a mass ratio of ten, in monolithic coupling.
TEST_P(ContactWithEitherFactor, AStackOfRigidAndSoftStands)
{
    constexpr double kEdge = 0.2;
    SoftWorld world(m_fem, Coupling::coupled);
    world.addFloorBox();
    SoftBox box;
    box.m_size = {kEdge, kEdge, kEdge};
    box.m_cells = {3, 3, 3};
    box.m_center = {0, 0, 1.5 * kEdge};
    RigidSettings settings;
    settings.m_mass = btScalar(80);
    settings.m_transform = at(0, 0, btScalar(0.5 * kEdge));
    addRigidBox(world, {kEdge, kEdge, kEdge}, settings);
    settings.m_transform = at(0, 0, btScalar(2.5 * kEdge));
    btRigidBody& upper = addRigidBox(world, {kEdge, kEdge, kEdge}, settings);
    btSoftBody& soft = addSoftBox(world, m_fem, box);
    world.step(240);
    const Vec3 place = vec3(upper.getCenterOfMassPosition());
    double mean = 0;
    for (int frame = 0; frame < 120; ++frame)
    {
        world.step();
        mean -= m_fem.contactForce(&soft, &upper).z() / 120;
        EXPECT_LT(norm(vec3(upper.getLinearVelocity())), 1e-3) << frame;
    }
    EXPECT_NEAR(mean, 80 * kGravity, 1e-3 * 80 * kGravity);
    EXPECT_LT(norm(vec3(upper.getCenterOfMassPosition()) - place), 1e-3 * kEdge);
    expectHealthy(soft);
}

INSTANTIATE_TEST_SUITE_P(Factors, ContactWithEitherFactor,
                         testing::Values(btFemFactorChoice::full, btFemFactorChoice::lowMemory),
                         [](const auto& scene)
                         { return scene.param == btFemFactorChoice::full ? "full" : "lowMemory"; });

}  // namespace
}  // namespace bullet_fem
