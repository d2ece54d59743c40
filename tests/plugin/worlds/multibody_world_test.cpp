// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "plugin/scenes/multibody_scene.h"

namespace bullet_fem
{
namespace
{

TEST_F(MultiBodyWorldTest, RemovedBodiesLoseTheirContacts)
{
    MultiBodyWorld world(m_fem);
    btMultiBodyLinkCollider& slider = addSlider(world, 1, {0, 0, 1}, {1, 1, btScalar(0.1)}, {0, 0, btScalar(0.5)});
    btSoftBody& cube = addCube(world, {0, 0, 0.2});
    RigidSettings floor;
    floor.m_transform = at(0, 0, -1);
    world.addRigid(new btBoxShape({50, 50, 1}), floor);
    world.step(10);
    const auto with = [&](const btCollisionObject* object)
    {
        int count = 0;
        for (int k = 0; k < cube.m_rcontacts.size(); ++k) count += cube.m_rcontacts[k].m_cti.m_colObj == object;
        return count;
    };
    ASSERT_GT(with(&slider), 0);
    ASSERT_GT(cube.m_rcontacts.size(), with(&slider));
    world.world().removeSoftBody(&cube);
    EXPECT_EQ(cube.m_rcontacts.size() + cube.m_faceRigidContacts.size(), 0);
}

TEST_F(MultiBodyWorldTest, AMotorCarriesTheWeightOfACubeOnItsLink)
{
    MultiBodyWorld world(m_fem);
    const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.1));
    btMultiBodyLinkCollider& link = addSlider(world, 20, btVector3(0, 0, 1), half, btVector3(0, 0, btScalar(-0.1)));
    auto& motor = world.addConstraint<btMultiBodyJointMotor>(link.m_multiBody, 0, 0, btScalar(1e4));
    btSoftBody& cube = addCube(world, {0, 0, 0.21});
    const double weight = massOf(cube) * kGravity;
    world.step(300);
    double force = 0, onCube = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        force += motor.getAppliedImpulse(0) / double(kStep) / 60;
        onCube += m_fem.contactForce(&cube, &link).z() / 60;
    }
    EXPECT_NEAR(onCube, weight, 1e-3 * weight);
    EXPECT_NEAR(std::fabs(force), weight + 20 * kGravity, 2e-3 * weight);
    EXPECT_LT(fastestNode(cube), 0.01);
    const double height = link.m_multiBody->getJointPos(0);  // a motor holds speed, not place: it gave way when hit
    EXPECT_GT(height, -0.05);
    world.step(60);
    EXPECT_NEAR(link.m_multiBody->getJointPos(0), height, 1e-4);
}

TEST_F(MultiBodyWorldTest, ASlidingCubeDragsItsSliderAlong)
{
    MultiBodyWorld world(m_fem);
    const btVector3 half(2, btScalar(0.5), btScalar(0.1));
    btMultiBodyLinkCollider& link = addSlider(world, 64, btVector3(1, 0, 0), half, btVector3(0, 0, btScalar(-0.1)));
    btSoftBody& cube = addCube(world, {0, 0, 0.2});
    cube.setVelocity(btVector3(1, 0, 0));
    const double start = massOf(cube);
    double worst = 0, carried = 0;
    for (int k = 0; k < 120; ++k)
    {
        world.step();
        const double momentum = motionOf(cube).m_linear.x + 64 * double(link.m_multiBody->getJointVel(0));
        worst = std::max(worst, std::fabs(momentum - start) / start);
        carried += m_fem.contactForce(&cube, &link).z() / 120;
    }
    const double together = start / (start + 64);
    EXPECT_LT(worst, 2e-5);
    EXPECT_NEAR(link.m_multiBody->getJointVel(0), together, 0.01);
    EXPECT_NEAR(velocityOf(cube).x, together, 0.01);
    EXPECT_NEAR(carried, massOf(cube) * kGravity, 0.02 * massOf(cube) * kGravity);  // the joint carries it
}

class ImmovableLink : public MultiBodyWorldTest, public ::testing::WithParamInterface<int>
{
};

