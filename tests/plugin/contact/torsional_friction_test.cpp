// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rolling and spinning friction of rigid bodies on soft ones, compared with Bullet's on rigid ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_fem/bullet_bridge/vectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kBallRadius = 0.25;  // [m]
constexpr double kBallMass = 2;       // above 6 kg Bullet limits friction at 1 N s a step [kg]
constexpr double kBallInertia = 0.4 * kBallMass * kBallRadius * kBallRadius;  // [kg m2]

struct TorsionalCoefficients
{
    double m_rolling, m_spinning;  // [m]
};

/// A slab of 2.4 x 0.6 x 0.1 m on the ground, with its upper face at z = 0 and a fixed lower face; friction 1.
btSoftBody& addSlab(FemWorld& world, btScalar youngModulus = btScalar(1e7))
{
    SoftBox box;
    box.m_size = {2.4, 0.6, 0.1};
    box.m_cells = {24, 6, 1};
    box.m_center = {0, 0, -0.05};
    box.m_youngModulus = youngModulus;
    box.m_friction = 1;
    btSoftBody& slab = addSoftBox(world, world.fem(), box);
    clampBelow(slab, -0.099);
    return slab;
}

RigidSettings ballAt(double x, double y, double height = kBallRadius)
{
    RigidSettings settings;
    settings.m_mass = btScalar(kBallMass);
    settings.m_transform = at(btScalar(x), btScalar(y), btScalar(height));
    return settings;
}

btRigidBody& addRigidBall(FemWorld& world, const RigidSettings& settings, const TorsionalCoefficients& friction)
{
    btRigidBody& ball = world.addRigid(new btSphereShape(btScalar(kBallRadius)), settings);
    ball.setRollingFriction(btScalar(friction.m_rolling));
    ball.setSpinningFriction(btScalar(friction.m_spinning));
    return ball;
}

/// A ball on a slab, and its reference on rigid ground.
struct BallAndTwin
{
    btRigidBody *m_ball, *m_twin;
};

BallAndTwin addBalls(FemWorld& world, RigidSettings settings, const TorsionalCoefficients& friction)
{
    RigidSettings ground;
    ground.m_transform = at(0, 10, -1);
    addRigidBox(world, {4, 4, 2}, ground);
    btRigidBody& ball = addRigidBall(world, settings, friction);
    settings.m_transform.getOrigin() += btVector3(0, 10, 0);
    return {&ball, &addRigidBall(world, settings, friction)};
}

/// The couple on the ball besides its contact impulses with a body, and the normal load: impulses of a step.
struct StepCouple
{
    Vec3 m_couple;        // [N m s]
    double m_normal = 0;  // [N s]
};

StepCouple stepAndMeasure(FemWorld& world, const btRigidBody& ball, const btSoftBody& body)
{
    const Vec3 center = vec3(ball.getWorldTransform().getOrigin()), before = vec3(ball.getAngularVelocity());
    world.step();
    StepCouple result;
    result.m_couple = kBallInertia * (vec3(ball.getAngularVelocity()) - before);
    const btAlignedObjectArray<btFemContact>& contacts = world.fem().contacts(&body);
    for (int k = 0; k < contacts.size(); ++k)
    {
        result.m_couple += cross(vec3(contacts[k].m_point) - center, vec3(contacts[k].m_impulse));
        result.m_normal += contacts[k].m_normalImpulse;
    }
    return result;
}

class TorsionalFrictionTest : public testing::TestWithParam<Coupling>
{
};

// A ball rolling along x decelerates by 5/7 mu_r g / r; Bullet's on rigid ground a tenth sooner.
TEST_P(TorsionalFrictionTest, RollingBallStopsAboutAsOnRigidGround)
{
    constexpr double kSpeed = 1, kRolling = 0.05;  // [m/s], [m]
    FemWorld world(WorldClass::softRigid, GetParam());
    addSlab(world);
    RigidSettings settings = ballAt(-0.97, 0.02);
    settings.m_velocity = btVector3(btScalar(kSpeed), 0, 0);
    settings.m_spin = btVector3(0, btScalar(kSpeed / kBallRadius), 0);
    const auto [ball, twin] = addBalls(world, settings, {kRolling, 0.01});
    world.step(120);
    const double way = kSpeed * kSpeed / (2 * 5.0 / 7 * kRolling * kGravity / kBallRadius);
    const double onSlab = ball->getWorldTransform().getOrigin().x() + 0.97;
    const double onGround = twin->getWorldTransform().getOrigin().x() + 0.97;
    EXPECT_NEAR(onSlab, way, 0.05 * way);
    EXPECT_GT(onSlab, 0.88 * onGround);
    world.step(240);  // on a facet's edge it may creep for some seconds
    EXPECT_LT(ball->getLinearVelocity().length(), 1e-5);
    EXPECT_LT(ball->getAngularVelocity().length(), 1e-4);
}

