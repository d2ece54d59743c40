// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Elastic constants of orthotropic materials, and rejected ones.
#include "bullet_fem/fem/laws/orthotropic.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "bullet_fem/fem/mesh/element_materials.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

using Matrix6 = Eigen::Matrix<double, 6, 6>;

Matrix6 matrixOf(const ElasticMatrix& C)
{
    return Eigen::Map<const Matrix6>(&C.m[0][0]);
}

// Constants of pine plywood's order of magnitude, all nine different.
Orthotropic nineConstants()
{
    Orthotropic m;
    m.m_young = {11e9, 1.2e9, 0.6e9};
    m.m_poisson = {0.37, 0.42, 0.47};
    m.m_shear = {0.7e9, 0.68e9, 0.07e9};
    return m;
}

Material orthotropicMaterial(const Orthotropic& constants)
{
    Material material;
    material.m_law = ElasticLaw::orthotropic;
    material.m_orthotropic = constants;
    return material;
}

TEST(Orthotropic, StiffnessIsTheInverseOfTheComplianceOfTheTextbook)
{
    const Orthotropic m = nineConstants();
    Matrix6 S = Matrix6::Zero();
    for (int i = 0; i < 3; ++i) S(i, i) = 1 / m.m_young[i];
    S(0, 1) = S(1, 0) = -0.37 / 11e9;
    S(0, 2) = S(2, 0) = -0.42 / 11e9;
    S(1, 2) = S(2, 1) = -0.47 / 1.2e9;
    S(3, 3) = 1 / 0.07e9, S(4, 4) = 1 / 0.68e9, S(5, 5) = 1 / 0.7e9;  // yz, xz, xy
    EXPECT_LT((matrixOf(m.stiffness()) * S - Matrix6::Identity()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Orthotropic, ComplianceMatchesABarPulledInAnyDirection)
{
    Orthotropic m = nineConstants();
    m.m_along = {1, 2, -1};
    m.m_across = {0, 1, 3};
    for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{1, 1, 0}, Vec3{1, -2, 3}})
    {
        const Vec3 n = (1 / norm(way)) * way;
        Eigen::Matrix<double, 6, 1> stress;
        stress << n.x * n.x, n.y * n.y, n.z * n.z, n.y * n.z, n.x * n.z, n.x * n.y;  // of 1 Pa along n
        const Eigen::Matrix<double, 6, 1> strain = matrixOf(m.stiffness()).ldlt().solve(stress);
        EXPECT_NEAR(stress.dot(strain) * 1e9, m.compliance(n) * 1e9, 1e-9);  // shear strains are doubled
    }
    EXPECT_NEAR(nineConstants().compliance({0, 1, 0}) * 1.2e9, 1, 1e-12);
}

TEST(Orthotropic, EqualConstantsGiveHookesLaw)
{
    Material hooke;
    hooke.m_poissonRatio = 0.42;
    Orthotropic m;
    m.m_poisson = {0.42, 0.42, 0.42};
    m.m_shear = {hooke.lameMu(), hooke.lameMu(), hooke.lameMu()};
    m.m_along = {1, 2, -0.5};
    m.m_across = {0, 1, 1};
    const Matrix6 C = matrixOf(m.stiffness()), expected = matrixOf(hooke.stiffness());
    EXPECT_LT((C - expected).cwiseAbs().maxCoeff(), 1e-14 * expected.maxCoeff());
    const Material material = orthotropicMaterial(m);
    EXPECT_NEAR(material.lameLambda(), hooke.lameLambda(), 1e-12 * hooke.lameLambda());
    EXPECT_NEAR(material.lameMu(), hooke.lameMu(), 1e-12 * hooke.lameMu());
}

// Axis 1 along y and axis 2 along z permute the constants.
TEST(Orthotropic, AxesTurnTheMaterial)
{
    Orthotropic turned = nineConstants();
    turned.m_along = {0, 3, 0};
    turned.m_across = {0, 0.5, 0.25};  // the component along axis 1 is ignored
    EXPECT_NEAR(determinant(turned.axes()), 1, 1e-14);
    const ElasticMatrix own = nineConstants().stiffness(), C = turned.stiffness();
    constexpr int kPlace[6] = {1, 2, 0, 4, 5, 3};  // 11 -> yy, 22 -> zz, 33 -> xx, 23 -> zx, 13 -> yx, 12 -> yz
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) EXPECT_NEAR(C(kPlace[i], kPlace[j]), own(i, j), 1e-3) << i << ", " << j;
}

TEST(Orthotropic, TransverselyIsotropicOnesDoNotNoticeATurnAboutTheFibres)
{
    Orthotropic m = Orthotropic::transverselyIsotropic(1e7, 4e5, 0.3, 0.45, 2e5);
    EXPECT_DOUBLE_EQ(m.m_shear[2], 4e5 / 2.9);
    m.m_along = {1, 1, 0};
    m.m_across = {0, 0, 1};
    const Matrix6 before = matrixOf(m.stiffness());
    m.m_across = {1, -1, 0.7};
    EXPECT_LT((matrixOf(m.stiffness()) - before).cwiseAbs().maxCoeff(), 1e-12 * before.maxCoeff());
}

