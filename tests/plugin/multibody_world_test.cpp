// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_bridge/bullet_vectors.h"
#include "bullet_fem/btFemHelpers.h"
#include "plugin/link_world.h"
#include "plugin/scene_measures.h"
#include "plugin/soft_boxes.h"

namespace bullet_fem
{
namespace
{

const btVector3 kNoGravity(0, 0, 0);
const btQuaternion kNoTurn = btQuaternion::getIdentity();

btVector3 boxInertia(btScalar mass, const btVector3& half)
{
    btVector3 inertia;
    btBoxShape(half).calculateLocalInertia(mass, inertia);
    return inertia;
}

// Momenta of all links and the base, if that can move.
Motion motionOfLinks(btMultiBody& body)
{
    Motion sum;
    const int count = body.getNumLinks() + 1;
    std::vector<btVector3> spin(count), velocity(count);
    body.compTreeLinkVelocities(&spin[0], &velocity[0]);
    for (int k = body.hasFixedBase() ? 0 : -1; k < body.getNumLinks(); ++k)
    {
        const double mass = k < 0 ? body.getBaseMass() : body.getLinkMass(k);
        const btVector3 inertia = k < 0 ? body.getBaseInertia() : body.getLinkInertia(k);
        const Vec3 p = mass * vec3(body.localDirToWorld(k, velocity[k + 1]));
        const Vec3 c = vec3(body.localPosToWorld(k, btVector3(0, 0, 0)));
        const btVector3 L = inertia * spin[k + 1];
        sum.m_linear += p;
        sum.m_angular += cross(c, p) + vec3(body.localDirToWorld(k, L));
        sum.m_energy += 0.5 * mass * velocity[k + 1].length2() + 0.5 * L.dot(spin[k + 1]);
    }
    return sum;
}

class MultiBodyWorldTest : public ::testing::Test
{
protected:
    // A box on a slider along `axis` whose joint is at the world's origin; the box is at `center` to begin with.
    btMultiBodyLinkCollider& addSlider(MultiBodyWorld& world, btScalar mass, const btVector3& axis,
                                       const btVector3& half, const btVector3& center)
    {
        auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
        body->setupPrismatic(0, mass, boxInertia(mass, half), -1, kNoTurn, axis, center, btVector3(0, 0, 0), false);
        return world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
    }

    // A beam that hangs from a hinge along y at the origin; `half` of its box.
    btMultiBodyLinkCollider& addPendulum(MultiBodyWorld& world, btScalar mass, const btVector3& half)
    {
        auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
        body->setupRevolute(0, mass, boxInertia(mass, half), -1, kNoTurn, btVector3(0, 1, 0), btVector3(0, 0, 0),
                            btVector3(0, 0, -half.z()), false);
        return world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
    }

    btSoftBody& addCube(MultiBodyWorld& world, const Vec3& center, double edge = 0.4, double friction = 0.5)
    {
        SoftBox box;
        box.m_size = {edge, edge, edge};
        box.m_center = center;
        box.m_friction = btScalar(friction);
        return world.addSoft(makeSoftBox(world.info(), m_fem, box));
    }

    btFemSoftBodySolver m_fem;
};

TEST_F(MultiBodyWorldTest, aMotorCarriesTheWeightOfACubeOnItsLink)
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

TEST_F(MultiBodyWorldTest, aSlidingCubeDragsItsSliderAlong)
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
    EXPECT_NEAR(carried, massOf(cube) * kGravity, 0.02 * massOf(cube) * kGravity);  // it is the joint that bears it
}

TEST_F(MultiBodyWorldTest, aPendulumThatIsHitGetsTheAngularMomentum)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBodyLinkCollider& link = addPendulum(world, 30, btVector3(btScalar(0.1), btScalar(0.3), btScalar(0.5)));
    btSoftBody& cube = addCube(world, {-0.35, 0, -0.7}, 0.4, 0.3);
    cube.setVelocity(btVector3(3, 0, btScalar(0.5)));
    const double start = motionOf(cube).m_angular.y;
    double worst = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        const double now = motionOf(cube).m_angular.y + motionOfLinks(*link.m_multiBody).m_angular.y;
        worst = std::max(worst, std::fabs(now - start));
    }
    EXPECT_GT(std::fabs(motionOfLinks(*link.m_multiBody).m_angular.y), 0.2 * std::fabs(start));
    EXPECT_LT(worst, 2e-5 * std::fabs(start));
}

