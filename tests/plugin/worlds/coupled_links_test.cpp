// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Monolithic coupling in multibody worlds: links, their motors and soft bodies in one solve.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "plugin/scenes/link_gripper.h"

namespace bullet_fem
{
namespace
{

/// A multibody world with its FEM solver, with a common interface for both kinds.
class SoftMultiBodyLinks
{
public:
    using World = CoupledLinkWorld;
    explicit SoftMultiBodyLinks(const btVector3& gravity) : m_world(m_fem, gravity) {}
    btFemSoftBodySolver& fem() { return m_fem; }
    void letFall(btSoftBody&) {}

private:
    btFemSoftBodySolver m_fem;

public:
    World m_world;
};

class DeformableLinks
{
public:
    using World = CoupledDeformableWorld;
    explicit DeformableLinks(const btVector3& gravity) : m_gravity(gravity), m_world(m_deformable, gravity) {}
    btFemSoftBodySolver& fem() { return m_deformable.fem(); }
    void letFall(btSoftBody& body) { m_world.world().addForce(&body, &m_gravity); }

private:
    btFemDeformableBodySolver m_deformable;
    btDeformableGravityForce m_gravity;

public:
    World m_world;
};

template <class Links>
class CoupledLinks : public ::testing::Test
{
protected:
    void begin(const btVector3& gravity = {0, 0, btScalar(-kGravity)}) { m_links = std::make_unique<Links>(gravity); }
    typename Links::World& world() { return m_links->m_world; }
    btFemSoftBodySolver& fem() { return m_links->fem(); }

    LinkGripper<typename Links::World>& addGripper(double force)
    {
        begin();
        m_gripper = std::make_unique<LinkGripper<typename Links::World>>(world(), fem(), force);
        m_links->letFall(m_gripper->cube());
        return *m_gripper;
    }
    btSoftBody& addSoft(const SoftBox& box)
    {
        btSoftBody& body = world().addSoft(makeSoftBox(world().info(), fem(), box));
        m_links->letFall(body);
        return body;
    }
    btSoftBody& addFlyingCube(const Vec3& center, const btVector3& velocity)
    {
        SoftBox box;
        box.m_size = {0.4, 0.4, 0.4};
        box.m_center = center;
        btSoftBody& cube = world().addSoft(makeSoftBox(world().info(), fem(), box));
        cube.setVelocity(velocity);
        return cube;
    }

