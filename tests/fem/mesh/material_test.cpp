// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

TEST(Material, LameConstantsMatchHandValues)
{
    Material material;
    material.m_youngModulus = 260;
    material.m_poissonRatio = 0.3;
    EXPECT_DOUBLE_EQ(material.lameLambda(), 150);  // 260 * 0.3 / (1.3 * 0.4)
    EXPECT_DOUBLE_EQ(material.lameMu(), 100);      // 260 / 2.6
    material.m_poissonRatio = 0;
    EXPECT_DOUBLE_EQ(material.lameLambda(), 0);
    EXPECT_DOUBLE_EQ(material.lameMu(), 130);
}

TEST(LameModuli, EqualThoseOfTheMaterial)
{
    Material material;
    for (const double poisson : {0.0, 0.2, 0.45})
    {
        material.m_poissonRatio = poisson;
        const LameModuli moduli = {material.lameMu(), material.lameLambda()};
        EXPECT_NEAR(moduli.youngModulus(), 1e6, 1e-6);
        EXPECT_NEAR(moduli.poissonRatio(), poisson, 1e-12);
    }
}

TEST(LameModuli, StayWithinTheMaterialRange)
{
    const LameModuli soft = {300, -150}, stiff = {1, 1e9};
    EXPECT_DOUBLE_EQ(soft.poissonRatio(), 0);
    EXPECT_DOUBLE_EQ(soft.youngModulus(), 600);  // 2 mu: the shear modulus is kept
    EXPECT_DOUBLE_EQ(stiff.poissonRatio(), 0.499);
}

TEST(Material, DefaultAndPresetsAreValidAndDiffer)
{
    const std::vector<Material> all = {Material(),        Material::rubber(), Material::foam(),
                                       Material::jelly(), Material::flesh(),  Material::wood(),
                                       Material::clay(),  Material::lead(),   Material::mildFoam()};
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        std::string why = "untouched";
        EXPECT_TRUE(all[i].valid(&why)) << i;
        EXPECT_EQ(why, "untouched");
        EXPECT_NO_THROW(all[i].validate());
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(all[i], all[j]) << i << " " << j;
    }
}

TEST(Material, PresetsAreAsDocumented)
{
    const auto is = [](const Material& material, double youngModulus, double poissonRatio, double density,
                       ElasticLaw law = ElasticLaw::hooke)
    {
        EXPECT_EQ(material.m_law, law);
        EXPECT_EQ(material.m_youngModulus, youngModulus);
        EXPECT_EQ(material.m_poissonRatio, poissonRatio);
        EXPECT_EQ(material.m_density, density);
        EXPECT_EQ(material.m_massDamping, 0);
        EXPECT_EQ(material.m_stiffnessDamping, 0);
    };
    is(Material::rubber(), 2e6, 0.47, 1100);
    is(Material::foam(), 50e3, 0.1, 40);
    is(Material::jelly(), 10e3, 0.45, 1000, ElasticLaw::neoHooke);
    is(Material::flesh(), 60e3, 0.45, 1060, ElasticLaw::neoHooke);
    is(Material::wood(), 9e9, 0.3, 500);
    is(Material::clay(), 2.5e6, 0.45, 1800);
    is(Material::lead(), 16e9, 0.44, 11340);
    is(Material::mildFoam(), 50e3, 0.1, 40);
}

TEST(Material, NeoHookeanPresetsNameTheRemedyForConflicts)
{
    for (const auto spoil : {+[](Material& m) { m.m_yieldStress = 1e3; },
                             +[](Material& m) {
                                 m.m_relaxation[0] = {.3, 1};
                             }})
    {
        Material material = Material::jelly();
        spoil(material);
        expectRejected([&] { material.validate(); },
                       {"the Neo-Hookean law (as jelly and flesh have)", "the law hooke"});
        material.m_law = ElasticLaw::hooke;
        EXPECT_TRUE(material.valid());
    }
}

TEST(Material, SlowComplianceIsThatOfABarUnderALastingLoad)
{
    Material material;
    for (const double poisson : {0.0, 0.3, 0.45, 0.499})
    {
        material.m_poissonRatio = poisson;
        material.m_relaxation = {};
        EXPECT_NEAR(material.slowCompliance({0, 1, 0}) * material.m_youngModulus, 1, 1e-12);
        material.m_relaxation[0] = {.5, 1};
        material.m_relaxation[1] = {.2, 9};
        const double bulk = material.m_youngModulus / (3 * (1 - 2 * poisson)), mu = .3 * material.lameMu();
        EXPECT_NEAR(material.slowCompliance({0, 1, 0}) * 9 * bulk * mu / (3 * bulk + mu), 1, 1e-9);
    }
}