class FastLink : public MultiBodyWorldTest, public ::testing::WithParamInterface<std::pair<double, bool>>
{
};

// A plate that goes farther in a step than it and the cube are thick; on a slider along x, or on a hinge 2 m above.
TEST_P(FastLink, isStoppedByACubeAndKeepsTheMomentumThatItsJointLeaves)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    const double speed = GetParam().first;
    const bool hinged = GetParam().second;
    const btVector3 half(btScalar(0.02), btScalar(0.3), btScalar(0.3)), arm(0, 0, 2);
    const double mass = 20, inertia = boxInertia(btScalar(mass), half).y() + mass * 4;
    auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
    if (hinged)
        body->setupRevolute(0, btScalar(mass), boxInertia(btScalar(mass), half), -1, kNoTurn, btVector3(0, 1, 0), arm,
                            -arm, false);
    else
        body->setupPrismatic(0, btScalar(mass), boxInertia(btScalar(mass), half), -1, kNoTurn, btVector3(1, 0, 0),
                             btVector3(0, 0, 0), btVector3(0, 0, 0), false);
    btMultiBodyLinkCollider& link = world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
    body->setJointPos(0, hinged ? btScalar(0.6) : btScalar(-1.37));
    body->setJointVel(0, btScalar(hinged ? -0.5 * speed : speed));
    btSoftBody& cube = addCube(world, {0, 0, 0}, 0.4);
    const auto momentum = [&]  // along the slider, or about the hinge
    {
        const Motion soft = motionOf(cube);
        const double joint = body->getJointVel(0);
        return hinged ? soft.m_angular.y - 2 * soft.m_linear.x + inertia * joint : soft.m_linear.x + mass * joint;
    };
    const double start = momentum();
    double worst = 0;
    for (int k = 0; k < 40; ++k)
    {
        world.step();
        worst = std::max(worst, std::fabs(momentum() - start) / std::fabs(start));
        ASSERT_TRUE(allFinite(cube));
    }
    EXPECT_GT(velocityOf(cube).x, 0.05 * speed);
    EXPECT_LT(std::fabs(body->getJointVel(0)), 0.6 * (hinged ? 0.5 : 1) * speed);
    EXPECT_LT(worst, 1e-5);
    EXPECT_LT(link.getWorldTransform().getOrigin().x(), centerOf(cube).x + 0.2);
}

INSTANTIATE_TEST_SUITE_P(Speeds, FastLink,
                         ::testing::Values(std::pair(10.0, false), std::pair(40.0, false), std::pair(80.0, false),
                                           std::pair(10.0, true), std::pair(20.0, true), std::pair(40.0, true)),
                         [](const auto& speed) {
                             return (speed.param.second ? "hinge" : "slider") +
                                    std::to_string(static_cast<int>(speed.param.first));
                         });

