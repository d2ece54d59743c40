// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The Neo-Hookean law in the element kernels: against its energy, and against plain C++.
#include "fem/common/rotation.h"
#include "fem/laws/neo_hooke.h"
#include "fem/scenes/element_case.h"
#include "fem/scenes/reference_elements.h"

namespace bullet_fem
{
namespace
{

Material neoHookeanAt(double nu)
{
    Material material = elasticMaterial(1e4, nu);
    material.m_law = ElasticLaw::neoHooke;
    return material;
}

// W of F by its invariants, with the parabola below J0.
double energyDensity(const Material& material, const Mat3& F)
{
    const double mu = material.lameMu(), lambda = material.lameLambda();
    const auto g = [&](double J) { return 0.25 * lambda * (J * J - 1) - (0.5 * lambda + mu) * std::log(J); };
    const double J = determinant(F), J0 = 0.1;
    const double slope = 0.5 * lambda * (J0 - 1 / J0) - mu / J0, curvature = 0.5 * lambda * (1 + 100) + 100 * mu;
    const double volume = J >= J0 ? g(J) : g(J0) + slope * (J - J0) + 0.5 * curvature * (J - J0) * (J - J0);
    return 0.5 * mu * (squaredNorm(F) - 3) + volume;
}

Mat3 gradientOf(const RestShape& shape, int e, const std::vector<Vec3>& x)
{
    const Tet& tet = shape.m_mesh.tets()[e];
    return Mat3::fromColumns(x[tet[1]] - x[tet[0]], x[tet[2]] - x[tet[0]], x[tet[3]] - x[tet[0]]) *
           shape.m_elements[e].m_DmInverse;
}

double energyOf(const RestShape& shape, const std::vector<Vec3>& x)
{
    double sum = 0;
    for (std::size_t e = 0; e < shape.m_elements.size(); ++e)
        sum += shape.m_elements[e].m_volume *
               energyDensity(shape.materialOf(static_cast<int>(e)), gradientOf(shape, static_cast<int>(e), x));
    return sum;
}

class NeoHookeKernel : public OnTarget
{
protected:
    // Turned by 2 rad, crushed to `height` and strained at random by `size`.
    void deform(const TetMesh& mesh, double height, double size)
    {
        RandomVectors random(9);
        const Mat3 Q = rotationAbout({1, -2, 3}, 2);
        m_x.clear();
        for (const Vec3& X : mesh.restPositions())
            m_x.push_back(Q * (Vec3{X.x, height * X.y, X.z} + size * mesh.meanEdgeLength() * random.next()));
        m_v.assign(m_x.size(), Vec3());
    }

    template <class Real>
    static std::vector<Vec3> forces(ElementCase<Real>& kernels, std::vector<TangentBlock<Real>>& tangent)
    {
        tangent.resize(kernels.m_elements.blockCount());
        ElementPass<Real> pass = kernels.pass();
        pass.m_tangent = tangent.data();
        runElementPass(pass, kernels.blocks());
        return kernels.cornerSums();
    }

    std::vector<Vec3> m_x, m_v;
};

// Central differences of the energy; also where elements are flat and inside out.
TEST_P(NeoHookeKernel, ForcesAreTheGradientOfTheEnergy)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {2, 2, 2}, {}, CellSplit::kuhnSix);
    for (const double nu : {0.0, 0.3, 0.45})
        for (const double height : {1.2, 0.6, 0.15, -0.2})
        {
            deform(mesh, height, 0.05);
            const RestShape shape(mesh, neoHookeanAt(nu));
            ElementCase<double> kernels(shape, m_x, m_v);
            std::vector<TangentBlock<double>> tangent;
            const std::vector<Vec3> f = forces(kernels, tangent);
            const double d = 1e-6 * mesh.meanEdgeLength();
            for (std::size_t i = 0; i < m_x.size(); ++i)
                for (int c = 0; c < 3; ++c)
                {
                    std::vector<Vec3> up = m_x, down = m_x;
                    up[i][c] += d, down[i][c] -= d;
                    const double slope = (energyOf(shape, up) - energyOf(shape, down)) / (2 * d);
                    EXPECT_NEAR(f[i][c], -slope, 2e-6 * largest(f)) << nu << ", " << height << ", " << i << ", " << c;
                }
        }
}

