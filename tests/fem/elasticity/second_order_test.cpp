// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Steps with less numerical damping than implicit Euler, against the laws of docs/theory.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

bool atStart(const Vec3& X)
{
    return X.x == 0;
}

TetMesh swingingBar()
{
    return makeBox({1, .1, .1}, {10, 1, 1});
}

Body bodyOf(const TetMesh& mesh, double young, const StepSettings& settings, const NodePredicate& fixed = {})
{
    const Material material = elasticMaterial(young, .3);
    return makeBody(mesh, material, fixed, factorStep(settings.m_step, settings.m_numericalDamping, material));
}

// The discrete law of a mode of omega h = y: asymptotically each step multiplies (omega x, v) by this complex number.
struct Law
{
    double m_amplitude, m_phase;  // [-], [rad] a step
};

// `smoothed`: the step damps vibrations that it does not resolve, by the coefficient d.
Law lawOf(double y, double s, bool smoothed)
{
    const double k = y * y, c = 0.375 + 0.625 * s, d = smoothed ? 0.75 * (1 - s) : 0, theta = 0.5 * (1 + s);
    const double D = 1 + c * k, left = 1 - d * c * k / D;
    // dv = -k (y_kick / h + s v) / D; x+ / h = x / h + (1 - theta) v + theta (v + dv); v+ = v + left dv.
    const double a = -k / D, b = -k / D * (1 - theta + s);
    const double xx = 1 + theta * a, xv = 1 + theta * b, vx = left * a, vv = 1 + left * b;
    const double determinant = xx * vv - xv * vx, trace = xx + vv;
    return {std::sqrt(determinant), std::acos(0.5 * trace / std::sqrt(determinant))};
}

struct Swing
{
    const char* m_name;
    double m_phaseStep;  // omega h [rad]
    double m_damping;    // s [-]
};

class SecondOrderVibration : public testing::TestWithParam<Swing>
{
};

// The lowest bending mode of a clamped bar: its amplitude decay and its frequency.
TEST_P(SecondOrderVibration, FollowsItsLaw)
{
    const Swing& p = GetParam();
    const Mode mode = LinearSystem(RestShape(swingingBar(), elasticMaterial(1e6, .3)), atStart).lowestModes(1).front();
    StepSettings settings;
    settings.m_step = p.m_phaseStep / mode.m_omega;
    settings.m_tolerance = 1e-9;
    settings.m_numericalDamping = p.m_damping;
    Body body = bodyOf(swingingBar(), 1e6, settings, atStart);
    BodyState& s = body.m_state;
    const std::vector<Vec3> X = s.m_x;
    const double amplitude = 1e-4;
    for (std::size_t i = 0; i < X.size(); ++i) s.m_x[i] += amplitude * mode.m_shape[i];
    const int n = 200;
    double largest = 0;  // of the last period
    double crossings = 0, previous = 1, first = -1, last = -1;
    for (int k = 0; k < n; ++k)
    {
        step(body, settings);
        double part = 0;
        for (std::size_t i = 0; i < X.size(); ++i) part += s.m_mass[i] * dot(mode.m_shape[i], s.m_x[i] - X[i]);
        if (part * previous < 0)
        {
            last = k + part / (previous - part);
            if (first < 0) first = last;
            crossings += 1;
        }
        previous = part;
        if (k >= n - static_cast<int>(2 * 3.1416 / p.m_phaseStep) - 1) largest = std::max(largest, std::fabs(part));
    }
    const Law most = lawOf(p.m_phaseStep, p.m_damping, true), least = lawOf(p.m_phaseStep, p.m_damping, false);
    const double kept = largest / amplitude;
    EXPECT_LE(kept, 1.01 * std::pow(least.m_amplitude, n - 2 * 3.1416 / p.m_phaseStep - 2));
    EXPECT_GE(kept, 0.97 * std::pow(most.m_amplitude, n));
    ASSERT_GT(crossings, 2);
    const double phase = 3.14159265358979 * (crossings - 1) / (last - first);
    EXPECT_GE(phase, 0.999 * std::min(most.m_phase, least.m_phase));
    EXPECT_LE(phase, 1.001 * std::max(most.m_phase, least.m_phase));
}

std::string swingName(const testing::TestParamInfo<Swing>& info)
{
    return info.param.m_name;
}
INSTANTIATE_TEST_SUITE_P(Steps, SecondOrderVibration,
                         testing::Values(Swing{"Fine", .1, 0}, Swing{"Usual", .2, 0}, Swing{"Coarse", .6, 0},
                                         Swing{"SomeDamping", .2, .1}, Swing{"HalfDamping", .2, .5},
                                         Swing{"Euler", .2, 1}),
                         swingName);