// The same pendulum as a rigid body on Bullet's hinge, which is solved after the soft body pushed it.
TEST_F(MultiBodyWorldTest, aPendulumTurnsLikeARigidBodyOnAHinge)
{
    const btVector3 half(btScalar(0.1), btScalar(0.3), btScalar(0.5));
    const auto hit = [&](MultiBodyWorld& world)
    {
        btSoftBody& cube = addCube(world, {-0.35, 0, -0.7}, 0.4, 0);
        cube.setVelocity(btVector3(3, 0, 0));
        world.step(45);
    };
    MultiBodyWorld links(m_fem, kNoGravity);
    const btMultiBodyLinkCollider& link = addPendulum(links, 30, half);
    hit(links);

    MultiBodyWorld hinged(m_fem, kNoGravity);
    RigidSettings settings;
    settings.m_mass = 30;
    settings.m_transform = at(0, 0, -half.z());
    btRigidBody& beam = hinged.addRigid(new btBoxShape(half), settings);
    btHingeConstraint hinge(beam, btVector3(0, 0, half.z()), btVector3(0, 1, 0));
    hinged.world().addConstraint(&hinge);
    hit(hinged);
    hinged.world().removeConstraint(&hinge);
    const double spin = beam.getAngularVelocity().y();
    EXPECT_GT(std::fabs(spin), 1);
    EXPECT_NEAR(link.m_multiBody->getJointVel(0), spin, 0.05 * std::fabs(spin));
}

struct Chain
{
    const char* m_name;
    btMultibodyLink::eFeatherstoneJointType m_joint;
};

class FreeChain : public MultiBodyWorldTest, public ::testing::WithParamInterface<Chain>
{
protected:
    static constexpr btScalar kMass = 15;

    // Three boxes in a row along x, free in space, the middle one the base.
    btMultiBody& addChain(MultiBodyWorld& world)
    {
        const btVector3 half(btScalar(0.25), btScalar(0.3), btScalar(0.1));
        const btVector3 inertia = boxInertia(kMass, half), axis(0, 1, 0);
        auto* body = new btMultiBody(2, kMass, inertia, false, false);
        for (int k = 0; k < 2; ++k)
        {
            const btVector3 arm((k == 0 ? 1 : -1) * btScalar(0.3), 0, 0);
            switch (GetParam().m_joint)
            {
                case btMultibodyLink::eRevolute:
                    body->setupRevolute(k, kMass, inertia, -1, kNoTurn, axis, arm, arm);
                    break;
                case btMultibodyLink::ePrismatic:
                    body->setupPrismatic(k, kMass, inertia, -1, kNoTurn, btVector3(0, 0, 1), arm, arm, true);
                    break;
                case btMultibodyLink::eSpherical:
                    body->setupSpherical(k, kMass, inertia, -1, kNoTurn, arm, arm, true);
                    break;
                case btMultibodyLink::ePlanar:
                    body->setupPlanar(k, kMass, inertia, -1, kNoTurn, axis, 2 * arm, true);
                    break;
                default:
                    body->setupFixed(k, kMass, inertia, -1, kNoTurn, arm, arm);
            }
        }
        world.addMultiBody(body);
        for (int k = -1; k < 2; ++k) world.addCollider(*body, k, new btBoxShape(half));
        return *body;
    }
};

// The cube covers the seam between the base and a link, and hits off the middle. Bullet's own steps of joint
// coordinates keep momentum to the first order of the step only, so what soft bodies do is measured from where Bullet
// left off.
TEST_P(FreeChain, keepsAllMomentaWhenHitOnTwoLinksAtOnce)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBody& chain = addChain(world);
    btSoftBody& cube = addCube(world, {0.3, 0.1, 0.32}, 0.4, 0.5);
    cube.setVelocity(btVector3(btScalar(0.5), 0, -3));
    const Motion start = motionOf(cube);
    const auto whole = [&]
    {
        Motion sum = motionOf(cube);
        sum += motionOfLinks(chain);
        return sum;
    };
    std::pair<decltype(whole), Motion> moved{whole, {}};
    world.world().setInternalTickCallback(
        [](btDynamicsWorld* of, btScalar)
        {
            auto& seen = *static_cast<decltype(moved)*>(of->getWorldUserInfo());
            seen.second = seen.first();
        },
        &moved);
    double linear = 0, angular = 0;
    int most = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        const Motion now = whole();
        linear = std::max(linear, norm(now.m_linear - moved.second.m_linear));
        angular = std::max(angular, norm(now.m_angular - moved.second.m_angular));
        most = std::max(most, static_cast<int>(m_fem.touches(&cube).size()));
        ASSERT_TRUE(allFinite(cube));
        ASSERT_LE(now.m_energy, 1.001 * start.m_energy);
    }
    EXPECT_GE(most, 2);
    EXPECT_GT(norm(motionOfLinks(chain).m_linear), 0.1 * norm(start.m_linear));
    EXPECT_LT(linear, 1e-5 * norm(start.m_linear));
    EXPECT_LT(angular, 1e-5 * norm(start.m_linear));
}

