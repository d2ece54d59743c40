// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// One element and patches of them under prescribed deformations: Hooke's law in closed form.
#include "bullet_fem/fem/step/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "fem/scenes/elasticity_scenes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

constexpr double kYoung = 2e6, kPoisson = 0.3;  // [Pa], [-]
constexpr double kLambda = kYoung * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson)),
                 kMu = kYoung / (2 * (1 + kPoisson));
constexpr double kRounding = 1e-14 * kYoung;  // strains near 1, some hundred roundings

Body oneElement()
{
    return makeBody(TetMesh({{0.1, 0.2, 0.3}, {1.2, 0.1, 0.2}, {0.3, 1.1, 0.4}, {0.2, 0.4, 0.9}}, {{0, 1, 2, 3}}),
                    elasticMaterial(kYoung, kPoisson));
}

void deform(Body& body, const Mat3& F, const Vec3& shift = {})
{
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    for (std::size_t i = 0; i < X.size(); ++i) body.m_state.m_x[i] = F * X[i] + shift;
}

Mat3 matrixOf(const Stress& s)
{
    return {{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
}

void expectStress(const Stress& s, const Mat3& expected, double tolerance = 100 * kRounding)
{
    const Mat3 found = matrixOf(s);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(found(i, j), expected(i, j), tolerance) << i << ", " << j;
}

const Mat3 kTurn = rotationAbout({1, 2, -1}, 2.1);

TEST(Stress, UniaxialStrainIsHookesLaw)
{
    Body body = oneElement();
    for (const double strain : {-0.2, 1e-6, 0.1})
    {
        deform(body, {{{1 + strain, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
        const double across = kLambda * strain;
        expectStress(elementStress(body, 0), {{{across + 2 * kMu * strain, 0, 0}, {0, across, 0}, {0, 0, across}}});
        EXPECT_NEAR(vonMises(elementStress(body, 0)), 2 * kMu * std::fabs(strain), kYoung * 1e-12);
    }
}

TEST(Stress, FreeContractionGivesYoungsModulusTimesStrain)
{
    Body body = oneElement();
    const double strain = 0.01;
    deform(body, {{{1 + strain, 0, 0}, {0, 1 - kPoisson * strain, 0}, {0, 0, 1 - kPoisson * strain}}});
    expectStress(elementStress(body, 0), {{{kYoung * strain, 0, 0}, {}, {}}});
    EXPECT_NEAR(vonMises(elementStress(body, 0)), kYoung * strain, kYoung * 1e-12);
}

// Pure shear, with F equal to its stretch: gamma / 2 on both off-diagonal entries.
TEST(Stress, PureShearIsTheShearModulusTimesTheAngle)
{
    Body body = oneElement();
    const double gamma = 0.04, tau = kMu * gamma;
    deform(body, {{{1, gamma / 2, 0}, {gamma / 2, 1, 0}, {0, 0, 1}}});
    expectStress(elementStress(body, 0), {{{0, tau, 0}, {tau, 0, 0}, {}}});
    EXPECT_NEAR(vonMises(elementStress(body, 0)), std::sqrt(3.0) * tau, kYoung * 1e-12);
}

TEST(Stress, PressureFromAllSidesHasNoVonMises)
{
    Body body = oneElement();
    const double strain = -0.03, pressure = (3 * kLambda + 2 * kMu) * -strain;
    deform(body, kTurn * Mat3::diagonal(1 + strain));
    expectStress(elementStress(body, 0), Mat3::diagonal(-pressure));
    EXPECT_LT(vonMises(elementStress(body, 0)), 1e-12 * pressure);
}

TEST(Stress, TurnsWithTheBody)
{
    Body body = oneElement();
    const Mat3 U = {{{1.1, 0.03, -0.02}, {0.03, 0.95, 0.05}, {-0.02, 0.05, 1.02}}};
    deform(body, U);
    const Stress before = elementStress(body, 0);
    deform(body, kTurn * U, {3, -2, 5});
    expectStress(elementStress(body, 0), timesTranspose(kTurn * matrixOf(before), kTurn));
    EXPECT_NEAR(vonMises(elementStress(body, 0)), vonMises(before), 1e-12 * kYoung);
}

// Accurate to rounding: positions of 100 m have a resolution of 1.4e-14 m, edges are 1 m.
TEST(Stress, ARigidMotionGivesNone)
{
    Body body = oneElement();
    deform(body, kTurn, {100, 0, -100});
    expectStress(elementStress(body, 0), {}, 1e-12 * kYoung);
    EXPECT_LT(vonMises(elementStress(body, 0)), 1e-12 * kYoung);
}

// V sigma R g_a is the derivative of the elastic energy by corner a, here by central differences: truncation and
// rounding stay below 1e-8 E.
TEST(Stress, BalancesTheForcesOfTheElement)
{
    Body body = oneElement();
    const Mat3 F = kTurn * Mat3{{{1.1, 0.2, 0}, {-0.1, 0.9, 0.1}, {0, 0.05, 1.3}}};
    deform(body, F);
    const std::vector<Mat3> R = elementRotations(body);
    const Mat3 sigma = matrixOf(elementStress(body, 0));
    const RestElement& element = body.m_model->shape().m_elements[0];
    for (int a = 1; a < 4; ++a)
    {
        const Vec3 gradient =
            R[0] * Vec3{element.m_DmInverse(a - 1, 0), element.m_DmInverse(a - 1, 1), element.m_DmInverse(a - 1, 2)};
        const Vec3 force = element.m_volume * (sigma * gradient);
        const double h = 1e-6;
        for (int i = 0; i < 3; ++i)
        {
            Vec3& x = body.m_state.m_x[a];
            const Vec3 before = x;
            x[i] = before[i] + h;
            const double above = mechanicalEnergy(body);
            x[i] = before[i] - h;
            const double below = mechanicalEnergy(body);
            x = before;
            EXPECT_NEAR((above - below) / (2 * h), force[i], 1e-8 * kYoung) << a << ", " << i;
        }
    }
}

// Against the exact Cauchy stress P F^T / det F of the energy, P = R sigma_lin: in uniaxial tension the exact one is 1
// / (1 - nu strain)^2 times as large, 0.6 % at 1 % strain and 21 % at 30 %.
TEST(Stress, DiffersFromTheExactCauchyStressInTheOrderOfTheStrain)
{
    Body body = oneElement();
    for (const double strain : {0.01, 0.3})
    {
        const double across = 1 - kPoisson * strain;
        const Mat3 F = {{{1 + strain, 0, 0}, {0, across, 0}, {0, 0, across}}};
        deform(body, F);
        const Mat3 sigma = matrixOf(elementStress(body, 0));
        const Mat3 exact = timesTranspose(sigma, F) * (1 / determinant(F));
        EXPECT_NEAR(exact(0, 0) / sigma(0, 0), 1 / (across * across), 1e-9);
    }
}

TEST(Stress, IsFiniteForFlatInvertedAndCollapsedElements)
{
    Body body = oneElement();
    for (const double z : {0.0, -1.0, -0.3})
    {
        deform(body, kTurn * Mat3{{{1, 0, 0}, {0, 1, 0}, {0, 0, z}}});
        EXPECT_TRUE(std::isfinite(vonMises(elementStress(body, 0)))) << z;
    }
    deform(body, Mat3::diagonal(0));
    expectStress(elementStress(body, 0), Mat3::diagonal(-(3 * kLambda + 2 * kMu)));
}

// A patch under uniform deformation: all elements and nodes have equal stress, for any filled fractions.
TEST(Stress, IsUniformInAPatchAlsoOfPartlyFilledElements)
{
    const TetMesh mesh = makeBox({1, 2, 1}, {2, 3, 2});
    std::vector<double> filled(mesh.tetCount());
    for (std::size_t e = 0; e < filled.size(); ++e) filled[e] = 0.25 + 0.75 * (e % 7) / 6;
    const auto shape = std::make_shared<RestShape>(mesh, elasticMaterial(kYoung, kPoisson), filled);
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_fixed.assign(mesh.nodeCount(), 0);
    Body body(BodyModel::create(shape, input));
    const double strain = 0.02;
    deform(body, {{{1 + strain, 0, 0}, {0, 1 - kPoisson * strain, 0}, {0, 0, 1 - kPoisson * strain}}});
    std::vector<Stress> perElement, perNode;
    elementStresses(body, perElement);
    nodeStresses(*body.m_model, perElement, perNode);
    ASSERT_EQ(perElement.size(), mesh.tets().size());
    ASSERT_EQ(perNode.size(), mesh.restPositions().size());
    for (const Stress& s : perElement) expectStress(s, {{{kYoung * strain, 0, 0}, {}, {}}});
    for (const Stress& s : perNode) expectStress(s, {{{kYoung * strain, 0, 0}, {}, {}}});
}

// Two elements with a common face, the second twice as large: weights of a node of the face are a third and two thirds.
TEST(Stress, NodeStressIsTheVolumeWeightedMean)
{
    const TetMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 2}, {5, 5, 5}},
                       {{0, 2, 1, 3}, {0, 1, 2, 4}}, LooseNodes::kept);
    const auto shape = std::make_shared<RestShape>(mesh, elasticMaterial(kYoung, kPoisson));
    FactorInput input;
    input.m_mass.assign(6, 1);
    input.m_fixed = {0, 0, 0, 0, 0, 1};
    const auto model = BodyModel::create(shape, input);
    Stress first, second;
    first.xx = 3, first.yz = -6;
    second.xx = 9, second.yz = 3;
    std::vector<Stress> perNode;
    nodeStresses(*model, {first, second}, perNode);
    EXPECT_DOUBLE_EQ(perNode[0].xx, 7);
    EXPECT_NEAR(perNode[1].yz, 0, 1e-15);
    EXPECT_DOUBLE_EQ(perNode[3].xx, 3);
    EXPECT_DOUBLE_EQ(perNode[4].yz, 3);
    EXPECT_EQ(vonMises(perNode[5]), 0);
}

// rho c with c = sqrt((lambda + 2 mu) / rho), of the hardest region; without a density that of the body's mass.
TEST(WaveImpedance, IsThatOfPressureWaves)
{
    const double stiffness = kLambda + 2 * kMu;
    Body body = oneElement();
    const double density = body.m_model->shape().m_material.m_density;
    EXPECT_NEAR(waveImpedance(body), std::sqrt(density * stiffness), 1e-9 * stiffness);

    Material weightless = elasticMaterial(kYoung, kPoisson);
    weightless.m_density = 0;
    body = makeBody(body.m_model->mesh(), weightless);
    for (double& mass : body.m_state.m_mass) mass = 50 * body.m_model->shape().m_elements[0].m_volume;
    EXPECT_NEAR(waveImpedance(body), std::sqrt(200 * stiffness), 1e-9 * stiffness);

    Material wood = elasticMaterial(kYoung, kPoisson);
    wood.m_density = 500;
    wood.m_law = ElasticLaw::orthotropic;
    wood.m_orthotropic = Orthotropic::transverselyIsotropic(1e9, 1e8, 0, 0, 1e8);
    body = makeBody(body.m_model->mesh(), wood);
    EXPECT_NEAR(waveImpedance(body), std::sqrt(500 * 1e9), 1e-3);
}

TEST(Stress, DoesNotAllocateOnceItHasGrown)
{
    Body body = makeBody(makeBox({1, 1, 1}, {3, 3, 3}), elasticMaterial(kYoung, kPoisson));
    std::vector<Stress> perElement, perNode;
    elementStresses(body, perElement);
    nodeStresses(*body.m_model, perElement, perNode);
    deform(body, {{{1, 0, 0}, {0, 1, 0}, {0, 0, -0.5}}});  // inverted: by singular values
    const AllocationCounter counter;
    elementStresses(body, perElement);
    nodeStresses(*body.m_model, perElement, perNode);
    EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace bullet_fem
