// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The Neo-Hookean law against the formulas of homogeneous strain (docs/materials.md, Large strain).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "bullet_fem/fem/step/stress.h"
#include "fem/common/rotation.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

constexpr double kNeoHookeYoung = 1e6;

Material neoHookean(double nu = 0.3, double young = kNeoHookeYoung)
{
    Material material = elasticMaterial(young, nu);
    material.m_law = ElasticLaw::neoHooke;
    return material;
}

// J g'(J) of W = mu/2 (I - 3) - mu ln J + lambda/4 (J^2 - 1 - 2 ln J) [Pa].
double neoHookeVolumeTerm(const Material& material, double J)
{
    return 0.5 * material.lameLambda() * (J * J - 1) - material.lameMu();
}

// The zero of an increasing function.
double rootOf(const std::function<double(double)>& f, double low, double high)
{
    for (int k = 0; k < 200; ++k)
    {
        const double middle = 0.5 * (low + high);
        (f(middle) < 0 ? low : high) = middle;
    }
    return low;
}

// Nominal stress at a given stretch: of a bar with free sides, and of a sheet in equibiaxial tension.
double uniaxialStress(const Material& material, double stretch)
{
    const double mu = material.lameMu();
    const auto side = [&](double s) { return mu * s * s + neoHookeVolumeTerm(material, stretch * s * s); };
    const double s = rootOf(side, 1e-6, 10);
    return (mu * stretch * stretch + neoHookeVolumeTerm(material, stretch * s * s)) / stretch;
}

double equibiaxialStress(const Material& material, double stretch)
{
    const double mu = material.lameMu();
    const auto side = [&](double s) { return mu * s * s + neoHookeVolumeTerm(material, stretch * stretch * s); };
    const double s = rootOf(side, 1e-6, 10);
    return (mu * stretch * stretch + neoHookeVolumeTerm(material, stretch * stretch * s)) / stretch;
}

// A free block with tractions on its faces across some axes.
class PulledBlock
{
public:
    PulledBlock(const Material& material, int axes)
        : m_axes(axes), m_body(makeBody(makeBox({1, 1, 1}, {2, 2, 2}, {}, CellSplit::kuhnSix), material, {}, 0.02))
    {
        const TetMesh& mesh = m_body.m_model->mesh();
        for (int axis = 0; axis < axes; ++axis)
            for (const double side : {0.0, 1.0})
                m_faces[axis].push_back(
                    faceAreas(mesh, [=](const Vec3& X) { return std::fabs(X[axis] - side) < 1e-9; }));
    }

    // The stretch of the first axis at equilibrium under a nominal stress [Pa].
    double pull(double stress)
    {
        StepSettings settings;
        settings.m_step = m_body.m_model->factorInput().m_step;
        settings.m_tolerance = 1e-6;
        double moved = 1;
        for (int k = 0; k < 600 && moved > 1e-5; ++k)
        {
            const std::vector<Vec3> before = m_body.m_state.m_x;
            std::fill(m_body.m_loads.m_force.begin(), m_body.m_loads.m_force.end(), Vec3());
            for (int axis = 0; axis < m_axes; ++axis)
            {
                const Vec3 along = faceDistance(axis);
                for (std::size_t i = 0; i < before.size(); ++i)
                    m_body.m_loads.m_force[i] +=
                        stress * (m_faces[axis][1][i] - m_faces[axis][0][i]) / norm(along) * along;
            }
            std::fill(m_body.m_state.m_v.begin(), m_body.m_state.m_v.end(), Vec3());
            bullet_fem::step(m_body, settings);
            moved = largestDistance(before, m_body.m_state.m_x);
        }
        EXPECT_LE(moved, 1e-5);
        return norm(faceDistance(0));
    }

    Body& body() { return m_body; }

private:
    Vec3 faceDistance(int axis) const
    {
        const std::vector<Vec3>& x = m_body.m_state.m_x;
        return weightedMean(m_faces[axis][1], x) - weightedMean(m_faces[axis][0], x);
    }

    int m_axes;
    Body m_body;
    std::vector<std::vector<double>> m_faces[3];
};