TEST_P(NeoHookeKernel, MatchesItsScalarReference)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {4, 2, 2}, {}, CellSplit::kuhnSix);
    std::vector<Material> perElement(mesh.tetCount(), neoHookeanAt(0.3));  // both laws in neighbouring elements
    for (std::size_t e = 0; e < perElement.size(); e += 3) perElement[e].m_law = ElasticLaw::hooke;
    const RestShape shape(mesh, ElementMaterials::ofElements(perElement));
    for (const double height : {1.2, 0.5, 0.12})
    {
        deform(mesh, height, 0.03);
        RandomVectors random(4);
        for (Vec3& v : m_v) v = random.next();
        ElementCase<float> kernels(shape, m_x, m_v), twin(shape, m_x, m_v);
        std::vector<TangentBlock<float>> tangent, expected(twin.m_elements.blockCount());
        const std::vector<Vec3> f = forces(kernels, tangent);
        ElementPass<float> pass = twin.pass();
        pass.m_tangent = expected.data();
        reference::runElementPass(pass, twin.blocks());
        const std::vector<Vec3> fOfTwin = twin.cornerSums();
        EXPECT_LE(largestDistance(f, fOfTwin), 1e-5 * largest(f));
        const std::vector<PaddedVec3> p = padded(m_v);
        ElementProduct<float> product = kernels.product(p), productOfTwin = twin.product(p);
        product.m_tangent = tangent.data(), productOfTwin.m_tangent = expected.data();
        runElementProduct(product, kernels.blocks());
        reference::runElementProduct(productOfTwin, twin.blocks());
        const std::vector<Vec3> Ap = kernels.cornerSums(), ApOfTwin = twin.cornerSums();
        EXPECT_LE(largestDistance(Ap, ApOfTwin), 2e-5 * largest(Ap)) << height;
    }
}

// The tangent in A: the exact derivative of the forces at rest, and an upper bound of it along directions that stretch
// or compress an element.
TEST_P(NeoHookeKernel, TangentIsHookesAtRestAndCoversTheLaws)
{
    const TetMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    for (const double nu : {0.0, 0.3, 0.45})
        for (const Mat3& F : {Mat3::identity(), Mat3{{{2, 0, 0}, {0, 0.75, 0}, {0, 0, 0.75}}},
                              Mat3{{{2, 0, 0}, {0, 2, 0}, {0, 0, 0.5}}}, Mat3{{{1, 0, 0}, {0, 0.12, 0}, {0, 0, 1}}},
                              Mat3::diagonal(0.5)})
        {
            const RestShape shape(mesh, neoHookeanAt(nu));
            m_x.clear();
            for (const Vec3& X : mesh.restPositions()) m_x.push_back(F * X);
            m_v.assign(4, Vec3());
            ElementCase<double> kernels(shape, m_x, m_v);
            std::vector<TangentBlock<double>> tangent;
            forces(kernels, tangent);
            const double V = shape.m_elements[0].m_volume, d = 1e-4;
            for (int axis = 0; axis < 3; ++axis)
            {
                std::vector<Vec3> u;
                for (const Vec3& X : mesh.restPositions())
                {
                    u.emplace_back();
                    u.back()[axis] = X[axis];
                }
                const std::vector<PaddedVec3> p = padded(u);
                ElementProduct<double> product = kernels.product(p);
                product.m_tangent = tangent.data();
                runElementProduct(product, kernels.blocks());
                const std::vector<Vec3> Au = kernels.cornerSums();
                double covered = 0;
                for (std::size_t i = 0; i < u.size(); ++i) covered += dot(u[i], Au[i]) / kernels.kStiffnessFactor;
                Mat3 step;
                step(axis, axis) = d;
                const Material material = neoHookeanAt(nu);
                const double second = V / (d * d) *
                                      (energyDensity(material, F + step) - 2 * energyDensity(material, F) +
                                       energyDensity(material, F - step));
                EXPECT_GE(covered, 0.999 * second) << nu << ", " << axis;
                const double most = squaredNorm(F - Mat3::identity()) == 0 ? 1.001 * second : 1e9;
                EXPECT_LE(covered, most);
            }
        }
}

// Flat, collapsed and inverted elements have finite forces that restore their orientation.
TEST_P(NeoHookeKernel, DegenerateElementsAreDrivenBack)
{
    const TetMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const RestShape shape(mesh, neoHookeanAt(0.3));
    m_v.assign(4, Vec3());
    for (const double height : {0.0, 0.05, -0.3, -1.0})
    {
        m_x.clear();
        for (const Vec3& X : mesh.restPositions()) m_x.push_back({X.x, X.y, height * X.z});
        ElementCase<float> kernels(shape, m_x, m_v);
        std::vector<TangentBlock<float>> tangent;
        const std::vector<Vec3> f = forces(kernels, tangent);
        for (const Vec3& force : f) EXPECT_LT(norm(force), 1e9);
        EXPECT_GT(f[3].z, 5 * 1e4 / 6) << height;  // 10 E on the face, V 1/6
    }
    m_x.assign(4, Vec3());
    ElementCase<float> kernels(shape, m_x, m_v);
    std::vector<TangentBlock<float>> tangent;
    for (const Vec3& force : forces(kernels, tangent)) EXPECT_LT(norm(force), 1e9);
}

INSTANTIATE_TEST_SUITE_P(Targets, NeoHookeKernel, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