    std::unique_ptr<Links> m_links;
    std::unique_ptr<LinkGripper<typename Links::World>> m_gripper;
};

struct LinkNames
{
    template <class Links>
    static std::string GetName(int)
    {
        return std::is_same_v<Links, DeformableLinks> ? "deformable" : "softMultiBody";
    }
};

using LinkWorlds = ::testing::Types<SoftMultiBodyLinks, DeformableLinks>;
TYPED_TEST_SUITE(CoupledLinks, LinkWorlds, LinkNames);

TYPED_TEST(CoupledLinks, GripperPressesWithTheForceOfItsMotors)
{
    constexpr double kForce = 20;  // [N]
    auto& gripper = this->addGripper(kForce);
    auto& world = this->world();
    world.step(8);  // three steps to close, and some to compress the cube
    for (int frame = 0; frame < 60; ++frame)
    {
        world.step();
        for (const int side : {0, 1})
        {
            EXPECT_NEAR(gripper.forceOf(side).x, side ? -kForce : kForce, 0.01 * kForce) << "frame " << frame;
            EXPECT_LT(std::fabs(gripper.fingerSpeed(side)), frame < 10 ? 1e-3 : 1e-4) << "frame " << frame;
        }
    }
}

TYPED_TEST(CoupledLinks, AGripperLiftsTheCubeAndHoldsIt)
{
    auto& gripper = this->addGripper(20);
    auto& world = this->world();
    world.step(60);
    const double start = centerOf(gripper.cube()).z;
    gripper.liftAt(0.2);
    world.step(60);
    gripper.liftAt(0);
    world.step(30);
    const double above = centerOf(gripper.cube()).z - start;
    EXPECT_NEAR(above, 0.2, 0.003);
    for (int frame = 0; frame < 60; ++frame)
    {
        world.step();
        const Vec3 held = gripper.forceOf(0) + gripper.forceOf(1);
        EXPECT_NEAR(held.z, gripper.weight(), 1e-3 * gripper.weight());
        EXPECT_LT(std::fabs(held.x), 1e-3 * gripper.weight());
        EXPECT_LT(std::fabs(gripper.hand().getJointVel(0)), 1e-4);
    }
    EXPECT_NEAR(centerOf(gripper.cube()).z - start, above, 1e-3);
}

// mu N of both fingers is 0.8 of its weight.
TYPED_TEST(CoupledLinks, AWeakGripperDropsIt)
{
    auto& gripper = this->addGripper(0.8 * 9.81);
    auto& world = this->world();
    world.step(60);
    const double start = centerOf(gripper.cube()).z;
    gripper.liftAt(0.2);
    world.step(60);
    EXPECT_LT(centerOf(gripper.cube()).z - start, 0.02);
}

// The motor of a lift carries the load, which shows in its joint at rest.
TYPED_TEST(CoupledLinks, ALiftStandsStillUnderItsLoad)
{
    const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.05));
    this->begin();
    auto& world = this->world();
    btFemSoftBodySolver& fem = this->fem();
    auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
    body->setupPrismatic(0, 10, boxInertia(10, half), -1, kNoTurn, btVector3(0, 0, 1), btVector3(0, 0, 0),
                         btVector3(0, 0, 0), false);
    btMultiBodyLinkCollider& plate = world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
    auto& motor = world.template addConstraint<btMultiBodyJointMotor>(body, 0, btScalar(0), 10000 * kStep);
    SoftBox box;
    box.m_size = {0.4, 0.4, 0.4};
    box.m_center = {0, 0, 0.251};
    btSoftBody& cube = this->addSoft(box);
    world.step(120);
    const double weight = massOf(cube) * kGravity;
    for (int frame = 0; frame < 30; ++frame)
    {
        world.step();
        EXPECT_NEAR(fem.contactForce(&cube, &plate).z(), weight, 1e-3 * weight);
        EXPECT_LT(std::fabs(body->getJointVel(0)), 1e-5);
        EXPECT_LT(fem.stepReport(&cube).m_contactSweeps, 20);  // the motor follows the warm start of the contacts
        EXPECT_NEAR(motor.getAppliedImpulse(0) / kStep, weight + 10 * kGravity, 2e-3 * weight);
    }
}

// Angular momentum about the hinge, which bears all other components.
TYPED_TEST(CoupledLinks, HitPendulumReceivesTheAngularMomentum)
{
    const btVector3 half(btScalar(0.1), btScalar(0.3), btScalar(0.5));
    this->begin(kNoGravity);
    auto& world = this->world();
    auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
    body->setupRevolute(0, 30, boxInertia(30, half), -1, kNoTurn, btVector3(0, 1, 0), btVector3(0, 0, 0),
                        btVector3(0, 0, -half.z()), false);
    world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
    btSoftBody& cube = this->addFlyingCube({-0.35, 0, -0.7}, btVector3(3, 0, btScalar(0.5)));
    const double start = motionOf(cube).m_angular.y;
    double worst = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        worst = std::max(worst, std::fabs(motionOf(cube).m_angular.y + motionOfLinks(*body).m_angular.y - start));
    }
    EXPECT_GT(std::fabs(motionOfLinks(*body).m_angular.y), 0.2 * std::fabs(start));
    EXPECT_LT(worst, 2e-5 * std::fabs(start));
}

// A free base with a plate on a slider: momentum is conserved to Bullet's error in the joint, equal without the cube.
TYPED_TEST(CoupledLinks, LinearMomentumOfAFreeSliderAndACubeIsKept)
{
    const btVector3 half(btScalar(0.05), btScalar(0.3), btScalar(0.3));
    this->begin(kNoGravity);
    auto& world = this->world();
    auto* body = new btMultiBody(1, 20, boxInertia(20, half), false, false);
    body->setBasePos(btVector3(btScalar(0.5), 0, 0));
    body->setupPrismatic(0, 5, boxInertia(5, half), -1, kNoTurn, btVector3(1, 0, 0), btVector3(btScalar(-0.4), 0, 0),
                         btVector3(0, 0, 0), false);
    world.addMultiBody(body);
    world.addCollider(*body, 0, new btBoxShape(half));
    btSoftBody& cube = this->addFlyingCube({-0.2, 0, 0}, btVector3(3, 0, 0));
    const double start = motionOf(cube).m_linear.x;
    double worst = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        worst = std::max(worst, std::fabs(motionOf(cube).m_linear.x + motionOfLinks(*body).m_linear.x - start));
    }
    EXPECT_GT(body->getJointVel(0), 0.5);
    EXPECT_LT(worst, 2e-5 * start);
}