INSTANTIATE_TEST_SUITE_P(Joints, FreeChain,
                         ::testing::Values(Chain{"fixed", btMultibodyLink::eFixed},
                                           Chain{"revolute", btMultibodyLink::eRevolute},
                                           Chain{"prismatic", btMultibodyLink::ePrismatic},
                                           Chain{"spherical", btMultibodyLink::eSpherical},
                                           Chain{"planar", btMultibodyLink::ePlanar}),
                         [](const auto& chain) { return chain.param.m_name; });

class HeldMultiBody : public MultiBodyWorldTest
{
protected:
    static constexpr btScalar kMass = 10;
    static constexpr double kHalf = 0.1;

    // A chain of `links` boxes below a base, all hinged along y; its top at `height`.
    btMultiBody& addHangingChain(MultiBodyWorld& world, int links, double height)
    {
        const btScalar edge = btScalar(kHalf);
        const btVector3 half(edge, edge, edge), arm(0, 0, -edge);
        const btVector3 inertia = boxInertia(kMass, half);
        auto* body = new btMultiBody(links, kMass, inertia, false, false);
        for (int k = 0; k < links; ++k)
            body->setupRevolute(k, kMass, inertia, k - 1, kNoTurn, btVector3(0, 1, 0), arm, arm, true);
        body->setBasePos(btVector3(0, 0, btScalar(height - kHalf)));
        world.addMultiBody(body);
        for (int k = -1; k < links; ++k) world.addCollider(*body, k, new btBoxShape(half));
        return *body;
    }

    Vec3 anchorForce(const btSoftBody& cube) const
    {
        Vec3 sum;
        for (int k = 0; k < m_fem.anchors(&cube).size(); ++k) sum += vec3(m_fem.anchors(&cube)[k].m_impulse);
        return (1 / double(kStep)) * sum;
    }
};

TEST_F(HeldMultiBody, anAnchoredSoftBodyCarriesTheWholeChain)
{
    MultiBodyWorld world(m_fem);
    btSoftBody& cube = addCube(world, {0, 0, 0.2});
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() > btScalar(0.39)) cube.setMass(i, 0);
    btMultiBody& chain = addHangingChain(world, 2, -0.001);
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() < btScalar(0.01) && std::fabs(cube.m_nodes[i].m_x.x()) < btScalar(0.15))
            cube.appendDeformableAnchor(i, chain.getBaseCollider());
    ASSERT_GT(cube.m_deformableAnchors.size(), 3);
    world.step(600);
    const double weight = 3 * kMass * kGravity;
    Vec3 force;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        force += (1.0 / 60) * anchorForce(cube);
    }
    EXPECT_NEAR(force.z, -weight, 2e-3 * weight);
    for (int k = 0; k < m_fem.anchors(&cube).size(); ++k) EXPECT_LT(m_fem.anchors(&cube)[k].m_error, 1e-3);
}

TEST_F(HeldMultiBody, aSoftBodyThatHangsOnAMovingLinkPullsAtItsJoint)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBodyLinkCollider& link =
        addSlider(world, 20, btVector3(1, 0, 0), btVector3(btScalar(0.3), btScalar(0.3), btScalar(0.1)), {0, 0, 0});
    btSoftBody& cube = addCube(world, {0, 0, -0.32});
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() > btScalar(-0.13)) cube.appendDeformableAnchor(i, &link);
    link.m_multiBody->setJointVel(0, 2);
    double worst = 0;
    for (int k = 0; k < 120; ++k)
    {
        world.step();
        const double momentum = motionOf(cube).m_linear.x + 20 * double(link.m_multiBody->getJointVel(0));
        worst = std::max(worst, std::fabs(momentum - 40) / 40);
    }
    EXPECT_LT(worst, 2e-5);
    EXPECT_GT(velocityOf(cube).x, 0.3);
}