TEST(Material, PresetsYieldAsDocumented)
{
    for (const Material& elastic : {Material(), Material::rubber(), Material::foam(), Material::wood()})
        EXPECT_FALSE(elastic.yields());
    const auto yields = [](const Material& material, double stress, double hardening, double creep)
    {
        EXPECT_TRUE(material.yields());
        EXPECT_EQ(material.m_yieldStress, stress);
        EXPECT_EQ(material.m_hardeningModulus, hardening);
        EXPECT_EQ(material.m_plasticCreep, creep);
        EXPECT_EQ(material.m_mostPlasticStrain, 0.5);
    };
    yields(Material::clay(), 5e4, 0, kInf);
    yields(Material::lead(), 5.5e6, 20e6, kInf);
    yields(Material::mildFoam(), 2.5e3, 0, 2);
}

TEST(Material, ComparesYieldParameters)
{
    for (double Material::*member : {&Material::m_yieldStress, &Material::m_hardeningModulus, &Material::m_plasticCreep,
                                     &Material::m_mostPlasticStrain})
    {
        Material material = Material::lead();
        material.*member = 0.3;
        EXPECT_NE(material, Material::lead());
    }
}

struct Bound
{
    const char* m_name;          // test name
    double Material::*m_member;  // the member under test
    std::vector<double> m_good;  // the limits of the range
    std::vector<double> m_bad;   // just outside, far outside, not finite
    const char* m_what;          // its name in the message
    const char* m_range;         // its range in the message
};

void PrintTo(const Bound& bound, std::ostream* out)
{
    *out << bound.m_name;
}

class MaterialRange : public testing::TestWithParam<Bound>
{
};

TEST_P(MaterialRange, AcceptsItsEnds)
{
    for (const double value : GetParam().m_good)
    {
        Material material;
        material.*GetParam().m_member = value;
        EXPECT_TRUE(material.valid()) << value;
    }
}

TEST_P(MaterialRange, RejectsValuesOutsideAndNamesThem)
{
    for (const double value : GetParam().m_bad)
    {
        Material material;
        material.*GetParam().m_member = value;
        std::ostringstream text;
        text.precision(10);
        text << "is " << value << ", outside";
        EXPECT_FALSE(material.valid()) << value;
        expectRejected([&] { material.validate(); }, {GetParam().m_what, text.str().c_str(), GetParam().m_range, "; "});
    }
}

const Bound kBounds[] = {
    {"YoungModulus", &Material::m_youngModulus, {1e-6, 1e13}, {0, -1e6, 1.01e13, kInf, kNaN}, "Young's", "(0, 1e+13]"},
    {"PoissonRatio",
     &Material::m_poissonRatio,
     {0, 0.499},
     {-0.01, 0.4991, 0.5, kInf, kNaN},
     "Poisson's",
     "[0, 0.499]"},
    {"Density", &Material::m_density, {0, 1e6}, {-1, 1.1e6, kInf, kNaN}, "density", "[0, 1000000]"},
    {"MassDamping", &Material::m_massDamping, {0, 1e4}, {-1e-9, 10001, kInf, kNaN}, "mass damping", "[0, 10000]"},
    {"StiffnessDamping",
     &Material::m_stiffnessDamping,
     {0, 10},
     {-1e-9, 10.5, kInf, kNaN},
     "stiffness damping",
     "[0, 10]"},
    {"YieldStress", &Material::m_yieldStress, {1e-6, 1e13, kInf}, {0, -1, -kInf, kNaN}, "yield stress", "(0, inf]"},
    {"HardeningModulus",
     &Material::m_hardeningModulus,
     {0, 1e13},
     {-1, 1.1e13, kInf, kNaN},
     "hardening modulus",
     "[0, 1e+13]"},
    {"PlasticCreep", &Material::m_plasticCreep, {1e-9, 1e9, kInf}, {0, -1, kNaN}, "plastic creep", "(0, inf]"},
    {"MostPlasticStrain",
     &Material::m_mostPlasticStrain,
     {1e-9, 0.9},
     {0, -0.1, 0.91, kInf, kNaN},
     "largest plastic strain",
     "(0, 0.9]"}};

INSTANTIATE_TEST_SUITE_P(Material, MaterialRange, testing::ValuesIn(kBounds),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

}  // namespace
}  // namespace bullet_fem
