// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kRadius = 0.25;  // of the balls [m]

struct BallMaterial
{
    double m_youngModulus, m_stiffnessDamping;  // [Pa], [s]
};

btSoftBody& addBall(FemWorld& world, const BallMaterial& ball, const btVector3& center)
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(world.info(), makeSphere(kRadius, 8));
    body->translate(center);
    btFemMaterial material;
    material.m_youngModulus = btScalar(ball.m_youngModulus);
    material.m_density = 1000;
    material.m_stiffnessDamping = btScalar(ball.m_stiffnessDamping);
    world.fem().setMaterial(body, material);
    body->m_cfg.kDF = btScalar(0.8);
    return world.addSoft(body);
}

/// Sets the velocities of rolling along x without slip.
void roll(btSoftBody& ball, double speed)
{
    const Vec3 center = centerOf(ball);
    for (int i = 0; i < ball.m_nodes.size(); ++i)
    {
        const double height = ball.m_nodes[i].m_x.z() - center.z, ahead = ball.m_nodes[i].m_x.x() - center.x;
        ball.m_nodes[i].m_v =
            btVector3(btScalar(speed * (1 + height / kRadius)), 0, btScalar(-speed * ahead / kRadius));
    }
}

struct Descent
{
    double m_degrees, m_youngModulus;
    double m_converged;  // speed after six seconds in steps of 1/1920 s [m/s]
    double m_min;        // its minimum share at 60 Hz
    bool m_isStiff;      // slowed little by damping

    // Steps along chords widen a ball that turns by a step's angle w h by (w h)^2 / 2, and it rolls down faster by as
    // much; damping slows soft balls, and steps of .6 rad slow all.
    double most() const
    {
        const double angle = m_converged / kRadius * kStep;
        return m_isStiff && angle < 0.5 ? 1 + angle * angle / 2 : 1;
    }
};

class Incline : public testing::TestWithParam<std::tuple<Coupling, Descent>>
{
};

// A rigid sphere has 7.30 and 14.4 m/s after six seconds; a soft one is slowed by its damping. Contact must act at the
// position at the end of the step: v h behind, the ball would have 2.17 and 4.82 m/s.
TEST_P(Incline, IsRolledDownAsFastAsWithSmallSteps)
{
    const auto& [coupling, descent] = GetParam();
    const double angle = descent.m_degrees * std::acos(-1) / 180;
    FemWorld world(WorldClass::softRigid, coupling,
                   btVector3(btScalar(kGravity * std::sin(angle)), 0, btScalar(-kGravity * std::cos(angle))));
    world.addPlane();
    btSoftBody& ball = addBall(world, {descent.m_youngModulus, 0.005}, {0, 0, btScalar(kRadius + 1e-4)});
    world.step(360);
    EXPECT_GT(velocityOf(ball).x, descent.m_min * descent.m_converged);
    EXPECT_LT(velocityOf(ball).x, descent.most() * descent.m_converged);
}

INSTANTIATE_TEST_SUITE_P(
    Rolling, Incline,
    testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                     testing::Values(Descent{10, 1e5, 4.421, 0.94, false}, Descent{10, 1e6, 5.305, 0.96, true},
                                     Descent{10, 1e7, 5.831, 0.96, true}, Descent{20, 1e5, 8.744, 0.92, false},
                                     Descent{20, 1e6, 11.41, 0.87, true}, Descent{20, 1e7, 12.794, 0.78, true})),
    [](const auto& suite)
    {
        const Descent& descent = std::get<1>(suite.param);
        return std::string(couplingName(std::get<0>(suite.param))) + "_" + std::to_string(int(descent.m_degrees)) +
               "_1e" + std::to_string(int(std::lround(std::log10(descent.m_youngModulus))));
    });