// A vibration of 1.7 Hz at 60 Hz: implicit Euler would halve it in .74 s.
TEST(SecondOrder, SwingsForTenSeconds)
{
    const Mode mode = LinearSystem(RestShape(swingingBar(), elasticMaterial(1e6, .3)), atStart).lowestModes(1).front();
    StepSettings settings;
    settings.m_numericalDamping = 0;
    settings.m_step = 2 * 3.14159265358979 * 1.7 / mode.m_omega / 60;
    Body body = bodyOf(swingingBar(), 1e6, settings, atStart);
    BodyState& s = body.m_state;
    for (std::size_t i = 0; i < s.m_x.size(); ++i) s.m_x[i] += 0.02 * mode.m_shape[i];
    const double start = mechanicalEnergy(body);
    for (int k = 0; k < 600; ++k)
    {
        step(body, settings);
        EXPECT_LE(mechanicalEnergy(body), 1.01 * start);
    }
    EXPECT_GE(mechanicalEnergy(body), 0.8 * start);  // amplitude .9
}

// Node positions of a bar after a quarter of a second of free vibration under its weight, with step h.
std::vector<Vec3> after(double h, double stretch, double damping)
{
    StepSettings settings;
    settings.m_step = h;
    settings.m_tolerance = 1e-9;
    settings.m_numericalDamping = damping;
    const auto fixed = [stretch](const Vec3& X) { return X.x == 0 || (stretch > 1 && X.x == 1); };
    StepSettings toRest;
    toRest.m_tolerance = 1e-9;
    Body resting = bodyOf(swingingBar(), 1e5, toRest, fixed);
    for (Vec3& x : resting.m_state.m_x) x.x *= stretch;
    for (int k = 0; k < 600 && stretch > 1; ++k) bullet_fem::step(resting, toRest);
    Body body = bodyOf(swingingBar(), 1e5, settings, fixed);
    body.m_state.m_x = resting.m_state.m_x;
    setGravity(body, {0, 0, -1});
    const int n = static_cast<int>(std::lround(0.25 / h));
    for (int k = 0; k < n; ++k) step(body, settings);
    return body.m_state.m_x;
}

struct Order
{
    double m_stretch, m_damping, m_min, m_max;
};

class OrderOfConvergence : public testing::TestWithParam<Order>
{
};

TEST_P(OrderOfConvergence, IsTwoWithoutNumericalDampingAndOneWithAll)
{
    const Order& p = GetParam();
    const std::vector<Vec3> exact = after(1.0 / 7680, p.m_stretch, 0);
    const double coarse = largestDistance(after(1.0 / 240, p.m_stretch, p.m_damping), exact);
    const double fine = largestDistance(after(1.0 / 480, p.m_stretch, p.m_damping), exact);
    const double order = std::log2(coarse / fine);
    EXPECT_GE(order, p.m_min);
    EXPECT_LE(order, p.m_max);
}

INSTANTIATE_TEST_SUITE_P(Bars, OrderOfConvergence,
                         testing::Values(Order{1, 0, 1.8, 2.3}, Order{1.3, 0, 1.6, 2.4}, Order{1, 1, .8, 1.2},
                                         Order{1.3, 1, .6, 1.2}));

// A freely spinning bar: velocities of rigid rotation are no strain.
TEST(SecondOrder, SpinsWithoutGainOfEnergy)
{
    for (const double spin : {3.0, 6.0, 12.0})
        for (const double young : {1e5, 1e6})
        {
            StepSettings settings;
            settings.m_numericalDamping = 0;
            Body body = bodyOf(makeBox({1, .3, .2}, {5, 2, 1}, {-.5, -.15, -.1}), young, settings);
            BodyState& s = body.m_state;
            for (std::size_t i = 0; i < s.m_x.size(); ++i) s.m_v[i] = cross({0, spin, 0.3 * spin}, s.m_x[i]);
            const double energy = mechanicalEnergy(body);
            const Vec3 L = angularMomentum(s);
            double largest = 0;
            for (int k = 0; k < 300; ++k)
            {
                step(body, settings);
                largest = std::max(largest, mechanicalEnergy(body));
            }
            EXPECT_LE(largest, 1.001 * energy) << spin << " rad/s, " << young << " Pa";
            EXPECT_GE(mechanicalEnergy(body), 0.85 * energy) << spin << " rad/s, " << young << " Pa";
            EXPECT_LE(norm(angularMomentum(s) - L), 1e-12 * norm(L));
        }
}

