// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Ogden's law against its formula, Treloar's rubber and the Neo-Hookean law.
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/fem/step/stress.h"
#include "fem/laws/law_cases.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

// Ogden's constants for Treloar's rubber, 6.3, .012 and -.1 kgf/cm2 [Ogden 1972].
Material treloarsRubber(double nu)
{
    Material material = elasticMaterial(1, nu);
    material.m_law = ElasticLaw::ogden;
    constexpr double kUnit = 98066.5;  // [Pa]
    material.m_lawConstants = {6.3 * kUnit, 1.3, .012 * kUnit, 5, -.1 * kUnit, -2};
    return material;
}

// Nominal stress of an incompressible bar, sum of mu_p (s^(alpha_p - 1) - s^(-alpha_p / 2 - 1)).
double incompressibleStress(const Material& material, double stretch)
{
    double sum = 0;
    for (int p = 0; p < 3; ++p)
    {
        const double mu = material.m_lawConstants[2 * p], alpha = material.m_lawConstants[2 * p + 1];
        sum += mu * (std::pow(stretch, alpha - 1) - std::pow(stretch, -alpha / 2 - 1));
    }
    return sum;
}

// Nominal stress of the compressible bar with free sides: the side's stretch is found by bisection.
double barStress(const Material& material, double stretch)
{
    const auto f = [&](double s)  // W' without the volume's terms
    {
        double sum = 0;
        for (int p = 0; p < 3; ++p)
            sum += material.m_lawConstants[2 * p] * std::pow(s, material.m_lawConstants[2 * p + 1] - 1);
        return sum;
    };
    const double M = material.m_lawConstants[0] + material.m_lawConstants[2] + material.m_lawConstants[4];
    const auto volume = [&](double J) { return 0.5 * material.lameLambda() * (J - 1 / J) - M / J; };
    double low = 0.05, high = 3;
    for (int k = 0; k < 100; ++k)
    {
        const double s = 0.5 * (low + high);
        (f(s) + volume(stretch * s * s) * stretch * s < 0 ? low : high) = s;
    }
    return f(stretch) + volume(stretch * low * low) * low * low;
}

// The response of the law in a bar with free sides.
double responseStress(const Material& material, double stretch)
{
    LawPoint point;
    point.m_lambda = material.lameLambda(), point.m_mu = material.lameMu();
    point.m_constants = material.m_lawConstants.data();
    double low = 0.05, high = 3;
    LawResponse at;
    for (int k = 0; k < 100; ++k)
    {
        const double s = 0.5 * (low + high);
        at = lawOf(ElasticLaw::ogden).m_respond({{{stretch - 1, 0, 0}, {0, s - 1, 0}, {0, 0, s - 1}}}, point);
        (at.m_stress(1, 1) < 0 ? low : high) = s;
    }
    return at.m_stress(0, 0);
}

TEST(Ogden, BarsHaveTheStressOfTheFormula)
{
    for (const double nu : {.3, .49, .499})
        for (const double stretch : {.3, .7, 1.1, 2.0, 4.0, 7.0})
        {
            const double expected = barStress(treloarsRubber(nu), stretch);
            EXPECT_NEAR(responseStress(treloarsRubber(nu), stretch) / expected, 1, 1e-6) << nu << ", " << stretch;
        }
    for (const double stretch : {1.1, 1.5, 2.0})
        EXPECT_NEAR(responseStress(treloarsRubber(.499), stretch) / incompressibleStress(treloarsRubber(.499), stretch),
                    1, .005);
}

// Simple tension of Treloar's vulcanized rubber at 20 C [Treloar 1944], nominal stress in MPa.
TEST(Ogden, FitsTreloarsRubberToAStretchOfSeven)
{
    const double data[][2] = {{1.12, .14},  {1.39, .32},  {1.61, .41},  {1.89, .50},  {2.42, .67},
                              {3.01, .85},  {3.58, 1.04}, {4.03, 1.21}, {4.76, 1.58}, {5.36, 1.94},
                              {5.76, 2.29}, {6.16, 2.67}, {6.62, 3.39}, {7.05, 4.12}};
    for (const auto& [stretch, stress] : data)
        EXPECT_NEAR(incompressibleStress(treloarsRubber(.499), stretch) / (stress * 1e6), 1, .115) << stretch;
}

TEST(Ogden, OneTermOfTwoIsNeoHookes)
{
    RandomVectors random(6);
    LawCase neoHooke(ElasticLaw::neoHooke, .4), ogden(ElasticLaw::ogden, .4);
    ogden.m_constants = {neoHooke.m_point.m_mu, 2, 0, 2, 0, 2};
    ogden.m_point = neoHooke.m_point;
    ogden.m_point.m_constants = ogden.m_constants.data();
    for (const double size : {1e-6, .3, .9, 1.6})
    {
        const Mat3 e = randomStrain(random, size);
        const LawResponse a = neoHooke.respond(e), b = ogden.respond(e);
        EXPECT_LE(squaredNorm(a.m_stress - b.m_stress), 1e-18 * squaredNorm(a.m_stress)) << size;
        EXPECT_NEAR(b.m_energy / a.m_energy, 1, 1e-6) << size;
    }
}

// Steps of a bar whose ends are led apart, in single and in double precision.
TEST(Ogden, LedBarsHaveTheStressOfTheFormula)
{
    const auto isEnd = [](const Vec3& X) { return X.x < 1e-9 || X.x > 1 - 1e-9; };
    for (const double tolerance : {1e-3, 1e-6})
    {
        Body bar = makeBody(makeBox({1, .25, .25}, {4, 1, 1}), treloarsRubber(.3), {}, .02);
        const std::vector<Vec3>& X = bar.m_model->mesh().restPositions();
        for (std::size_t i = 0; i < X.size(); ++i) bar.m_state.m_x[i] = {2 * X[i].x, .8 * X[i].y, .8 * X[i].z};
        Body led = makeBody(makeBox({1, .25, .25}, {4, 1, 1}), treloarsRubber(.3), isEnd, .02);
        StepSettings settings;
        settings.m_step = .02;
        settings.m_tolerance = tolerance;
        led.m_state.m_x = bar.m_state.m_x;
        for (int k = 0; k < 150; ++k)
        {
            std::fill(led.m_state.m_v.begin(), led.m_state.m_v.end(), Vec3());
            bullet_fem::step(led, settings);
        }
        double mean = 0, volume = 0;  // of the nominal stress, which the ends hardly disturb
        for (int e = 0; e < led.m_model->mesh().tetCount(); ++e)
        {
            const double V = led.m_model->shape().m_elements[e].m_volume;
            mean += V * elementStress(led, e).xx;
            volume += V;
        }
        EXPECT_NEAR(mean / volume / barStress(treloarsRubber(.3), 2), 1, .05) << tolerance;
    }
}

TEST(Ogden, RefusesConstantsThatAreNotStable)
{
    Material material = treloarsRubber(.4);
    material.m_lawConstants[4] = 1e4;
    expectRejected([&] { material.validate(); },
                   {"Ogden's law: mu3 alpha3 [Pa] is -20000, not in (0, inf)", "one sign"});
    material.m_lawConstants = {};
    expectRejected([&] { material.validate(); }, {"shear modulus", "is 0", "give mu1 and alpha1"});
    material.m_lawConstants = {1e5, 40, 0, 0, 0, 0};
    expectRejected([&] { material.validate(); }, {"alpha1 [-] is 40, outside [-30, 30]"});
}

}  // namespace
}  // namespace bullet_fem
