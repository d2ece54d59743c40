// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kPi = 3.14159265358979323846;

enum class Hold
{
    pin,   // one node
    hinge  // the nodes of an edge along y
};

// A bar fixed at one end, released from the horizontal; swinging bodies use second-order steps.
class Swinging : public testing::TestWithParam<std::tuple<Hold, double, double>>  // Young's modulus [Pa], step [s]
{
protected:
    Swinging()
    {
        m_bar = btFemHelpers::createFromTetMesh(m_world.info(), makeBox({1, 0.2, 0.2}, {5, 1, 1}, {0, -0.1, 0}));
        btFemMaterial material;
        material.m_youngModulus = static_cast<btScalar>(std::get<1>(GetParam()));
        material.m_stiffnessDamping = 0;
        material.m_massDamping = 0;
        material.m_bending = btFemBending::plain;
        m_fem.setMaterial(m_bar, material);
        const bool isPin = std::get<0>(GetParam()) == Hold::pin;
        for (int i = 0; i < m_bar->m_nodes.size(); ++i)
        {
            const btVector3 x = m_bar->m_nodes[i].m_x;
            if (x.x() == 0 && x.z() == 0 && (!isPin || x.y() < 0)) m_bar->setMass(i, 0);
        }
        m_world.addSoft(m_bar);
        for (int i = 0; i < m_bar->m_nodes.size(); ++i)
        {
            if (m_bar->m_nodes[i].m_im == 0) continue;
            const double mass = 1 / double(m_bar->m_nodes[i].m_im);
            const Vec3 x = vec3(m_bar->m_nodes[i].m_x);
            m_inertia += mass * (x.x * x.x + x.z * x.z);
        }
        m_mass = massOf(*m_bar);
        m_start = centerOf(*m_bar);
    }

    // Energy available at the start's height, over that of falling to the lowest point.
    double energy() const
    {
        const double fall = m_start.z + std::hypot(m_start.x, m_start.z);
        return 1 + (motionOf(*m_bar).m_energy / (m_mass * kGravity) + centerOf(*m_bar).z - m_start.z) / fall;
    }

    // Period of a rigid bar about its hinge [s]: 4 K(sin(angle / 2)) sqrt(I / (m g d)), K by the arithmetic-geometric
    // mean.
    double period() const
    {
        const double d = std::hypot(m_start.x, m_start.z), angle = std::atan2(m_start.x, -m_start.z);
        double a = 1, b = std::cos(angle / 2);
        for (int k = 0; k < 20; ++k) std::tie(a, b) = std::make_tuple((a + b) / 2, std::sqrt(a * b));
        return 2 * kPi / a * std::sqrt(m_inertia / (m_mass * kGravity * d));
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem};
    btSoftBody* m_bar = nullptr;
    double m_mass = 0, m_inertia = 0;
    Vec3 m_start;
};

TEST_P(Swinging, GoesOnForTenSeconds)
{
    const double h = std::get<2>(GetParam());
    const bool isFine = h < 0.02;
    double x = centerOf(*m_bar).x, first = 0, last = 0, most = 0;
    int passes = 0;
    for (double t = h; t < 10; t += h)
    {
        m_world.step(1, btScalar(h));
        const double before = x;
        x = centerOf(*m_bar).x;
        most = std::max(most, energy());
        if (before * x > 0) continue;
        last = t - h * std::fabs(x) / std::fabs(x - before);
        if (passes++ == 0) first = last;
    }
    EXPECT_LT(most, 1.03);
    EXPECT_GT(energy(), isFine ? 0.93 : 0.78);
    if (std::get<0>(GetParam()) == Hold::pin) return;  // it swings in all directions
    EXPECT_GE(passes, 8);
    EXPECT_NEAR(2 * (last - first) / (passes - 1), period(), (isFine ? 0.015 : 0.035) * period());
}
INSTANTIATE_TEST_SUITE_P(Bars, Swinging,
                         testing::Combine(testing::Values(Hold::pin, Hold::hinge), testing::Values(1e6, 1e8),
                                          testing::Values(1.0 / 60, 1.0 / 25)),
                         [](const auto& suite)
                         {
                             return std::string(std::get<0>(suite.param) == Hold::pin ? "pin" : "hinge") +
                                    (std::get<1>(suite.param) < 1e7 ? "_1e6_Pa" : "_1e8_Pa") +
                                    (std::get<2>(suite.param) < 0.02 ? "_60_Hz" : "_25_Hz");
                         });