class Rolling : public testing::TestWithParam<Coupling>
{
protected:
    /// Runs a second of a ball pressed against another body, without other contacts.
    template <class Other>
    static void expectAngularMomentumKept(FemWorld& world, const btSoftBody& ball, const Other& other)
    {
        constexpr double kChange = 1e-5;  // about the origin, of the ball's linear momentum times its radius [-]
        Motion start = motionOf(ball);
        const double size = kRadius * norm(start.m_linear);
        start += motionOf(other);
        double worst = 0, pushed = 0;
        for (int k = 0; k < 60; ++k)
        {
            world.step();
            Motion now = motionOf(ball);
            now += motionOf(other);
            worst = std::max(worst, norm(now.m_angular - start.m_angular) / size);
            pushed = std::max(pushed, norm(impulseOn(world.fem(), ball, &other)));
        }
        EXPECT_GT(pushed, 1);
        EXPECT_LT(worst, kChange);
    }
};

TEST_P(Rolling, LosesNoMoreOnTheFlatThanWithSmallSteps)
{
    FemWorld world(WorldClass::softRigid, GetParam());
    world.addPlane();
    btSoftBody& ball = addBall(world, {1e6, 0.005}, {0, 0, btScalar(kRadius)});
    roll(ball, 1);
    world.step(120);
    EXPECT_GT(velocityOf(ball).x, 0.98 * 0.751);  // the speed in steps of 1/1920 s
}

// Its nodes move along chords of angle w h, which damping must not treat as strain: the ball would be 24 % wider with
// .1 s. The remainder is the length of implicit Euler's chords, (w h)^2 / 2 = 5.6 %, and the ball's bulge at the
// ground.
TEST_P(Rolling, DoesNotWidenWithStrongDamping)
{
    for (const double stiffnessDamping : {0.005, 0.02, 0.05, 0.1})
    {
        FemWorld world(WorldClass::softRigid, GetParam());
        world.addPlane();
        btSoftBody& ball = addBall(world, {1e6, stiffnessDamping}, {0, 0, btScalar(kRadius)});
        roll(ball, 5);
        double widest = 0;
        for (int k = 0; k < 60; ++k)
        {
            world.step();
            const Vec3 center = centerOf(ball);
            for (int i = 0; i < ball.m_nodes.size(); ++i)
                widest = std::max(widest, norm(vec3(ball.m_nodes[i].m_x) - center));
        }
        EXPECT_LT(widest, 1.075 * kRadius) << "stiffness damping " << stiffnessDamping << " s";
    }
}

// An isolated pair: the ball pushes the block back. The block is a cube, because Bullet's gyroscopic term for other
// bodies does not conserve momentum.
TEST_P(Rolling, KeepsTheAngularMomentumOnAFreeBlock)
{
    FemWorld world(WorldClass::softRigid, GetParam(), btVector3(0, 0, 0));
    btSoftBody& ball = addBall(world, {1e6, 0.005}, {0, 0, btScalar(kRadius - 1e-3)});
    roll(ball, 2);
    RigidSettings settings;
    settings.m_mass = 200;
    settings.m_transform = at(0, 0, -1);
    settings.m_velocity = btVector3(0, 0, btScalar(0.5));  // they press on each other
    btRigidBody& block = addRigidBox(world, {2, 2, 2}, settings);
    expectAngularMomentumKept(world, ball, block);
}

TEST_P(Rolling, KeepsTheAngularMomentumOnAFreeSoftSlab)
{
    FemWorld world(WorldClass::softRigid, GetParam(), btVector3(0, 0, 0));
    btSoftBody& ball = addBall(world, {1e6, 0.005}, {0, 0, btScalar(kRadius - 1e-3)});
    roll(ball, 2);
    SoftBox box;
    box.m_size = {2, 1, 0.2};
    box.m_cells = {20, 10, 2};
    box.m_center = {0, 0, -0.1};
    btSoftBody& slab = addSoftBox(world, world.fem(), box);
    slab.setVelocity(btVector3(0, 0, btScalar(0.5)));
    expectAngularMomentumKept(world, ball, slab);
}

INSTANTIATE_TEST_SUITE_P(Couplings, Rolling, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return couplingName(suite.param); });

}  // namespace
}  // namespace bullet_fem
