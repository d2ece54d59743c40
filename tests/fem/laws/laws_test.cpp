// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Properties that every law of the table has.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "fem/common/rotation.h"
#include "fem/laws/law_cases.h"
#include "fem/laws/mean_dilatation.h"
#include "fem/laws/volume_ratio.h"

namespace bullet_fem
{
namespace
{

class Laws : public testing::TestWithParam<int>
{
protected:
    ElasticLaw law() const { return static_cast<ElasticLaw>(GetParam()); }
};

// Central differences; also where elements are flat and inside out.
TEST_P(Laws, StressIsTheDerivativeOfTheEnergy)
{
    const LawCase c(law());
    RandomVectors random(5);
    for (const double size : {0.01, 0.3, 0.8, 1.5})
    {
        const Mat3 e = randomStrain(random, size);
        const LawResponse response = c.respond(e);
        const double d = 1e-6, scale = std::sqrt(squaredNorm(response.m_stress)) + 1;
        for (int i = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j)
            {
                Mat3 step;
                step(i, j) = step(j, i) = d;
                const double slope = (c.respond(e + step).m_energy - c.respond(e - step).m_energy) / (2 * d);
                EXPECT_NEAR(slope, (i == j ? 1 : 2) * response.m_stress(i, j), 1e-6 * scale) << size << i << j;
            }
    }
}

TEST_P(Laws, AtRestHaveNoStressAndTheModuliOfTheFactor)
{
    const LawCase c(law());
    const LawResponse rest = c.respond(Mat3());
    EXPECT_EQ(squaredNorm(rest.m_stress), 0);
    EXPECT_EQ(rest.m_energy, 0);
    if (c.m_law.m_kind == LawKind::anisotropic) return;
    EXPECT_NEAR(squaredNorm(rest.m_cofactor - Mat3::identity()), 0, 1e-20);
    EXPECT_NEAR(rest.m_bulk / c.m_point.m_lambda, 1, 1e-12);
    EXPECT_NEAR(rest.m_shear, 1, 1e-12);
    RandomVectors random(8);
    const Mat3 e = randomStrain(random, 1e-6);
    const Mat3 hooke = 2 * c.m_point.m_mu * e + Mat3::diagonal(c.m_point.m_lambda * trace(e));
    EXPECT_LE(squaredNorm(c.respond(e).m_stress - hooke), 1e-10 * squaredNorm(hooke));
}

TEST_P(Laws, AreObjectiveAndSymmetric)
{
    const LawCase c(law());
    RandomVectors random(2);
    const Mat3 Q = rotationAbout({1, -2, 3}, 2), e = randomStrain(random, 0.4);
    const LawResponse own = c.respond(e);
    EXPECT_LE(squaredNorm(own.m_stress - transpose(own.m_stress)), 1e-24 * squaredNorm(own.m_stress));
    if (c.m_law.m_kind == LawKind::anisotropic) return;
    const LawResponse turned = c.respond(Q * timesTranspose(e, Q));
    const Mat3 expected = Q * timesTranspose(own.m_stress, Q);
    EXPECT_LE(squaredNorm(turned.m_stress - expected), 1e-20 * squaredNorm(expected));
    EXPECT_NEAR(turned.m_energy / own.m_energy, 1, 1e-12);
}

// The approximate tangent is an upper bound of the derivative along every stretch.
TEST_P(Laws, TangentCoversTheDerivative)
{
    const LawCase c(law());
    if (c.m_law.m_kind == LawKind::anisotropic) return;
    const double d = 1e-5;
    for (const Mat3& e : {Mat3(), Mat3::diagonal(0.5), Mat3{{{1, 0, 0}, {0, -.3, 0}, {0, 0, -.3}}},
                          Mat3{{{4, 0, 0}, {0, -.55, 0}, {0, 0, -.55}}}, Mat3{{{0, 0, 0}, {0, -.8, 0}, {0, 0, .1}}}})
        for (int axis = 0; axis < 3; ++axis)
        {
            Mat3 step;
            step(axis, axis) = d;
            const LawResponse at = c.respond(e);
            const double second = (c.respond(e + step).m_stress - c.respond(e - step).m_stress)(axis, axis) / (2 * d);
            const double C = at.m_cofactor(axis, axis), tension = std::max(0.0, at.m_stress(axis, axis));
            const double covered = at.m_bulk * C * C + 2 * at.m_shear * c.m_point.m_mu + tension;
            EXPECT_GE(covered, 0.999 * second) << e(0, 0) << ", " << e(1, 1) << ", " << axis;
        }
}

TEST_P(Laws, SplitTheShareOfPatchesOff)
{
    const LawCase c(law());
    if (c.m_law.m_noPatches) return;
    RandomVectors random(3);
    const Mat3 e = randomStrain(random, 0.2);
    LawPoint point = c.m_point;
    const double change = volumeChange(c.m_law, e), shared = sharedEnergy(c.m_law, change, point);
    const double expected = c.m_law.m_hasVolumeRatio ? determinant(Mat3::identity() + e) - 1 : trace(e);
    EXPECT_NEAR(change, expected, 1e-14);
    shareWithPatch(c.m_law, change, point);
    const LawResponse whole = c.respond(e), split = c.m_law.m_respond(e, point);
    EXPECT_NEAR((split.m_energy + shared) / whole.m_energy, 1, 1e-12);
    EXPECT_LE(squaredNorm(split.m_stress - whole.m_stress), 1e-20 * squaredNorm(whole.m_stress));
}

TEST_P(Laws, NameTheirConstants)
{
    const LawCase c(law());
    std::string why;
    EXPECT_LE(c.m_law.m_constants.size(), std::size_t(kMaxLawConstants));
    EXPECT_TRUE(areLawConstants(c.m_law, c.m_constants.data(), &why)) << why;
    for (std::size_t k = 0; k < c.m_law.m_constants.size(); ++k)
        for (const double bad : {std::nan(""), 2 * c.m_law.m_constants[k].m_high})
        {
            std::array<double, kMaxLawConstants> constants = c.m_constants;
            constants[k] = bad;
            EXPECT_FALSE(areLawConstants(c.m_law, constants.data(), &why));
            EXPECT_NE(why.find(std::string(c.m_law.m_title) + ": " + c.m_law.m_constants[k].m_name), std::string::npos)
                << why;
        }
    ElasticLaw found = ElasticLaw::hooke;
    EXPECT_TRUE(findLaw(c.m_law.m_name, found));
    EXPECT_EQ(found, law());
    EXPECT_FALSE(findLaw("treacle", found));
}

INSTANTIATE_TEST_SUITE_P(All, Laws, testing::Range(0, static_cast<int>(allLaws().size())),
                         [](const testing::TestParamInfo<int>& tested) { return allLaws()[tested.param].m_name; });

TEST(VolumeFunction, GoesOnAsAParabolaBelowATenth)
{
    const VolumeFunction at(kMinVolumeRatio - 1), below(-1.3);
    EXPECT_NEAR(at.m_value, 0.25 * (0.01 - 1 - 2 * std::log(0.1)), 1e-14);
    EXPECT_NEAR(at.m_slope, 0.5 * (0.1 - 10), 1e-12);
    const double further = -1.3 - (kMinVolumeRatio - 1);
    EXPECT_NEAR(below.m_slope, at.m_slope + at.m_curvature * further, 1e-12);
    EXPECT_NEAR(below.m_value, at.m_value + (at.m_slope + 0.5 * at.m_curvature * further) * further, 1e-12);
}

}  // namespace
}  // namespace bullet_fem
