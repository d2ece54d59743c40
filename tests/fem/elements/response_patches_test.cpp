// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Mean dilatation of elements whose law is evaluated in every step: kernels against the energy.
#include "bullet_fem/fem/step/stepping.h"
#include "bullet_fem/fem/step/stress.h"
#include "fem/common/rotation.h"
#include "fem/scenes/element_case.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

Material patched(ElasticLaw law, double nu)
{
    Material material = elasticMaterial(1e4, nu);
    material.m_law = law;
    material.m_meanDilatation = MeanDilatation::on;
    if (law == ElasticLaw::ogden) material.m_lawConstants = {4e3, 1.3, 20, 5, -100, -2};
    return material;
}

// Every other cell has Hooke's law with mean dilatation if `mixed`.
ElementMaterials patchedRegions(const TetMesh& mesh, ElasticLaw law, double nu, bool mixed)
{
    if (!mixed) return patched(law, nu);
    std::vector<Material> perElement;
    for (int e = 0; e < mesh.tetCount(); ++e)
        perElement.push_back(patched(e / 6 % 2 == 0 ? law : ElasticLaw::hooke, nu));
    return ElementMaterials::ofElements(perElement);
}

struct PatchCase
{
    ElasticLaw m_law;
    bool m_mixed;
};

const PatchCase kPatchCases[] = {
    {ElasticLaw::neoHooke, false}, {ElasticLaw::neoHooke, true}, {ElasticLaw::ogden, false}};

class ResponsePatches : public OnTarget
{
protected:
    void deform(const TetMesh& mesh, double height, double size)
    {
        RandomVectors random(9);
        const Mat3 Q = rotationAbout({1, -2, 3}, 2);
        m_x.clear();
        for (const Vec3& X : mesh.restPositions())
            m_x.push_back(Q * (Vec3{X.x, height * X.y, X.z} + size * mesh.meanEdgeLength() * random.next()));
        m_v.assign(m_x.size(), Vec3());
    }

    std::vector<Vec3> m_x, m_v;
};

TEST_P(ResponsePatches, ForcesAreTheGradientOfTheEnergy)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {2, 1, 2}, {}, CellSplit::kuhnSix);
    for (const PatchCase& c : kPatchCases)
        for (const double nu : {.3, .49})
            for (const double height : {1.2, .6})
            {
                deform(mesh, height, .05);
                Body body = makeBody(mesh, patchedRegions(mesh, c.m_law, nu, c.m_mixed));
                ASSERT_FALSE(body.m_model->shape().m_patches.empty());
                ElementCase<double> kernels(body.m_model->shape(), m_x, m_v);
                std::vector<TangentBlock<double>> tangent(kernels.m_elements.blockCount());
                ElementPass<double> pass = kernels.pass();
                pass.m_tangent = tangent.data();
                runElementPass(pass, kernels.blocks());
                const std::vector<Vec3> f = kernels.cornerSums();
                const double d = 1e-6;
                for (std::size_t i = 0; i < m_x.size(); ++i)
                    for (int axis = 0; axis < 3; ++axis)
                    {
                        double energy[2];
                        for (const int side : {0, 1})
                        {
                            body.m_state.m_x = m_x;
                            body.m_state.m_x[i][axis] += side == 0 ? -d : d;
                            energy[side] = mechanicalEnergy(body);
                        }
                        EXPECT_NEAR(f[i][axis], -(energy[1] - energy[0]) / (2 * d), 1e-5 * largest(f))
                            << static_cast<int>(c.m_law) << c.m_mixed << nu << height;
                    }
            }
}