// A stiff bar that spins freely about its shortest axis keeps its length and so, by its momentum, its energy. The
// apparent strain of nodes that move along chords would change it: by (omega h)^2 / 8 [-], and by omega^2 h beta / 2
// with material damping, which beyond .08 would grow without bound.
class SecondOrderSpin : public testing::TestWithParam<double>
{
};

TEST_P(SecondOrderSpin, KeepsTheLengthOfStiffBars)
{
    for (const double spin : {6.0, 11.0, 20.0})
        for (const ElasticLaw law : {ElasticLaw::hooke, ElasticLaw::neoHooke})
        {
            StepSettings settings;
            settings.m_numericalDamping = 0;
            Material material = elasticMaterial(1e9, .3);
            material.m_stiffnessDamping = GetParam();
            material.m_law = law;
            const TetMesh bar = makeBox({1, .3, .2}, {5, 2, 1}, {-.5, -.15, -.1});
            Body body = makeBody(bar, material, {}, factorStep(settings.m_step, 0, material));
            BodyState& s = body.m_state;
            for (std::size_t i = 0; i < s.m_x.size(); ++i) s.m_v[i] = cross({0, 0, spin}, s.m_x[i]);
            const double start = kineticEnergy(s), length = norm(s.m_x.back() - s.m_x.front());
            // The remaining error is of fourth order in the angle of a step, and grows with the damping.
            const double left = std::pow(spin * settings.m_step, 4) * (1 + GetParam() / settings.m_step);
            for (int k = 0; k < 600; ++k)
            {
                step(body, settings);
                ASSERT_NEAR(norm(s.m_x.back() - s.m_x.front()) / length, 1, 1.2 * left) << spin << " rad/s, step " << k;
                ASSERT_LE(kineticEnergy(s), (1 + 1e-6) * start) << spin << " rad/s, step " << k;
            }
            EXPECT_GE(kineticEnergy(s) / start, 1 - 2.4 * left) << spin << " rad/s";
        }
}

INSTANTIATE_TEST_SUITE_P(Damping, SecondOrderSpin, testing::Values(0, 0.005, 0.1));

// Strips stretched to twice their length with initial velocities, and cubes with random node positions.
TEST(SecondOrder, ComesToRestFromViolentMotion)
{
    StepSettings settings;
    settings.m_numericalDamping = 0;
    RandomVectors random(5);
    for (const double stretch : {1.5, 2.0})
    {
        Body strip = bodyOf(swingingBar(), 1e7, settings, [](const Vec3& X) { return X.x == 0 || X.x == 1; });
        BodyState& s = strip.m_state;
        for (std::size_t i = 0; i < s.m_x.size(); ++i)
        {
            s.m_x[i].x *= stretch;
            if (!s.m_fixed[i]) s.m_v[i] = 0.5 * random.next();
        }
        const double energy = mechanicalEnergy(strip), kinetic = kineticEnergy(s);
        for (int k = 0; k < 300; ++k)
        {
            step(strip, settings);
            ASSERT_LE(mechanicalEnergy(strip), energy + 0.01 * kinetic) << stretch;
        }
        EXPECT_LE(kineticEnergy(s), 1e-9 * kinetic) << stretch;
    }
    for (const double young : {1e5, 1e7})
    {
        Body cube = bodyOf(makeBox({1, 1, 1}, {3, 3, 3}), young, settings);
        for (Vec3& x : cube.m_state.m_x) x = 0.5 * random.next();
        const double energy = mechanicalEnergy(cube);
        for (int k = 0; k < 300; ++k)
        {
            step(cube, settings);
            ASSERT_LE(mechanicalEnergy(cube), energy) << young;
        }
        EXPECT_LE(mechanicalEnergy(cube), 0.01 * energy) << young;
    }
}

// The equilibrium of a damped bar under its weight does not depend on the step.
TEST(SecondOrder, RestsAtTheEulerEquilibrium)
{
    std::vector<Vec3> rest[2];
    for (const double damping : {0.0, 1.0})
    {
        StepSettings settings;
        settings.m_tolerance = 1e-9;
        settings.m_numericalDamping = damping;
        Material material = elasticMaterial(1e6, .3);
        material.m_massDamping = 20;
        Body body = makeBody(swingingBar(), material, atStart, factorStep(settings.m_step, damping, material));
        setGravity(body, {0, 0, -9.81});
        for (int k = 0; k < 1000; ++k) step(body, settings);
        rest[static_cast<int>(damping)] = body.m_state.m_x;
    }
    EXPECT_LE(largestDistance(rest[0], rest[1]), 1e-8);
}

}  // namespace
}  // namespace bullet_fem
