// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Isotropic damage: strength, softening, fracture energy at any element size.
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/step/stress.h"
#include "fem/laws/law_cases.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

constexpr double kStrength = 1e4, kFractureEnergy = 5;  // [Pa], [J/m2]

// The stress of a bar that is pulled to a strain, and the work per volume so far.
struct Pull
{
    explicit Pull(double size) : m_law(ElasticLaw::damage, 0)
    {
        m_law.m_constants = {kStrength, kFractureEnergy, 0, 0, 0, 0};
        m_law.m_point.m_size = size;
    }

    double to(double strain, int steps)
    {
        const double from = m_strain;
        for (int k = 1; k <= steps; ++k)
        {
            m_strain = from + (strain - from) * k / steps;
            const Mat3 e = {{{m_strain, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
            m_law.advance(e);
            const double stress = m_law.respond(e).m_stress(0, 0);
            m_work += 0.5 * (stress + m_stress) * (strain - from) / steps;
            m_stress = stress;
            m_peak = std::max(m_peak, stress);
        }
        return m_stress;
    }

    LawCase m_law;
    double m_strain = 0, m_stress = 0, m_work = 0, m_peak = 0;
};

TEST(Damage, BarsBearTheStrengthAndDissipateTheFractureEnergyAtAnySize)
{
    for (const double size : {.01, .02, .03})
    {
        Pull bar(size);
        bar.to(.5, 200000);
        EXPECT_NEAR(bar.m_peak / kStrength, 1, 1e-3) << size;
        EXPECT_LT(bar.m_stress,
                  .06 * kStrength);  // a thousandth of the stiffness is left, and its energy not dissipated
        const double left = 0.5 * bar.m_stress * bar.m_strain;
        EXPECT_NEAR((bar.m_work - left) * size / kFractureEnergy, 1, .06) << size;
    }
}

// Elements that hold more energy than a crack dissipates, from 2 G E / strength^2 = .1 m on.
TEST(Damage, LargeElementsBreakAtOnce)
{
    Pull bar(.2);
    bar.to(.0102, 2000);
    EXPECT_NEAR(bar.m_peak / kStrength, 1, 1e-3);
    bar.to(.0125, 2000);
    EXPECT_LT(bar.m_stress, .02 * kStrength);
}

TEST(Damage, UnloadsTowardsTheOriginAndNeverHeals)
{
    Pull bar(.03);
    const double peak = bar.to(.02, 1000);
    EXPECT_NEAR(bar.to(.01, 10), peak / 2, 1e-6 * peak);
    EXPECT_NEAR(bar.to(0, 10), 0, 1e-6 * peak);
    EXPECT_NEAR(bar.to(.02, 10), peak, 1e-6 * peak);
}

Material brittle()
{
    Material material = elasticMaterial(1e6, .2);
    material.m_law = ElasticLaw::damage;
    material.m_lawConstants = {kStrength, kFractureEnergy, 0, 0, 0, 0};
    return material;
}

Body ledBar(const Material& material, double& stress)
{
    const auto isEnd = [](const Vec3& X) { return X.x < 1e-9 || X.x > .4 - 1e-9; };
    Body bar = makeBody(makeBox({.4, .1, .1}, {4, 1, 1}), material, isEnd, .02);
    StepSettings settings;
    settings.m_step = .02;
    stress = 0;
    for (int k = 0; k < 100; ++k)
    {
        for (std::size_t i = 0; i < bar.m_state.m_x.size(); ++i)
            if (bar.m_state.m_fixed[i] && bar.m_model->mesh().restPositions()[i].x > .2)
                bar.m_loads.m_targetVelocity[i] = {.4 * .04 / 2, 0, 0};  // a strain of 4 % in two seconds
        bullet_fem::step(bar, settings);
        stress = std::max(stress, elementStress(bar, 0).xx);
    }
    return bar;
}

TEST(Damage, LedBarsBreakAndKeepTheirHistory)
{
    double peak = 0, elastic = 0;
    const Body bar = ledBar(brittle(), peak);
    Material hooke = brittle();
    hooke.m_law = ElasticLaw::hooke, hooke.m_lawConstants = {};
    ledBar(hooke, elastic);
    EXPECT_GT(elastic, 3 * kStrength);
    EXPECT_GT(peak, .8 * kStrength);
    EXPECT_LT(peak, 1.3 * kStrength);
    double most = 0;
    for (const double kappa : bar.m_state.m_lawHistory) most = std::max(most, kappa);
    EXPECT_GT(most, 2 * kStrength / 1e6);
    const BodySnapshot saved = snapshotOf(bar);
    EXPECT_EQ(saved.m_lawHistory, bar.m_state.m_lawHistory);
    check(saved, *bar.m_model);
    BodySnapshot spoiled = saved;
    spoiled.m_lawHistory[3] = std::nan("");
    expectRejected([&] { check(spoiled, *bar.m_model); }, {"history variable of element 3 is", "not finite"});
    spoiled.m_lawHistory.pop_back();
    expectRejected([&] { check(spoiled, *bar.m_model); }, {"history variables where the body has"});
}

TEST(Damage, NamesBadConstantsAndCombinations)
{
    Material material = brittle();
    EXPECT_TRUE(material.valid());
    material.m_lawConstants[0] = 0;
    expectRejected([&] { material.validate(); }, {"damage law: strength [Pa] is 0, outside [1, ", "concrete"});
    material = brittle();
    material.m_meanDilatation = MeanDilatation::on;
    expectRejected([&] { material.validate(); }, {"mean dilatation is on with the damage law", "compressible"});
    material = brittle();
    material.m_bending = Bending::accurate;
    EXPECT_TRUE(material.valid());
    EXPECT_TRUE(material.usesMeanDilatation());
}

}  // namespace
}  // namespace bullet_fem