// The tangent is symmetric, and at rest that of the law without strain.
TEST_P(ResponsePatches, ProductIsTheDerivativeAtRestAndSymmetric)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {2, 1, 2}, {}, CellSplit::kuhnSix);
    for (const PatchCase& c : kPatchCases)
        for (const double height : {1.0, .7})
        {
            deform(mesh, height, height == 1 ? 0 : .05);
            const RestShape shape(mesh, patchedRegions(mesh, c.m_law, .45, c.m_mixed));
            const auto passAt = [&](ElementCase<double>& kernels, std::vector<TangentBlock<double>>& tangent)
            {
                tangent.resize(kernels.m_elements.blockCount());
                ElementPass<double> pass = kernels.pass();
                pass.m_tangent = tangent.data();
                runElementPass(pass, kernels.blocks());
                return kernels.cornerSums();
            };
            ElementCase<double> kernels(shape, m_x, m_v);
            std::vector<TangentBlock<double>> tangent, unused;
            passAt(kernels, tangent);
            RandomVectors random(3);
            std::vector<Vec3> p, q;
            for (std::size_t i = 0; i < m_x.size(); ++i) p.push_back(random.next()), q.push_back(random.next());
            const auto times = [&](const std::vector<Vec3>& u)
            {
                const std::vector<PaddedVec3> in = padded(u);
                ElementProduct<double> product = kernels.product(in);
                product.m_tangent = tangent.data();
                runElementProduct(product, kernels.blocks());
                return kernels.cornerSums();
            };
            const std::vector<Vec3> Ap = times(p), Aq = times(q);
            double pAq = 0, qAp = 0;
            for (std::size_t i = 0; i < p.size(); ++i) pAq += dot(p[i], Aq[i]), qAp += dot(q[i], Ap[i]);
            EXPECT_NEAR(pAq, qAp, 1e-9 * std::fabs(pAq) + 1e-12);
            if (height != 1) continue;
            const double d = 1e-6;
            std::vector<Vec3> up = m_x, down = m_x;
            for (std::size_t i = 0; i < p.size(); ++i) up[i] += d * p[i], down[i] -= d * p[i];
            ElementCase<double> above(shape, up, m_v), below(shape, down, m_v);
            const std::vector<Vec3> fUp = passAt(above, unused), fDown = passAt(below, unused);
            for (std::size_t i = 0; i < p.size(); ++i)
            {
                const Vec3 exact = -1 / (2 * d) * (fUp[i] - fDown[i]);
                const Vec3 found = 1 / kernels.kStiffnessFactor * Ap[i];
                EXPECT_LE(norm(found - exact), 1e-4 * largest(Ap) / kernels.kStiffnessFactor);
            }
        }
}

INSTANTIATE_TEST_SUITE_P(Targets, ResponsePatches, testing::ValuesIn(availableTargets()), targetName);

// Bending of a bar of few elements near nu .5 under a small load: as Hooke's law with mean dilatation.
TEST(ResponsePatchSteps, DoNotLockNearTheIncompressible)
{
    const auto tip = [](ElasticLaw law, MeanDilatation choice)
    {
        Material material = patched(law, .49);
        material.m_youngModulus = 1e6;
        material.m_meanDilatation = choice;
        if (law == ElasticLaw::ogden) material.m_lawConstants = {1e6 / 1.49, 1, 0, 0, 0, 0};
        Body bar = makeBody(
            makeBox({4, 1, 1}, {8, 2, 2}, {}, CellSplit::kuhnSix), material, [](const Vec3& X) { return X.x == 0; },
            .1);
        StepSettings settings;
        settings.m_step = .1;
        settings.m_tolerance = 1e-5;
        for (int k = 0; k < 100; ++k)
        {
            std::fill(bar.m_state.m_v.begin(), bar.m_state.m_v.end(), Vec3());
            for (std::size_t i = 0; i < bar.m_state.m_x.size(); ++i)
                bar.m_loads.m_force[i] = bar.m_model->mesh().restPositions()[i].x > 4 - 1e-9 ? Vec3{0, -1, 0} : Vec3();
            bullet_fem::step(bar, settings);
        }
        return -bar.m_state.m_x[nodeAt(bar.m_model->mesh(), {4, 0, 0})].y;
    };
    const double hooke = tip(ElasticLaw::hooke, MeanDilatation::on);
    EXPECT_LT(tip(ElasticLaw::neoHooke, MeanDilatation::off), .4 * hooke);
    EXPECT_NEAR(tip(ElasticLaw::neoHooke, MeanDilatation::on) / hooke, 1, .1);
    EXPECT_NEAR(tip(ElasticLaw::ogden, MeanDilatation::on) / hooke, 1, .1);
}

}  // namespace
}  // namespace bullet_fem
