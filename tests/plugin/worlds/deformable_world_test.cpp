// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "plugin/scenes/deformable_scene.h"

namespace bullet_fem
{
namespace
{

TEST_F(DeformableWorldTest, ClothBesideFemBodiesKeepsItsBits)
{
    const auto run = [this](btDeformableBodySolver& solver, bool withFem, bool implicit)
    {
        DeformableWorld world(solver);
        world.world().setImplicit(implicit);
        world.world().setUseProjection(implicit);
        world.addFloorBox();
        std::vector<btSoftBody*> cubes;
        if (withFem) cubes.push_back(&addCube(world, {5, 0, 0.5}));
        btSoftBody& cloth = addCloth(world);  // its forces first: Bullet sums forces in order
        if (withFem) cubes.push_back(&addCube(world, {-5, 0, 0.5}));
        for (btSoftBody* cube : cubes) addForces(world, *cube);
        std::vector<btScalar> bits;
        for (int k = 0; k < 200; ++k)
        {
            world.step();
            const std::vector<btScalar> now = bitsOf(cloth);
            bits.insert(bits.end(), now.begin(), now.end());
        }
        EXPECT_LT(centerOf(cloth).z, 0.2);
        return bits;
    };
    for (const bool implicit : {false, true})
    {
        btDeformableBodySolver bullet;
        btFemDeformableBodySolver ours;
        EXPECT_EQ(run(bullet, false, implicit), run(ours, true, implicit)) << implicit;
    }
}

// Bullet's world makes all soft bodies with VF_DD collide, for any ignore lists.
TEST_F(DeformableWorldTest, ClothIgnoringFemBodiesFallsThroughThem)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 0.5});
    addForce(m_world, cube, makeForce(Elastic::linear, kMu, kLambda));
    cube.m_cfg.collisions |= btSoftBody::fCollision::VF_DD;
    btSoftBody& cloth = addCloth(m_world);
    cloth.setIgnoreCollisionCheck(&cube, true);
    m_world.step(60);
    EXPECT_LT(centerOf(cloth).z, 0.2);
    EXPECT_LT(fastestNode(cube), 1e-6);
    EXPECT_TRUE(cube.m_cfg.collisions & btSoftBody::fCollision::VF_DD);
}

TEST_F(DeformableWorldTest, RemovedBodiesLoseTheirContacts)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(m_world, {0, 0, 0.2});
    addForces(m_world, cube);
    m_world.step(10);
    ASSERT_GT(cube.m_rcontacts.size(), 0);
    m_world.world().removeSoftBody(&cube);
    EXPECT_EQ(cube.m_rcontacts.size() + cube.m_faceRigidContacts.size(), 0);
}

// Fixed at a strain of 1 % along x: Hooke's law with the force's coefficients.
TEST_F(DeformableWorldTest, StressIsThatOfTheForcesCoefficients)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    addForce(m_world, cube, makeForce(Elastic::corotated, kMu, kLambda));
    for (int i = 0; i < cube.m_nodes.size(); ++i) cube.setMass(i, 0);
    m_world.step();
    for (int i = 0; i < cube.m_nodes.size(); ++i) cube.m_nodes[i].m_x *= btVector3(btScalar(1.01), 1, 1);
    m_world.step();
    btAlignedObjectArray<btFemStress> stress;
    ASSERT_TRUE(m_solver.fem().getStress(&cube, stress));
    ASSERT_EQ(stress.size(), cube.m_tetras.size());
    for (int e = 0; e < stress.size(); ++e)
    {
        EXPECT_NEAR(double(stress[e].m_xx), (2 * kMu + kLambda) * 0.01, 1e-3 * kMu * 0.01);
        EXPECT_NEAR(double(stress[e].vonMises()), 2 * kMu * 0.01, 1e-3 * kMu * 0.01);
    }
}

TEST_F(DeformableWorldTest, BodiesWithoutAnElasticForceStayBullets)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    makeReadyForBullet(cube);
    addForce(m_world, cube, std::make_unique<btDeformableGravityForce>(btVector3(0, 0, -1)));
    m_world.step(2);
    EXPECT_FALSE(m_solver.fem().isFem(&cube));
    addForce(m_world, cube, makeForce(Elastic::linear, kMu, kLambda));
    m_world.step(2);
    EXPECT_TRUE(m_solver.fem().isFem(&cube));
}

TEST_F(DeformableWorldTest, BodiesWithoutForcesAreFemAndStandStill)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    m_world.step(2);
    EXPECT_TRUE(m_solver.fem().isFem(&cube));
    EXPECT_NEAR(velocityOf(cube).z, 0, 1e-6);
}

TEST_F(DeformableWorldTest, ForcesListTheirBodiesBetweenSteps)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    addForces(m_world, cube);
    m_world.step(3);
    for (const auto& force : m_forces) EXPECT_EQ(force->m_softBodies.size(), 1);
    EXPECT_EQ(m_solver.getLagrangianForceArray()->size(), 2);
}

TEST_F(DeformableWorldTest, BodiesCollideWithEachOtherAndKeepTheirMomentum)
{
    btSoftBody &a = addCube(m_world, {0, 0, 0}), &b = addCube(m_world, {0.6, 0.05, 0.1});
    for (btSoftBody* body : {&a, &b})
    {
        addForce(m_world, *body, makeForce(Elastic::linear, kMu, kLambda));
        body->m_cfg.collisions |= btSoftBody::fCollision::VF_DD;
    }
    a.setVelocity(btVector3(2, 0, 0));
    const double start = motionOf(a).m_linear.x;
    m_world.step(60);
    EXPECT_GT(velocityOf(b).x, 0.5);
    EXPECT_NEAR(motionOf(a).m_linear.x + motionOf(b).m_linear.x, start, 1e-5 * start);
}

