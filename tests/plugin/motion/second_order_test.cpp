// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies in steps without numerical damping in Bullet worlds: bouncing, rolling and resting. Free motion is tested in
// tests/fem.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kBall = 0.25;  // of the balls [m]

btFemSolverInfo secondOrder()
{
    btFemSolverInfo info;
    info.m_numericalDamping = info.m_contactDamping = 0;
    return info;
}

btFemMaterial rubber(double young, double stiffnessDamping)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(young);
    material.m_density = 1000;
    material.m_stiffnessDamping = btScalar(stiffnessDamping);
    return material;
}

btSoftBody& addRubberBall(FemWorld& world, double young, double stiffnessDamping, double height)
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(world.info(), makeSphere(kBall, 6));
    body->translate({0, 0, btScalar(height)});
    world.fem().setMaterial(body, rubber(young, stiffnessDamping));
    body->m_cfg.kDF = btScalar(0.5);
    return world.addSoft(body);
}

struct RubberDrop
{
    double m_youngModulus, m_rate;  // [Pa], steps per second
    double m_min, m_max;            // limits of rebound speed over impact speed [-]
};

void PrintTo(const RubberDrop& drop, std::ostream* stream)
{
    *stream << drop.m_youngModulus << " Pa at " << drop.m_rate << " Hz";
}

class SecondOrderDrop : public testing::TestWithParam<std::tuple<Coupling, RubberDrop>>
{
};

// Undamped rubber balls dropped from a metre rebound with .82, .97 and .99 of their speed in steps of 1/1920 s.
// Implicit Euler at 60 Hz gives .32, .19 and .06, and .35 for the stiffest at 240 Hz, without elastic rebounds.
TEST_P(SecondOrderDrop, ReboundsWithTheExpectedShareOfTheSpeed)
{
    const auto& [coupling, drop] = GetParam();
    for (const double later : {0.01, 0.035, 0.06})
    {
        btFemSolverInfo info = secondOrder();
        info.m_elasticRebound = false;
        FemWorld world(WorldClass::softRigid, coupling, {0, 0, btScalar(-kGravity)}, info);
        btRigidBody& floor = world.addFloorBox();
        btSoftBody& ball = addRubberBall(world, drop.m_youngModulus, 0, kBall + 1 + later);
        const double h = 1 / drop.m_rate, impact = std::sqrt(2 * kGravity * (1 + later));
        int touched = 0, parted = 0;
        double lowest = 0;
        for (int k = 0; k < 3 * drop.m_rate && parted < 3; ++k)
        {
            world.step(1, btScalar(h));
            const bool touches = world.fem().contactForce(&ball, &floor).z() > 0;
            touched += touches;
            parted = touches || touched == 0 ? 0 : parted + 1;
            lowest = std::min(lowest, lowestHeight(ball));
        }
        const double returns = (velocityOf(ball).z + kGravity * h * parted) / impact;
        EXPECT_GE(returns, drop.m_min) << later;
        EXPECT_LE(returns, drop.m_max) << later;
        EXPECT_GT(lowest, -0.002) << later;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Balls, SecondOrderDrop,
    testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                     testing::Values(RubberDrop{1e5, 60, 0.6, 0.81}, RubberDrop{1e6, 60, 0.62, 0.9},
                                     RubberDrop{1e7, 60, 0.3, 0.85}, RubberDrop{1e7, 240, 0.8, 1})));

/// Minimum and maximum deflection of the free end of a clamped bar within a second [m], under its weight from the
/// start.
std::pair<double, double> swing(FemWorld& world, btSoftBody& bar, int node)
{
    double least = 1e30, most = -1e30;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        least = std::min(least, double(bar.m_nodes[node].m_x.z()));
        most = std::max(most, double(bar.m_nodes[node].m_x.z()));
    }
    return {least, most};
}

// Implicit Euler halves a vibration of 1.7 Hz in .75 s. Contact has its own damping, which does not act on bodies
// without contact by default.
TEST(SecondOrderInTheAir, KeepsSwingingDespiteContactDamping)
{
    FemWorld world(WorldClass::softRigid);
    btSoftBody* bar = btFemHelpers::createBox(world.info(), {0, 0, 0}, {2, .2f, .2f}, .1f);
    world.fem().setMaterial(bar, rubber(4e7, 0));
    int end = 0;
    for (int i = 0; i < bar->m_nodes.size(); ++i)
    {
        if (bar->m_nodes[i].m_x.x() < -0.999) bar->setMass(i, 0);
        if (bar->m_nodes[i].m_x.x() > bar->m_nodes[end].m_x.x()) end = i;
    }
    world.addSoft(bar);
    const auto first = swing(world, *bar, end);
    world.step(240);
    const auto later = swing(world, *bar, end);
    EXPECT_GT(later.second - later.first, 0.9 * (first.second - first.first));
}

