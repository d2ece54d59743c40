// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// No step creates more energy than the body has and is given. A bar of 2 x .1 x .1 m whose end swings
// by a quarter of its length within a step is stretched along chords, by several times its energy if it is stiff.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/body/step_scratch.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

constexpr double kStep = 1.0 / 60;  // [s]
constexpr double kLength = 2;       // [m]
constexpr double kMaxGain = 0.5;    // [-]
constexpr double kGravity = 9.81;   // [m/s2]

Body makeBar(double young, const NodePredicate& fixed = {})
{
    return makeBody(makeBox({kLength, .1, .1}, {40, 2, 2}), elasticMaterial(young, .3), fixed, kStep);
}

// Gives free nodes the velocity z of a bending bar with an end that moves at `speed` [m/s].
void giveBendingVelocity(Body& body, double speed)
{
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
    {
        const double x = body.m_state.m_x[i].x / kLength;
        if (!body.m_state.m_fixed[i]) body.m_state.m_v[i] = {0, 0, speed * x * x};
    }
}

bool isClamped(const Vec3& X)
{
    return X.x == 0;
}

// Returns whether the step was shortened.
bool stepOnce(Body& body, double numericalDamping = 1)
{
    StepSettings settings;
    settings.m_step = kStep;
    settings.m_numericalDamping = numericalDamping;
    solveFreeMotion(body, settings);
    StepEnd end = {&body, settings};
    finishSteps(&end, 1);
    return end.m_isShortened;
}

TEST(EnergyLimit, BoundsTheGainOfAFastSwing)
{
    for (const double damping : {0.0, 1.0})
    {
        Body body = makeBar(1e9, isClamped);
        giveBendingVelocity(body, 30);
        const double before = mechanicalEnergy(body);
        EXPECT_TRUE(stepOnce(body, damping));
        EXPECT_LE(mechanicalEnergy(body), (1 + kMaxGain) * before * (1 + 1e-9)) << damping;
        EXPECT_GT(mechanicalEnergy(body), .01 * before) << damping;  // it still swings
    }
}

TEST(EnergyLimit, LeavesSlowSwingsAlone)
{
    for (const double speed : {0.0, 1e-6, .1, 1.0})
    {
        Body body = makeBar(1e9, isClamped);
        giveBendingVelocity(body, speed);
        EXPECT_FALSE(stepOnce(body)) << speed;
    }
    Body soft = makeBar(1e6, isClamped);
    giveBendingVelocity(soft, 30);
    EXPECT_FALSE(stepOnce(soft));
}

TEST(EnergyLimit, KeepsMomenta)
{
    Body body = makeBar(1e9);
    body.m_loads.m_isHeld = true;
    giveBendingVelocity(body, 60);
    const Vec3 linear = linearMomentum(body.m_state), angular = angularMomentum(body.m_state);
    EXPECT_TRUE(stepOnce(body));
    EXPECT_LT(norm(linearMomentum(body.m_state) - linear), 1e-12 * norm(linear));
    EXPECT_LT(norm(angularMomentum(body.m_state) - angular), 1e-12 * norm(angular));
}

// Impulses of contacts act beside the nodes: their couples are no impulses on nodes.
TEST(EnergyLimit, KeepsTheCouplesOfContacts)
{
    for (const bool isPinned : {false, true})
    {
        const auto pin = [isPinned](const Vec3& X) { return isPinned && norm(X) == 0; };
        Body body = makeBar(1e9, pin);
        body.m_loads.m_isHeld = true;
        giveBendingVelocity(body, 60);
        const Vec3 before = angularMomentum(body.m_state), couple = {1, 200, -100};
        StepSettings settings;
        settings.m_step = kStep;
        settings.m_numericalDamping = 0;
        solveFreeMotion(body, settings);
        StepScratch& scratch = body.m_workspace.scratch();
        scratch.m_momentum.addAngularImpulse(body, 1, couple, kStep);
        scratch.m_momentum.restore(body, scratch.m_velocity);
        StepEnd end = {&body, settings};
        finishSteps(&end, 1);
        EXPECT_TRUE(end.m_isShortened);
        EXPECT_LT(norm(angularMomentum(body.m_state) - before - couple), 1e-9 * norm(couple)) << isPinned;
    }
}

// The work of impulses and loads counts: a bar at rest may take it as kinetic energy.
TEST(EnergyLimit, CountsTheWorkOfImpulsesAndLoads)
{
    for (const bool byLoads : {false, true})
    {
        Body body = makeBar(1e6, isClamped);
        std::vector<Vec3> impulses(body.m_state.m_x.size());
        for (std::size_t i = 0; i < impulses.size(); ++i)
            impulses[i] = {0, 0, 5 * body.m_state.m_mass[i] * body.m_state.m_x[i].x};
        for (std::size_t i = 0; i < impulses.size() && byLoads; ++i) body.m_loads.m_force[i] = 1 / kStep * impulses[i];
        StepSettings settings;
        settings.m_step = kStep;
        solveFreeMotion(body, settings);
        if (!byLoads) applyImpulses(body, impulses, settings);
        StepEnd end = {&body, settings};
        finishSteps(&end, 1);
        EXPECT_FALSE(end.m_isShortened) << byLoads;
        EXPECT_GT(mechanicalEnergy(body), 10) << byLoads;
    }
}

// Energy of a body, its potential energy in gravity included [J].
double energyInGravity(const Body& body)
{
    double energy = mechanicalEnergy(body);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        energy += kGravity * body.m_state.m_mass[i] * body.m_state.m_x[i].z;
    return energy;
}

// Bodies of two cells hang on one of their corners. Their weight strains elements there several times, or turns them
// inside out.
TEST(EnergyLimit, BoundsTheGainOfDistortedElements)
{
    const TetMesh mesh = makeBox({.4, .2, .2}, {2, 1, 1});
    const double weight = kGravity * .4 * .2 * .2 * 1000;
    for (const ElasticLaw law : {ElasticLaw::hooke, ElasticLaw::neoHooke})
        for (const double beta : {1e-5, 1e-3, 1e-2})
            for (const Vec3& pin : mesh.restPositions())
                for (const double damping : {0.0, 1.0})
                {
                    Material material = elasticMaterial(law == ElasticLaw::hooke ? 3e3 : 1e3, .4);
                    material.m_law = law;
                    material.m_bending = Bending::accurate;
                    material.m_stiffnessDamping = beta;
                    Body body = makeBody(
                        mesh, material, [&](const Vec3& X) { return norm(X - pin) == 0; }, kStep);
                    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
                        body.m_loads.m_force[i] = {0, 0, -kGravity * body.m_state.m_mass[i]};
                    const double start = energyInGravity(body);
                    double most = 0;
                    for (int k = 0; k < 300; ++k)
                    {
                        stepOnce(body, damping);
                        most = std::max(most, energyInGravity(body) - start);
                    }
                    EXPECT_LT(most, .01 * weight * .4) << "beta " << beta << ", damping " << damping << ", " << pin.x;
                }
}

// Moving pins do work that is not known.
TEST(EnergyLimit, IsNotForMovingPins)
{
    Body body = makeBar(1e9, isClamped);
    giveBendingVelocity(body, 30);
    for (Vec3& target : body.m_loads.m_targetVelocity) target = {0, 0, 1e-3};
    EXPECT_FALSE(stepOnce(body));
}

}  // namespace
}  // namespace bullet_fem