// Contact forces on a cube at rest on the base of a multibody: fixed to the world, static by flag, kinematic.
TEST_P(ImmovableLink, CarriesACubeLikeAFloor)
{
    MultiBodyWorld world(m_fem);
    const btVector3 half(1, 1, btScalar(0.1));
    auto* body = new btMultiBody(0, 5, boxInertia(5, half), GetParam() == 0, false);
    body->setBasePos(btVector3(0, 0, btScalar(-0.1)));
    btMultiBodyLinkCollider& base = world.addCollider(world.addMultiBody(body), -1, new btBoxShape(half));
    if (GetParam() != 0) body->setBaseDynamicType(GetParam());
    btSoftBody& cube = addCube(world, {0, 0, 0.2});
    world.step(240);
    const double weight = massOf(cube) * kGravity;
    EXPECT_NEAR(m_fem.contactForce(&cube, &base).z(), weight, 1e-3 * weight);
    EXPECT_EQ(base.getWorldTransform().getOrigin().z(), btScalar(-0.1));
    EXPECT_LT(fastestNode(cube), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Bases, ImmovableLink,
                         ::testing::Values(0, int(btCollisionObject::CF_STATIC_OBJECT),
                                           int(btCollisionObject::CF_KINEMATIC_OBJECT)),
                         [](const auto& base) {
                             return base.param == 0 ? "fixed" : base.param == 1 ? "static" : "kinematic";
                         });

TEST_F(MultiBodyWorldTest, AKinematicBaseTakesACubeAlong)
{
    MultiBodyWorld world(m_fem);
    const btVector3 half(1, 1, btScalar(0.1));
    auto* body = new btMultiBody(0, 5, boxInertia(5, half), false, false);
    body->setBasePos(btVector3(0, 0, btScalar(-0.1)));
    world.addCollider(world.addMultiBody(body), -1, new btBoxShape(half));
    body->setBaseDynamicType(btCollisionObject::CF_KINEMATIC_OBJECT);
    btSoftBody& cube = addCube(world, {0, 0, 0.2}, 0.4, 1);
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> places;
    for (int k = 0; k < 120; ++k)
    {
        body->setBasePos(body->getBasePos() + btVector3(kStep * btScalar(0.3), 0, 0));
        body->updateCollisionObjectWorldTransforms(turns, places);
        body->setBaseVel(btVector3(btScalar(0.3), 0, 0));
        world.step();
    }
    EXPECT_NEAR(velocityOf(cube).x, 0.3, 0.003);
    EXPECT_NEAR(centerOf(cube).x, 0.6, 0.02);
}

// Cloth, and a chain that is in contact with the cloth only.
TEST_F(MultiBodyWorldTest, ClothBesideFemBodiesKeepsItsBits)
{
    const auto run = [this](btSoftBodySolver& solver, bool withFem)
    {
        MultiBodyWorld world(solver);
        world.addFloorBox();
        auto* cloth = btSoftBodyHelpers::CreatePatch(world.info(), btVector3(-1, -1, 1), btVector3(1, -1, 1),
                                                     btVector3(-1, 1, 1), btVector3(1, 1, 1), 9, 9, 0, true);
        world.addSoft(cloth);
        if (withFem) addCube(world, {5, 0, 0.5});
        std::vector<btScalar> bits;
        for (int k = 0; k < 120; ++k)
        {
            world.step();
            const std::vector<btScalar> now = bitsOf(*cloth);
            bits.insert(bits.end(), now.begin(), now.end());
        }
        return bits;
    };
    btDefaultSoftBodySolver bullet;
    EXPECT_EQ(run(bullet, false), run(m_fem, true));
}

TEST_F(MultiBodyWorldTest, TheSameSceneHasTheSameBitsAgain)
{
    const auto run = [this](int threads)
    {
        btFemSolverInfo info;
        info.m_threads = threads;
        btFemSoftBodySolver fem(info);
        MultiBodyWorld world(fem);
        const btMultiBodyLinkCollider& link =
            addPendulum(world, 30, btVector3(btScalar(0.1), btScalar(0.3), btScalar(0.5)));
        SoftBox box;
        box.m_size = {0.4, 0.4, 0.4};
        box.m_center = {-0.35, 0, -0.5};
        btSoftBody& cube = world.addSoft(makeSoftBox(world.info(), fem, box));
        cube.setVelocity(btVector3(3, 0, 0));
        world.step(60);
        std::vector<btScalar> bits = bitsOf(cube);
        bits.push_back(link.m_multiBody->getJointPos(0));
        bits.push_back(link.m_multiBody->getJointVel(0));
        return bits;
    };
    const std::vector<btScalar> once = run(1);
    EXPECT_EQ(once, run(1));
    EXPECT_EQ(once, run(2));
}

}  // namespace
}  // namespace bullet_fem