// The contact damping acts from the step after the first contact: a ball that returns .69 of its speed without any
// returns implicit Euler's .2.
TEST(SecondOrderInTheAir, ReboundsByTheContactDamping)
{
    double returned[2] = {0, 0};
    for (const int damping : {0, 1})
    {
        btFemSolverInfo info;
        info.m_contactDamping = btScalar(damping);
        info.m_elasticRebound = false;
        FemWorld world(WorldClass::softRigid, Coupling::swap, {0, 0, btScalar(-kGravity)}, info);
        world.addFloorBox();
        btSoftBody& ball = addRubberBall(world, 1e6, 0, kBall + 1);
        for (int k = 0; k < 60; ++k)
        {
            world.step();
            returned[damping] = std::max(returned[damping], velocityOf(ball).z / std::sqrt(2 * kGravity));
        }
    }
    EXPECT_GT(returned[0], 0.6);
    EXPECT_LT(returned[1], 0.45);
}

// Down ten degrees, as in rolling_test.cpp: contact acts at the position at the end of the step.
TEST(SecondOrderRolling, IsAsFastAsWithSmallSteps)
{
    struct Slope
    {
        double m_youngModulus, m_converged;  // [Pa], speed after six seconds in steps of 1/1920 s [m/s]
    };
    for (const Slope& descent : {Slope{1e5, 4.359}, Slope{1e6, 5.112}})
    {
        const double angle = std::acos(-1) / 18;
        const btVector3 gravity(btScalar(kGravity * std::sin(angle)), 0, btScalar(-kGravity * std::cos(angle)));
        FemWorld world(WorldClass::softRigid, Coupling::swap, gravity, secondOrder());
        world.addPlane();
        btSoftBody& ball = addRubberBall(world, descent.m_youngModulus, 0.005, kBall + 1e-4);
        ball.m_cfg.kDF = btScalar(0.8);
        world.step(360);
        EXPECT_NEAR(velocityOf(ball).x / descent.m_converged, 1, 0.06) << descent.m_youngModulus;
    }
}

// The contact force of a resting cube is its weight, and it is as still as with implicit Euler.
TEST(SecondOrderRest, CarriesTheWeight)
{
    for (const Coupling coupling : {Coupling::swap, Coupling::coupled})
    {
        btFemSolverInfo info = secondOrder();
        info.m_elasticRebound = false;
        FemWorld world(WorldClass::softRigid, coupling, {0, 0, btScalar(-kGravity)}, info);
        btRigidBody& floor = world.addFloorBox();
        btSoftBody* cube = btFemHelpers::createBox(world.info(), {0, 0, btScalar(0.26)}, {.25f, .25f, .25f}, .125f);
        world.fem().setMaterial(cube, rubber(1e6, 0.01));
        world.addSoft(cube);
        cube->setActivationState(DISABLE_DEACTIVATION);
        world.step(300);
        const double weight = massOf(*cube) * kGravity;
        EXPECT_NEAR(world.fem().contactForce(cube, &floor).z(), weight, 1e-4 * weight);
        EXPECT_LT(fastestNode(*cube), 3e-5);
    }
}

// Two free balls in an eccentric impact.
TEST(SecondOrderMomentum, IsKeptInCollisions)
{
    FemWorld world(WorldClass::softRigid, Coupling::swap, {0, 0, 0}, secondOrder());
    btSoftBody& a = addRubberBall(world, 1e6, 0, 0);
    btSoftBody& b = addRubberBall(world, 1e6, 0, 2.2 * kBall);
    for (btSoftBody* ball : {&a, &b})
    {
        ball->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        ball->setActivationState(DISABLE_DEACTIVATION);
    }
    a.setVelocity({btScalar(0.2), 0, 2});
    b.setVelocity({0, btScalar(0.3), -1});
    const Motion before[2] = {motionOf(a), motionOf(b)};
    world.step(60);
    const Motion after[2] = {motionOf(a), motionOf(b)};
    const auto gained = [&](Vec3 Motion::*of) { return after[0].*of + after[1].*of - before[0].*of - before[1].*of; };
    const double size = norm(before[0].m_linear);
    EXPECT_GT(velocityOf(b).z, 0.5);  // they were in contact
    EXPECT_LT(norm(gained(&Motion::m_linear)), 1e-5 * size);
    EXPECT_LT(norm(gained(&Motion::m_angular)), 1e-5 * size * kBall);
}

}  // namespace
}  // namespace bullet_fem