TEST_F(HeldMultiBody, aSleepingMultibodyIsWokenByWhatFallsOnIt)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBody& chain = addHangingChain(world, 1, 0.1);
    chain.setCanSleep(true);
    for (int k = -1; k < 1; ++k)
        (k < 0 ? chain.getBaseCollider() : chain.getLinkCollider(k))->forceActivationState(ACTIVE_TAG);
    world.step(240);
    ASSERT_FALSE(chain.isAwake());
    btSoftBody& cube = addCube(world, {0, 0, 0.4});
    cube.setVelocity(btVector3(0, 0, -2));
    world.step(30);
    EXPECT_TRUE(chain.isAwake());
    EXPECT_LT(chain.getBaseVel().z(), -0.5);
}

// They are apart, in islands of their own: nothing but the anchor's impulse can wake it.
TEST_F(HeldMultiBody, aSleepingMultibodyIsWokenByAnAnchorFarAway)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBody& chain = addHangingChain(world, 0, 0.1);
    chain.setCanSleep(true);
    chain.getBaseCollider()->forceActivationState(ACTIVE_TAG);
    world.step(300);
    ASSERT_EQ(chain.getBaseCollider()->getActivationState(), ISLAND_SLEEPING);
    btSoftBody& cube = addCube(world, {3, 0, 0});
    for (int i = 0; i < 5; ++i) cube.appendDeformableAnchor(i, chain.getBaseCollider());
    cube.setVelocity(btVector3(btScalar(0.05), 0, 0));
    world.step(30);
    EXPECT_GT(chain.getBaseVel().x(), 0.01);
    EXPECT_GT(chain.getBasePos().x(), 0.005);
}

class ImmovableLink : public MultiBodyWorldTest, public ::testing::WithParamInterface<int>
{
};

// What a cube at rest on the base of a multibody feels: fixed to the world, static by flag, kinematic.
TEST_P(ImmovableLink, carriesACubeLikeAFloor)
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

TEST_F(MultiBodyWorldTest, aKinematicBaseTakesACubeAlong)
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

// Cloth, and a chain that only it touches.
TEST_F(MultiBodyWorldTest, clothBesideFemBodiesKeepsItsBits)
{
    const auto run = [this](btSoftBodySolver& solver, bool withFem)
    {
        MultiBodyWorld world(solver);
        world.addFloorBox();
        auto* cloth = btSoftBodyHelpers::CreatePatch(world.info(), btVector3(-1, -1, 1), btVector3(1, -1, 1),
                                                     btVector3(-1, 1, 1), btVector3(1, 1, 1), 9, 9, 0, true);
        world.addSoft(cloth);
        if (withFem) addCube(world, {5, 0, 0.5});
        std::vector<float> bits;
        for (int k = 0; k < 120; ++k)
        {
            world.step();
            const std::vector<float> now = bitsOf(*cloth);
            bits.insert(bits.end(), now.begin(), now.end());
        }
        return bits;
    };
    btDefaultSoftBodySolver bullet;
    EXPECT_EQ(run(bullet, false), run(m_fem, true));
}

TEST_F(MultiBodyWorldTest, theSameSceneHasTheSameBitsAgain)
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
        std::vector<float> bits = bitsOf(cube);
        bits.push_back(link.m_multiBody->getJointPos(0));
        bits.push_back(link.m_multiBody->getJointVel(0));
        return bits;
    };
    const std::vector<float> once = run(1);
    EXPECT_EQ(once, run(1));
    EXPECT_EQ(once, run(2));
}

}  // namespace
}  // namespace bullet_fem