TEST(NeoHooke, BarsStretchAsTheFormulaSays)
{
    for (const double nu : {0.0, 0.3, 0.45})
    {
        PulledBlock bar(neoHookean(nu), 1);
        for (const double stretch : {1.01, 1.2, 1.5, 2.0, 1.2, 0.8})
        {
            EXPECT_NEAR(bar.pull(uniaxialStress(neoHookean(nu), stretch)), stretch, 1e-4 * stretch) << nu;
            EXPECT_GT(smallestVolumeRatio(bar.body()), 0);
        }
    }
}

TEST(NeoHooke, SheetsStretchAsTheFormulaSays)
{
    for (const double nu : {0.0, 0.3, 0.45})
    {
        PulledBlock sheet(neoHookean(nu), 2);
        for (const double stretch : {1.01, 1.2, 1.5, 2.0})
            EXPECT_NEAR(sheet.pull(equibiaxialStress(neoHookean(nu), stretch)), stretch, 1e-4 * stretch) << nu;
    }
}

// A block whose surface nodes are prescribed by the deformation gradient F; the inner nodes are free.
class LedBlock
{
public:
    explicit LedBlock(const Material& material)
        : m_body(makeBody(makeBox({1, 1, 1}, {3, 3, 3}, {}, CellSplit::kuhnSix), material,
                          [](const Vec3& X) {
                              return std::min({X.x, X.y, X.z}) < 1e-9 || std::max({X.x, X.y, X.z}) > 1 - 1e-9;
                          }))
    {
    }

    void lead(const Mat3& F, int steps)
    {
        const StepSettings settings;
        const std::vector<Vec3>& X = m_body.m_model->mesh().restPositions();
        const std::vector<Vec3> from = m_body.m_state.m_x;
        for (int k = 0; k < steps + 60; ++k)
        {
            for (std::size_t i = 0; i < X.size(); ++i)
                if (m_body.m_state.m_fixed[i])
                    m_body.m_loads.m_targetVelocity[i] =
                        k < steps ? 1 / (steps * settings.m_step) * (F * X[i] - from[i]) : Vec3();
            if (k >= steps) std::fill(m_body.m_state.m_v.begin(), m_body.m_state.m_v.end(), Vec3());
            bullet_fem::step(m_body, settings);
        }
    }

    // P of an element: its stress is P R^T.
    Mat3 nominalStress(int e, const Mat3& F) const
    {
        return toMatrix(elementStress(m_body, e)) * polarRotation(F, Mat3::identity());
    }

    Body m_body;
};

// dW/dF = mu F + g'(J) cof F.
Mat3 nominalStress(const Material& material, const Mat3& F)
{
    const double J = determinant(F);
    return material.lameMu() * F + neoHookeVolumeTerm(material, J) * transpose(inverse(F));
}

// Simple shear to 100 %, compression to a tenth of the height, and both combined.
TEST(NeoHooke, PrescribedBlocksHaveTheStressOfTheFormula)
{
    for (const double nu : {0.0, 0.3, 0.45})
    {
        LedBlock block(neoHookean(nu));
        for (const Mat3& F : {Mat3{{{1, 0.25, 0}, {0, 1, 0}, {0, 0, 1}}}, Mat3{{{1, 1, 0}, {0, 1, 0}, {0, 0, 1}}},
                              Mat3{{{1, 0.5, 0}, {0, 0.4, 0}, {0, 0, 1}}}, Mat3{{{1, 0, 0}, {0, 0.11, 0}, {0, 0, 1}}},
                              Mat3{{{1.4, 0.3, 0}, {0, 0.3, 0}, {0, -0.2, 1.2}}}})
        {
            block.lead(F, 60);
            const Mat3 P = nominalStress(neoHookean(nu), F);
            for (int e = 0; e < block.m_body.m_model->mesh().tetCount(); ++e)
                ASSERT_LE(squaredNorm(block.nominalStress(e, F) - P), 1e-6 * squaredNorm(P)) << nu << ", " << e;
        }
    }
}