// 10 kg on a slab: with the swap it would have a velocity of g h.
TYPED_TEST(CoupledLinks, RigidBodiesRestOnSoftOnes)
{
    this->begin();
    auto& world = this->world();
    btFemSoftBodySolver& fem = this->fem();
    world.addFloorBox();
    SoftBox box;
    box.m_size = {0.6, 0.6, 0.2};
    box.m_cells = {6, 6, 2};
    box.m_center = {0, 0, 0.1};
    btSoftBody& slab = this->addSoft(box);
    RigidSettings settings;
    settings.m_mass = 10;
    settings.m_transform = at(0, 0, btScalar(0.301));
    btRigidBody& rigid =
        world.addRigid(new btBoxShape(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))), settings);
    world.step(120);
    EXPECT_LT(rigid.getLinearVelocity().length(), 1e-4);
    EXPECT_NEAR(fem.contactForce(&slab, &rigid).z(), -10 * kGravity, 1e-3 * 10 * kGravity);
    EXPECT_EQ(fem.stepReport(&slab).m_flags & BT_FEM_SOLVED_AFTER, 0);
}

// A free ball of a multibody, pressed by a free block from below, spins on it: the couple acts on both.
template <class World>
void expectSpinningFrictionKeepsMomenta(World& world, btFemSoftBodySolver& fem)
{
    constexpr btScalar kBall = btScalar(0.25), kMass = 30;
    SoftBox box;
    box.m_size = {0.6, 0.6, 0.2};
    box.m_cells = {6, 6, 2};
    box.m_center = {0, 0, -0.1};
    btSoftBody& block = world.addSoft(makeSoftBox(world.info(), fem, box));
    block.setVelocity(btVector3(0, 0, btScalar(0.2)));
    const btScalar inertia = btScalar(0.4) * kMass * kBall * kBall;
    auto* body = new btMultiBody(0, kMass, btVector3(inertia, inertia, inertia), false, false);
    body->setBasePos(btVector3(btScalar(0.03), btScalar(0.05), kBall));
    world.addMultiBody(body);
    body->setBaseOmega(btVector3(0, 0, 20));
    btMultiBodyLinkCollider& ball = world.addCollider(*body, -1, new btSphereShape(kBall));
    ball.setSpinningFriction(btScalar(0.3));
    const double start = 20 * inertia;
    double worst = 0;
    for (int k = 0; k < 30; ++k)
    {
        world.step();
        worst = std::max(worst, std::fabs(motionOf(block).m_angular.z + motionOfLinks(*body).m_angular.z - start));
    }
    EXPECT_LT(body->getBaseOmega().z(), 19.5);
    EXPECT_LT(worst, 1e-5 * start);
}

TYPED_TEST(CoupledLinks, SpinningFrictionOfALinkKeepsMomenta)
{
    this->begin(kNoGravity);
    expectSpinningFrictionKeepsMomenta(this->world(), this->fem());
}

TEST(CoupledLinksAlone, SpinningFrictionOfALinkKeepsMomentaWithTheSwapToo)
{
    btFemSoftBodySolver fem;
    MultiBodyWorld world(fem, kNoGravity);
    expectSpinningFrictionKeepsMomenta(world, fem);
}