TEST(Orthotropic, BadConstantsAreRefusedByName)
{
    const auto refused = [](void (*spoil)(Orthotropic&), std::initializer_list<const char*> parts)
    {
        Orthotropic constants = nineConstants();
        spoil(constants);
        expectRejected([&] { orthotropicMaterial(constants).validate(); }, parts);
    };
    EXPECT_TRUE(nineConstants().valid());
    refused([](Orthotropic& m) { m.m_young[1] = 0; }, {"E2 [Pa] is 0", "(0, 1e+13]"});
    refused([](Orthotropic& m) { m.m_young[2] = std::numeric_limits<double>::quiet_NaN(); }, {"E3 [Pa] is nan"});
    refused([](Orthotropic& m) { m.m_shear[1] = -1; }, {"G13 [Pa] is -1", "(0, 1e+13]"});
    refused([](Orthotropic& m) { m.m_shear[2] = 2e13; }, {"G23 [Pa] is 2e+13"});
    refused([](Orthotropic& m) { m.m_poisson[0] = 3.1; }, {"nu12 [-] is 3.1", "sqrt(E1 / E2)", "nu21 = nu12 E2 / E1"});
    refused([](Orthotropic& m) { m.m_poisson[2] = -1.5; }, {"nu23 [-] is -1.5", "(-1.414213562, 1.414213562)"});
    refused([](Orthotropic& m) { m.m_poisson = {2.5, 3.2, 1}; }, {"2 nu21 nu32 nu13 is -", "not above 0.004"});
    refused([](Orthotropic& m) { m.m_along = {}; }, {"axis 1 is (0, 0, 0)", "without a length"});
    refused([](Orthotropic& m) { m.m_across = {0, 0, std::numeric_limits<double>::infinity()}; }, {"axis 2 is"});
    refused([](Orthotropic& m) { m.m_across = {-2, 0, 0}; }, {"(1, 0, 0) and (-2, 0, 0), parallel"});
}

// Accepted constants have a positive definite C, also at the limits of the range.
TEST(Orthotropic, AcceptedConstantsArePositiveDefinite)
{
    int accepted = 0, least = 0;
    for (int k = 0; k < 4000; ++k)
    {
        Orthotropic m;
        const auto part = [k](int prime) { return std::fmod(k * std::sqrt(double(prime)), 1); };
        m.m_young = {std::pow(10, 4 * part(2)), std::pow(10, 4 * part(3)), std::pow(10, 4 * part(5))};
        for (int i = 0; i < 3; ++i)
        {
            const double bound = std::sqrt(m.m_young[i == 2 ? 1 : 0] / m.m_young[i == 0 ? 1 : 2]);
            m.m_poisson[i] = bound * (2 * part(7 + 4 * i) - 1);
            m.m_shear[i] = std::pow(10, 4 * part(13 + 6 * i));
        }
        m.m_along = {part(11), part(17), 0.1};
        if (!m.valid()) continue;
        ++accepted;
        const Matrix6 C = matrixOf(m.stiffness()), rest = C - matrixOf(isotropicStiffness(m.isotropicPart()));
        const auto minOf = [](const Matrix6& A) { return Eigen::SelfAdjointEigenSolver<Matrix6>(A).eigenvalues()(0); };
        least += minOf(C) > 0 && minOf(rest) > -1e-12 * C.maxCoeff() && m.isotropicPart().m_mu > 0;
    }
    EXPECT_GT(accepted, 500);
    EXPECT_EQ(least, accepted);
}

TEST(Orthotropic, RejectsIncompatibleOptions)
{
    Material material = orthotropicMaterial(nineConstants());
    EXPECT_FALSE(material.usesMeanDilatation());
    Material bending = material;
    bending.m_bending = Bending::accurate;
    EXPECT_TRUE(bending.valid());
    EXPECT_TRUE(bending.usesMeanDilatation());
    const auto refused = [&](void (*spoil)(Material&), std::initializer_list<const char*> parts)
    {
        Material bad = material;
        spoil(bad);
        expectRejected([&] { bad.validate(); }, parts);
    };
    refused([](Material& m) { m.m_meanDilatation = MeanDilatation::on; }, {"mean dilatation is on", "orthotropic law"});
    refused([](Material& m) { m.m_yieldStress = 1e5; }, {"yield stress [Pa] is 100000", "orthotropic law"});
    refused([](Material& m) { m.m_relaxation[0].m_share = .5; }, {"share is 0.5", "orthotropic law"});

    Material locking;
    locking.m_poissonRatio = 0.45;
    expectRejected(
        [&] {
            ElementMaterials::ofElements({material, locking}).validate(2);
        },
        {"region 1", "nu 0.45", "an orthotropic", "switch it off"});
    Material gel;
    gel.m_law = ElasticLaw::neoHooke;
    expectRejected([&] { ElementMaterials::ofElements({material, gel}).validate(2); }, {"region 1", "Neo-Hookean"});
    ElementMaterials::ofElements({material, Material()}).validate(2);
}

TEST(Orthotropic, MaterialsDifferByTheirConstantsAndDirections)
{
    const Material a = orthotropicMaterial(nineConstants());
    Material b = a;
    EXPECT_EQ(a, b);
    b.m_orthotropic.m_along = {1, 0.001, 0};
    EXPECT_NE(a, b);
    b = a, b.m_orthotropic.m_shear[1] *= 2;
    EXPECT_NE(a, b);
    Material plain, other;
    other.m_orthotropic = nineConstants();  // ignored by its law
    EXPECT_EQ(plain, other);
}

}  // namespace
}  // namespace bullet_fem