// A stiff, light box of some centimetres on one pin, which rotates by up to half a radian in a step.
class Pendulum : public testing::TestWithParam<std::tuple<double, double>>  // size [m], stiffness damping [s]
{
};

// Apparent strain in damping or in the step shortens the pendulum below and lengthens it above, which pumps it: from .1
// m and .02 s on, it accelerated without bound.
TEST_P(Pendulum, IsNotPumped)
{
    const auto& [size, damping] = GetParam();
    for (const int pin : {0, 3, 5, 10})
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        btSoftBody* box = btFemHelpers::createBox(world.info(), btVector3(0, 0, 0),
                                                  btScalar(size) * btVector3(1, btScalar(0.6), btScalar(0.35)),
                                                  btScalar(0.34 * size));
        btFemMaterial material;
        material.m_youngModulus = btScalar(3.3e7);
        material.m_poissonRatio = btScalar(0.39);
        material.m_density = 72;
        material.m_stiffnessDamping = btScalar(damping);
        fem.setMaterial(box, material);
        ASSERT_LT(pin, box->m_nodes.size());
        box->setMass(pin, 0);
        world.addSoft(box);
        const double weight = massOf(*box) * kGravity, height = centerOf(*box).z;
        for (int k = 0; k < 900; ++k)
        {
            world.step();
            const double gained = motionOf(*box).m_energy + weight * (centerOf(*box).z - height);
            ASSERT_LT(gained, 0.05 * weight * size) << "pin " << pin << ", step " << k;
        }
    }
}

// Young's modulus [Pa], Poisson's ratio, damping [s]
class CaughtInFlight : public testing::TestWithParam<std::tuple<double, double, double>>
{
};

// A node of a flying bar is pinned: the elements there are stretched strongly, and the bar rotates fast. Steps must
// evaluate forces before elements move far: nearly incompressible bars reached up to 20 times their energy.
TEST_P(CaughtInFlight, GainsNoEnergy)
{
    const auto& [young, poisson, damping] = GetParam();
    constexpr double kSpeed = 5;  // [m/s]
    for (const int pin : {0, 13, 20})
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        world.world().setGravity(btVector3(0, 0, 0));
        world.info().m_gravity = btVector3(0, 0, 0);
        btSoftBody* bar = btFemHelpers::createFromTetMesh(
            world.info(), makeBox({0.33, 0.11, 0.147}, {5, 2, 2}, {-0.165, -0.055, -0.0735}));
        btFemMaterial material;
        material.m_youngModulus = btScalar(young);
        ;
        material.m_poissonRatio = btScalar(poisson);
        material.m_density = 316;
        material.m_stiffnessDamping = btScalar(damping);
        fem.setMaterial(bar, material);
        bar->setVelocity(btVector3(0, 0, btScalar(-kSpeed)));
        world.addSoft(bar);
        world.step();
        const double energy = motionOf(*bar).m_energy;
        bar->setMass(pin, 0);
        double most = 0;
        for (int k = 0; k < 300; ++k)
        {
            world.step();
            most = std::max(most, motionOf(*bar).m_energy);
        }
        EXPECT_LT(most, 1.01 * energy) << "pin " << pin;
    }
}

INSTANTIATE_TEST_SUITE_P(Bars, CaughtInFlight,
                         testing::Combine(testing::Values(1e5, 5.8e6), testing::Values(0.3, 0.4868),
                                          testing::Values(0, 0.005, 0.0167, 0.05)));

INSTANTIATE_TEST_SUITE_P(Boxes, Pendulum, testing::Combine(testing::Values(0.05, 0.1), testing::Values(0, 0.02, 0.08)));

}  // namespace
}  // namespace bullet_fem