// A cloth over a rigid box on a slab: all three are in one island.
TEST(CoupledLinksAlone, ClothRestsOnALoadCarriedByASoftBody)
{
    const btVector3 gravity(0, 0, btScalar(-kGravity));
    btDeformableMassSpringForce springs(btScalar(30), btScalar(1), true);
    DeformableLinks links(gravity);
    CoupledDeformableWorld& world = links.m_world;
    world.addFloorBox();
    SoftBox box;
    box.m_size = {0.8, 0.8, 0.2};
    box.m_cells = {6, 6, 2};
    box.m_center = {0, 0, 0.1};
    btSoftBody& slab = world.addSoft(makeSoftBox(world.info(), links.fem(), box));
    links.letFall(slab);
    RigidSettings settings;
    settings.m_mass = 20;
    settings.m_transform = at(0, 0, btScalar(0.301));
    btRigidBody& rigid =
        world.addRigid(new btBoxShape(btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.1))), settings);
    const btScalar h = btScalar(0.5), z = btScalar(0.5);
    btSoftBody* made = btSoftBodyHelpers::CreatePatch(world.info(), btVector3(-h, -h, z), btVector3(h, -h, z),
                                                      btVector3(-h, h, z), btVector3(h, h, z), 9, 9, 0, true);
    made->getCollisionShape()->setMargin(btScalar(0.05));
    made->setTotalMass(btScalar(0.5));
    made->m_cfg.kDF = btScalar(0.5);
    made->m_cfg.collisions =
        btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN | btSoftBody::fCollision::SDF_RDF;
    made->setCollisionFlags(0);
    btSoftBody& cloth = world.addSoft(made);
    world.world().addForce(&cloth, &springs);
    links.letFall(cloth);
    world.step(120);
    double load = 0;
    for (int k = 0; k < 30; ++k)
    {
        world.step();
        load -= links.fem().contactForce(&slab, &rigid).z() / 30;
    }
    EXPECT_NEAR(load, 20.5 * kGravity, 0.01 * 20.5 * kGravity);
    EXPECT_LT(rigid.getLinearVelocity().length(), 1e-2);
    EXPECT_TRUE(allFinite(cloth));
    EXPECT_GT(centerOf(cloth).z, 0.2);
}

// A pendulum with a motor, far from soft bodies.
TEST(CoupledLinksAlone, IslandsWithoutFemBodiesKeepTheirBits)
{
    const auto swing = [](auto& world)
    {
        const btVector3 half(btScalar(0.1), btScalar(0.3), btScalar(0.5));
        auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
        body->setBasePos(btVector3(20, 0, 5));
        body->setupRevolute(0, 3, boxInertia(3, half), -1, kNoTurn, btVector3(0, 1, 0), btVector3(0, 0, 0),
                            btVector3(0, 0, -half.z()), false);
        world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
        world.template addConstraint<btMultiBodyJointMotor>(body, 0, btScalar(2), 5 * kStep);
        for (int k = 0; k < 3; ++k)
        {
            RigidSettings settings;
            settings.m_mass = btScalar(1 + k);
            settings.m_transform = at(btScalar(10 + 0.01 * k), 0, btScalar(0.5 + k));
            world.addRigid(new btBoxShape(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))), settings);
        }
        world.addFloorBox();
        return body;
    };
    btFemSoftBodySolver fem, none;
    CoupledLinkWorld world(fem);
    MultiBodyWorld alone(none);
    const btMultiBody *here = swing(world), *there = swing(alone);
    SoftBox box;
    box.m_size = {0.4, 0.4, 0.4};
    box.m_center = {0, 0, 0.21};
    world.addSoft(makeSoftBox(world.info(), fem, box));
    RigidSettings settings;
    settings.m_mass = 1;
    settings.m_transform = at(0, 0, btScalar(0.6));
    world.addRigid(new btSphereShape(btScalar(0.1)), settings);
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        alone.step();
        ASSERT_EQ(here->getJointPos(0), there->getJointPos(0)) << k;
        ASSERT_EQ(here->getJointVel(0), there->getJointVel(0)) << k;
        for (int b = 0; b < 3; ++b) ASSERT_EQ(bitsOf(world.rigid(b)), bitsOf(alone.rigid(b))) << k;
    }
}

TEST(CoupledLinksAlone, WantASolver)
{
    EXPECT_THROW(btFemMultiBodyConstraintSolver(nullptr), std::invalid_argument);
    std::string why;
    EXPECT_FALSE(btFemMultiBodyConstraintSolver::valid(nullptr, &why));
    EXPECT_NE(why.find("null"), std::string::npos);
    EXPECT_THROW(btFemDeformableConstraintSolver(nullptr), std::invalid_argument);
    EXPECT_FALSE(btFemDeformableConstraintSolver::valid(nullptr, &why));
    EXPECT_NE(why.find("btFemDeformableBodySolver"), std::string::npos);
}

}  // namespace
}  // namespace bullet_fem