// At small strain the law equals Hooke's with equal E and nu, with an error of second order.
TEST(NeoHooke, IsHookesAtSmallStrain)
{
    for (const double nu : {0.0, 0.3, 0.45})
    {
        Material hookean = elasticMaterial(kNeoHookeYoung, nu);
        hookean.m_meanDilatation = MeanDilatation::off;
        Body bodies[] = {makeBody(makeBox({1, 0.5, 0.5}, {4, 2, 2}), hookean),
                         makeBody(makeBox({1, 0.5, 0.5}, {4, 2, 2}), neoHookean(nu))};
        constexpr double kSmall = 1e-4;
        RandomVectors random(3);
        for (std::size_t i = 0; i < bodies[0].m_state.m_x.size(); ++i)
        {
            const Vec3 u = 0.2 * kSmall * random.next();
            for (Body& body : bodies) body.m_state.m_x[i] += u;
        }
        EXPECT_NEAR(mechanicalEnergy(bodies[1]), mechanicalEnergy(bodies[0]),
                    10 * kSmall * mechanicalEnergy(bodies[0]));
        for (int e = 0; e < 40; ++e)
        {
            const Stress a = elementStress(bodies[0], e), b = elementStress(bodies[1], e);
            const SymmetricTensor difference = b + -1.0 * a;
            EXPECT_LE(contraction(difference, difference), 10 * kSmall * contraction(a, a));
        }
        for (int k = 0; k < 20; ++k)
            for (Body& body : bodies) bullet_fem::step(body, StepSettings());
        EXPECT_LE(largestDistance(bodies[0].m_state.m_x, bodies[1].m_state.m_x), 0.01 * kSmall);
    }
}

// Layers of both laws in tension: each has the stress of its own law.
TEST(NeoHooke, StandsBesideHookesInRegions)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {3, 2, 2}, {}, CellSplit::kuhnSix);
    std::vector<Material> perElement;
    for (const Tet& tet : mesh.tets())
    {
        const std::vector<Vec3>& X = mesh.restPositions();
        const Vec3 centre = 0.25 * (X[tet[0]] + X[tet[1]] + X[tet[2]] + X[tet[3]]);
        perElement.push_back(centre.z < 0.5 ? neoHookean() : elasticMaterial(kNeoHookeYoung, 0.3));
    }
    Body body = makeBody(mesh, ElementMaterials::ofElements(perElement), [](const Vec3&) { return true; });
    const Mat3 F = {{{1.5, 0, 0}, {0, 0.8, 0}, {0, 0, 0.9}}};
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i) body.m_state.m_x[i] = F * mesh.restPositions()[i];
    bullet_fem::step(body, StepSettings());
    const Mat3 P = nominalStress(neoHookean(), F), e = F - Mat3::identity();
    const Material& hookean = perElement.back();
    const Mat3 sigma = 2 * hookean.lameMu() * e + Mat3::diagonal(hookean.lameLambda() * trace(e));
    for (int k = 0; k < mesh.tetCount(); ++k)
    {
        const Mat3& expected = perElement[k].m_law == ElasticLaw::neoHooke ? P : sigma;
        EXPECT_LE(squaredNorm(toMatrix(elementStress(body, k)) - expected), 1e-12 * squaredNorm(expected));
    }
}

TEST(NeoHooke, RejectsIncompatibleOptions)
{
    const auto refusal = [](Material material)
    {
        std::string why;
        EXPECT_FALSE(material.valid(&why));
        return why;
    };
    Material material = neoHookean();
    EXPECT_TRUE(material.valid());
    material.m_yieldStress = 1e3;
    EXPECT_NE(refusal(material).find("yield stress [Pa] is 1000 with the Neo-Hookean law"), std::string::npos);
    material = neoHookean();
    material.m_relaxation[0] = {0.3, 1};
    EXPECT_NE(refusal(material).find("relaxation term 0: its share is 0.3"), std::string::npos);
    material = neoHookean();
    material.m_law = static_cast<ElasticLaw>(7);
    EXPECT_NE(refusal(material).find("elastic law is 7, outside [0, "), std::string::npos);
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    std::vector<Material> perElement(5, neoHookean(0.45));
    perElement[2] = elasticMaterial(kNeoHookeYoung, 0.45);
    EXPECT_NO_THROW(RestShape(mesh, ElementMaterials::ofElements(perElement)));
    perElement[2].m_bending = Bending::accurate;
    EXPECT_NO_THROW(RestShape(mesh, ElementMaterials::ofElements(perElement)));
    perElement[2].m_bending = Bending::plain;
    perElement[2].m_meanDilatation = MeanDilatation::off;
    perElement[2].m_law = ElasticLaw::orthotropic;
    expectRejected([&] { RestShape(mesh, ElementMaterials::ofElements(perElement)); },
                   {"the Neo-Hookean law", "beside an orthotropic region", "the law hooke"});
}

}  // namespace
}  // namespace bullet_fem