TEST_P(TorsionalFrictionTest, BallRollsOnWithoutIt)
{
    FemWorld world(WorldClass::softRigid, GetParam());
    addSlab(world);
    RigidSettings settings = ballAt(-0.97, 0.02);
    settings.m_velocity = btVector3(1, 0, 0);
    settings.m_spin = btVector3(0, btScalar(1 / kBallRadius), 0);
    btRigidBody& ball = addRigidBall(world, settings, {0, 0});
    world.step(60);
    EXPECT_GT(ball.getWorldTransform().getOrigin().x() + 0.97, 0.6);
}

// Coulomb's law: while the ball spins about a horizontal axis, the couple is mu_r times the normal load, against the
// spin. It does not move on, as the contact points of a moving ball are v h ahead of the load.
TEST(TorsionalFrictionLaw, IsTheCoefficientTimesTheLoad)
{
    constexpr double kRolling = 0.005;  // [m]
    for (const double spin : {3.0, 10.0, -5.0})
    {
        FemWorld world(WorldClass::softRigid, Coupling::coupled);
        btSoftBody& slab = addSlab(world);
        btRigidBody& ball = addRigidBall(world, ballAt(-1, 0.05), {kRolling, 0});
        world.step(10);
        ball.setLinearVelocity(btVector3(0, 0, 0));
        ball.setAngularVelocity(btVector3(0, btScalar(spin), 0));
        const StepCouple step = stepAndMeasure(world, ball, slab);
        EXPECT_GT(step.m_normal, 0.2);
        EXPECT_NEAR(step.m_couple.y, std::copysign(kRolling, -spin) * step.m_normal, 2e-3 * kRolling * step.m_normal);
    }
}

TEST_P(TorsionalFrictionTest, ASpinningBallSlowsDownAsOnRigidGround)
{
    constexpr double kSpin = 20, kSpinning = 0.05;  // [rad/s], [m]
    FemWorld world(WorldClass::softRigid, GetParam());
    addSlab(world);
    RigidSettings settings = ballAt(0.03, 0.05);
    settings.m_spin = btVector3(0, 0, btScalar(kSpin));
    const auto [ball, twin] = addBalls(world, settings, {1e-5, kSpinning});  // without rolling friction Bullet has none
    world.step(15);
    const double begin = ball->getAngularVelocity().z(), twinBegin = twin->getAngularVelocity().z();
    world.step(30);
    const double slowed = 0.5 * kSpinning * kBallMass * kGravity / kBallInertia;
    EXPECT_NEAR(twinBegin - twin->getAngularVelocity().z(), slowed, 1e-3 * slowed);
    EXPECT_NEAR(begin - ball->getAngularVelocity().z(), slowed, 2e-3 * slowed);
    world.step(60);
    EXPECT_LT(std::fabs(ball->getAngularVelocity().z()), 1e-4);
}

// At tan(angle) = mu_r / r the couple balances the ball's weight.
TEST_P(TorsionalFrictionTest, RollingFrictionHoldsABallOnASlope)
{
    constexpr double kRolling = 0.05;
    for (const double share : {0.9, 1.3})
    {
        const double slope = share * kRolling / kBallRadius, side = kGravity / std::sqrt(1 + slope * slope);
        FemWorld world(WorldClass::softRigid, GetParam(), btVector3(btScalar(side * slope), 0, btScalar(-side)));
        addSlab(world);
        btRigidBody& ball = addRigidBall(world, ballAt(-0.97, 0.02), {kRolling, 0.01});
        world.step(120);
        const double speed = ball.getLinearVelocity().x();
        const double free = 2 * 5.0 / 7 * side * (slope - kRolling / kBallRadius);
        EXPECT_GT(speed, share < 1 ? -1e-4 : 0.5 * free);
        EXPECT_LT(speed, std::max(1.05 * free, 1e-4));
    }
}