TEST_F(DeformableWorldTest, ARigidBoxOnASoftBodyIsCarried)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(m_world, {0, 0, 0.2});
    addForces(m_world, cube);
    RigidSettings settings;
    settings.m_mass = 10;
    settings.m_transform = at(0, 0, btScalar(0.52));
    btRigidBody& box =
        m_world.addRigid(new btBoxShape(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))), settings);
    m_world.step(240);
    double force = 0;
    for (int k = 0; k < 60; ++k)
    {
        m_world.step();
        force -= m_solver.fem().contactForce(&cube, &box).z() / 60;
    }
    EXPECT_NEAR(force, 10 * kGravity, 0.01 * 10 * kGravity);
    EXPECT_GT(box.getCenterOfMassPosition().z(), 0.4);
}

TEST_F(DeformableWorldTest, AnAnchoredLinkHangsOnASoftBody)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 0.2});
    addForces(m_world, cube);
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() > btScalar(0.39)) cube.setMass(i, 0);
    const btVector3 half(btScalar(0.1), btScalar(0.1), btScalar(0.1));
    auto* body = new btMultiBody(0, 10, btVector3(btScalar(0.07), btScalar(0.07), btScalar(0.07)), false, false);
    body->setBasePos(btVector3(0, 0, btScalar(-0.1)));
    btMultiBodyLinkCollider& base = m_world.addCollider(m_world.addMultiBody(body), -1, new btBoxShape(half));
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() < btScalar(0.01)) cube.appendDeformableAnchor(i, &base);
    m_world.step(300);
    Vec3 force;
    for (int k = 0; k < m_solver.fem().anchors(&cube).size(); ++k)
        force += (1 / double(kStep)) * vec3(m_solver.fem().anchors(&cube)[k].m_impulse);
    EXPECT_NEAR(force.z, -10 * kGravity, 1e-3 * 10 * kGravity);
    EXPECT_NEAR(base.getWorldTransform().getOrigin().z(), -0.1, 0.02);
    for (int k = 0; k < m_solver.fem().anchors(&cube).size(); ++k)
        EXPECT_LT(m_solver.fem().anchors(&cube)[k].m_error, 1e-3);  // it would fall by g h^2 = 2.7e-3 m in a step
}

// A platform on a motorised vertical slider: a deformable world applies gravity at another time within the step than
// other worlds.
TEST_F(DeformableWorldTest, MotorHeldLinkCarriesABody)
{
    const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.1));
    auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
    body->setupPrismatic(0, 20, btVector3(1, 1, 1), -1, btQuaternion::getIdentity(), btVector3(0, 0, 1),
                         btVector3(0, 0, btScalar(-0.1)), btVector3(0, 0, 0), false);
    btMultiBodyLinkCollider& link = m_world.addCollider(m_world.addMultiBody(body), 0, new btBoxShape(half));
    m_world.addConstraint<btMultiBodyJointMotor>(body, 0, 0, btScalar(1e4));
    btSoftBody& cube = addCube(m_world, {0, 0, 0.21});
    addForces(m_world, cube);
    m_world.step(300);
    const double weight = massOf(cube) * kGravity;
    EXPECT_NEAR(m_solver.fem().contactForce(&cube, &link).z(), weight, 2e-3 * weight);
    EXPECT_LT(fastestNode(cube), 0.01);
}

TEST_F(DeformableWorldTest, BodiesFallAsleepInTwoSecondsAndWake)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(m_world, {0, 0, 0.2});
    addForces(m_world, cube);
    cube.forceActivationState(ACTIVE_TAG);
    int awake = 0;
    while (cube.isActive() && awake < 400) m_world.step(), ++awake;
    EXPECT_GT(awake, 120);
    EXPECT_LT(awake, 240);
    cube.addVelocity(btVector3(0, 0, 1));
    m_world.step(2);
    EXPECT_TRUE(cube.isActive());
    EXPECT_GT(velocityOf(cube).z, 0.5);
}

TEST_F(DeformableWorldTest, BodiesMayBeRemovedWithinAStepAndAfter)
{
    btSoftBody &a = addCube(m_world, {0, 0, 1}), &b = addCube(m_world, {2, 0, 1});
    for (btSoftBody* body : {&a, &b}) addForces(m_world, *body);
    btSoftBody& cloth = addCloth(m_world);
    m_world.step(3);
    m_world.world().removeSoftBody(&a);
    m_world.step(3);
    EXPECT_TRUE(m_solver.fem().isFem(&b));
    m_world.world().setInternalTickCallback(
        [](btDynamicsWorld* of, btScalar)
        {
            auto* soft = static_cast<btSoftBody*>(of->getWorldUserInfo());
            if (soft) static_cast<btDeformableMultiBodyDynamicsWorld*>(of)->removeSoftBody(soft);
            of->setWorldUserInfo(nullptr);
        },
        &b);
    m_world.step(3);
    EXPECT_FALSE(m_solver.fem().isFem(&b));
    EXPECT_TRUE(allFinite(cloth));
    for (const auto& force : m_forces)
        for (int k = 0; k < force->m_softBodies.size(); ++k) EXPECT_EQ(force->m_softBodies[k], &cloth);
    for (btSoftBody* body : {&a, &b}) m_world.world().addSoftBody(body);
    for (btSoftBody* body : {&a, &b}) addForces(m_world, *body);
    m_world.step(3);
    EXPECT_TRUE(m_solver.fem().isFem(&a) && m_solver.fem().isFem(&b));
}

}  // namespace
}  // namespace bullet_fem
