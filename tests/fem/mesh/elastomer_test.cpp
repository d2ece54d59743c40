// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/elastomer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

// Gent's formula worked by hand, in MPa.
TEST(ShoreA, YoungsModulusIsGents)
{
    const double hardness[] = {10, 30, 40, 60, 80, 95},
                 young[] = {.412683, 1.142372, 1.689639, 3.605073, 9.351375, 43.829188};
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(shoreA(hardness[i]).m_youngModulus * 1e-6 / young[i], 1, 1e-4);
}

// The half-space formula beside moduli of natural rubber by hardness in IRHD, which equals Shore A here [Lindley 1970].
TEST(ShoreA, YoungsModulusIsWithinAQuarterOfLindleysTable)
{
    const double hardness[] = {30, 35, 40, 45, 50, 55, 60, 65, 70};
    const double young[] = {.92, 1.18, 1.5, 1.8, 2.2, 3.25, 4.45, 5.85, 7.35};
    for (int i = 0; i < 9; ++i)
        EXPECT_NEAR(shoreA(hardness[i]).m_youngModulus * 1e-6 / young[i], 1, .26) << hardness[i];
}

TEST(ShoreD, YoungsModulusIsThatOfQi)
{
    EXPECT_NEAR(shoreD(30).m_youngModulus / 1e6, std::pow(10, 1.2397), 1e-6);
    EXPECT_NEAR(shoreD(70).m_youngModulus / 1e6, std::pow(10, 2.1797), 1e-5);
}

// 40 D is about 90 A: both scales then tell of one modulus, to the scatter of hardness.
TEST(ShoreD, ContinuesTheScaleA)
{
    EXPECT_NEAR(shoreD(40).m_youngModulus / shoreA(92).m_youngModulus, 1, .2);
    EXPECT_LT(shoreA(90).m_youngModulus, shoreD(40).m_youngModulus);
}

TEST(Elastomers, AreValidNearlyIncompressibleAndStiffenWithHardness)
{
    double before = 0;
    for (double hardness = kMinShoreA; hardness <= kMaxShoreA; hardness += 5)
    {
        const Material rubber = shoreA(hardness);
        EXPECT_TRUE(rubber.valid());
        EXPECT_GT(rubber.m_youngModulus, before);
        EXPECT_EQ(rubber.m_density, 1100);
        EXPECT_TRUE(rubber.usesMeanDilatation());
        before = rubber.m_youngModulus;
    }
    before = 0;
    for (double hardness = kMinShoreD; hardness <= kMaxShoreD; hardness += 5)
    {
        const Material plastic = shoreD(hardness);
        EXPECT_TRUE(plastic.valid());
        EXPECT_GT(plastic.m_youngModulus, before);
        EXPECT_EQ(plastic.m_density, 1200);
        EXPECT_TRUE(plastic.usesMeanDilatation());
        before = plastic.m_youngModulus;
    }
}

TEST(Elastomers, HaveTheBulkModulusOfRubberWherePoissonsRatioAllows)
{
    const Material hard = shoreD(60);
    EXPECT_NEAR(hard.m_youngModulus / (3 * (1 - 2 * hard.m_poissonRatio)) / 2e9, 1, 1e-9);
    EXPECT_EQ(shoreA(40).m_poissonRatio, Material::kMaxPoissonRatio);
}

TEST(Elastomers, HaveTheirLossFactor)
{
    EXPECT_NEAR(lossFactor(shoreA(40), 10), .1, 1e-12);
    EXPECT_NEAR(lossFactor(shoreD(60), 10), .1, 1e-12);
    EXPECT_NEAR(shoreA(60).m_stiffnessDamping, .1 / (20 * kPi), 1e-12);
}

TEST(Elastomers, RefuseHardnessOutsideTheScale)
{
    expectRejected([] { shoreA(9); }, {"hardness [Shore A] is 9, outside [10, 95]", "shoreD for more"});
    expectRejected([] { shoreA(96); }, {"96", "shoreD"});
    expectRejected([] { shoreA(kNaN); }, {"nan"});
    expectRejected([] { shoreD(29); }, {"hardness [Shore D] is 29, outside [30, 70]", "shoreA for less"});
    expectRejected([] { shoreD(71); }, {"71"});
}

TEST(LossFactor, IsSetBesideTheMassDamping)
{
    Material material;
    material.m_massDamping = 3;
    setLossFactor(material, .2, 5);
    EXPECT_EQ(material.m_massDamping, 3);
    EXPECT_NEAR(material.m_stiffnessDamping, (.2 - 3 / (10 * kPi)) / (10 * kPi), 1e-15);
    EXPECT_NEAR(lossFactor(material, 5), .2, 1e-15);
    setLossFactor(material, 3 / (10 * kPi), 5);
    EXPECT_NEAR(material.m_stiffnessDamping, 0, 1e-15);
}

TEST(LossFactor, RefusesBadValues)
{
    Material material;
    material.m_stiffnessDamping = .01;
    expectRejected([&] { setLossFactor(material, 2.1, 5); }, {"loss factor [-] is 2.1, outside [0, 2]", "rubber"});
    expectRejected([&] { setLossFactor(material, -.1, 5); }, {"-0.1"});
    expectRejected([&] { setLossFactor(material, kNaN, 5); }, {"nan"});
    expectRejected([&] { setLossFactor(material, .1, 0); }, {"[Hz] is 0, outside [0.001, 100000]", "data sheets"});
    expectRejected([&] { setLossFactor(material, .1, 2e5); }, {"200000"});
    expectRejected([&] { setLossFactor(material, 1, .01); }, {"stiffness damping [s]", "outside [0, 10]"});
    material.m_massDamping = 10;
    expectRejected([&] { setLossFactor(material, .1, 1); }, {"less than the 1.59", "reduce the mass damping"});
    EXPECT_EQ(material.m_stiffnessDamping, .01);
}

}  // namespace
}  // namespace bullet_fem