// A capsule along y rolls along x. Bullet's anisotropic direction for capsules leaves only the friction about its axis.
TEST_P(TorsionalFrictionTest, MayBeAnisotropic)
{
    for (const bool aboutItsAxis : {true, false})
    {
        FemWorld world(WorldClass::softRigid, GetParam());
        addSlab(world);
        RigidSettings settings = ballAt(-0.97, 0.02);
        settings.m_velocity = btVector3(btScalar(0.6), 0, 0);
        settings.m_spin = btVector3(0, btScalar(0.6 / kBallRadius), 0);
        btRigidBody& capsule = world.addRigid(new btCapsuleShape(btScalar(kBallRadius), btScalar(0.2)), settings);
        capsule.setRollingFriction(btScalar(0.05));
        const btVector3 direction = capsule.getCollisionShape()->getAnisotropicRollingFrictionDirection();
        capsule.setAnisotropicFriction(aboutItsAxis ? direction : btVector3(1, 1, 1) - direction,
                                       btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION);
        world.step(60);
        const double speed = capsule.getLinearVelocity().x();
        if (aboutItsAxis)
            EXPECT_LT(std::fabs(speed), 1e-3);
        else
            EXPECT_GT(speed, 0.1);
    }
}

// Bitwise equal for any number of threads, with several balls on one slab.
TEST(TorsionalFrictionOnThreads, HasTheSameBits)
{
    std::vector<btScalar> first;
    for (const int threads : {1, 2, 3})
    {
        btFemSolverInfo info;
        info.m_threads = threads;
        FemWorld world(WorldClass::softRigid, Coupling::swap, btVector3(0, 0, btScalar(-kGravity)), info);
        const btSoftBody& slab = addSlab(world);
        for (int k = 0; k < 4; ++k)
        {
            RigidSettings settings = ballAt(-0.9 + 0.6 * k, 0.01 * k);
            settings.m_velocity = btVector3(btScalar(0.2), btScalar(0.05), 0);
            addRigidBall(world, settings, {0.02, 0.01});
        }
        world.step(30);
        if (threads == 1) first = bitsOf(slab);
        EXPECT_EQ(bitsOf(slab), first) << threads;
    }
}

// No external torque acts on the pair.
TEST_P(TorsionalFrictionTest, KeepsTheAngularMomentumOfAFreePair)
{
    FemWorld world(WorldClass::softRigid, GetParam(), btVector3(0, 0, 0));
    SoftBox box;
    box.m_size = {0.6, 0.6, 0.2};
    box.m_cells = {6, 6, 2};
    box.m_center = {0, 0, -0.1};
    box.m_friction = 1;
    btSoftBody& block = addSoftBox(world, world.fem(), box);
    block.setVelocity(btVector3(0, 0, btScalar(0.2)));
    RigidSettings settings = ballAt(0.03, 0.05);
    settings.m_mass = 30;
    settings.m_spin = btVector3(5, 3, 20);
    btRigidBody& ball = addRigidBall(world, settings, {0.02, 0.3});
    Motion start = motionOf(ball);
    start += motionOf(block);
    double worst = 0;
    for (int k = 0; k < 30; ++k)
    {
        world.step();
        Motion now = motionOf(ball);
        now += motionOf(block);
        worst = std::max(worst, norm(now.m_angular - start.m_angular));
    }
    EXPECT_LT(ball.getAngularVelocity().z(), 19.5);
    // Among 16 places in single precision the maximum error was 1.6e-6; in double precision 2e-10.
    const double rounding = sizeof(btScalar) == 4 ? 2e-6 : 1e-9;
    EXPECT_LT(worst, rounding * norm(start.m_angular));
}

// Spinning friction of many contact points equals that of a ball's few. kDF is small, so that sliding friction is
// negligible.
TEST_P(TorsionalFrictionTest, SpinningBoxHasTheFrictionOfAllItsPoints)
{
    constexpr double kSpin = 20, kSpinning = 0.02, kEdge = 0.2, kMass = 4;
    FemWorld world(WorldClass::softRigid, GetParam());
    btSoftBody& slab = addSlab(world);
    slab.m_cfg.kDF = btScalar(1e-3);
    RigidSettings settings;
    settings.m_mass = btScalar(kMass);
    settings.m_transform = at(btScalar(0.01), btScalar(0.02), btScalar(0.5 * kEdge));
    btRigidBody& box = addRigidBox(world, {kEdge, kEdge, kEdge}, settings);
    box.setSpinningFriction(btScalar(kSpinning * 1e3));
    world.step(10);
    box.setAngularVelocity(btVector3(0, 0, btScalar(kSpin)));
    world.step(30);
    const double slowed = 0.5 * kSpinning * kGravity / (kEdge * kEdge / 6);
    EXPECT_NEAR(kSpin - box.getAngularVelocity().z(), slowed, 0.03 * slowed);
}

INSTANTIATE_TEST_SUITE_P(Couplings, TorsionalFrictionTest, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return couplingName(suite.param); });

}  // namespace
}  // namespace bullet_fem
