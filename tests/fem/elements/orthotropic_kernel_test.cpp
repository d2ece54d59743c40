// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The kernels of orthotropic elements: against the energy, the kernels of Hooke's law, and plain C++.
#include "fem/common/rotation.h"
#include "fem/elements/orthotropic_elements.h"
#include "fem/scenes/element_case.h"
#include "fem/scenes/reference_elements.h"

namespace bullet_fem
{
namespace
{

// Oblique fibres, twenty times as stiff as the matrix.
Material fibrous()
{
    Material material = elasticMaterial(1e4, 0.3);
    material.m_law = ElasticLaw::orthotropic;
    material.m_orthotropic.m_young = {2e5, 1e4, 3e4};
    material.m_orthotropic.m_poisson = {0.35, 0.3, 0.2};
    material.m_orthotropic.m_shear = {8e3, 5e3, 9e3};
    material.m_orthotropic.m_along = {1, 0.6, -0.3};
    material.m_orthotropic.m_across = {0, 0.2, 1};
    return material;
}

// The isotropic material `hooke` as nine orthotropic constants.
Material inNineConstants(Material hooke)
{
    Orthotropic& m = hooke.m_orthotropic;
    m.m_young.fill(hooke.m_youngModulus);
    m.m_poisson.fill(hooke.m_poissonRatio);
    m.m_shear.fill(hooke.lameMu());
    m.m_along = {1, -2, 0.5};
    m.m_across = {3, 1, 1};
    hooke.m_law = ElasticLaw::orthotropic;
    return hooke;
}

double orthotropicEnergy(const RestShape& shape, const std::vector<Vec3>& x)
{
    double sum = 0;
    for (std::size_t e = 0; e < shape.m_elements.size(); ++e)
    {
        const Tet& tet = shape.m_mesh.tets()[e];
        const RestElement& element = shape.m_elements[e];
        const Mat3 F = Mat3::fromColumns(x[tet[1]] - x[tet[0]], x[tet[2]] - x[tet[0]], x[tet[3]] - x[tet[0]]) *
                       element.m_DmInverse;
        const SymmetricTensor strain =
            symmetricPart(transposeTimes(polarRotation(F, Mat3::identity()), F) - Mat3::identity());
        const ElasticMatrix C = shape.materialOf(static_cast<int>(e)).stiffness();
        sum += 0.5 * element.m_volume * contraction(strain, stressOf(C, strain));
    }
    return sum;
}

template <class Real>
struct OrthotropicCase : ElementCase<Real>
{
    OrthotropicCase(const RestShape& shape, const std::vector<Vec3>& x, const std::vector<Vec3>& v)
        : ElementCase<Real>(shape, x, v), m_orthotropic(this->m_elements.blockCount())
    {
    }

    std::vector<Vec3> forces()
    {
        runOrthotropicPass(StretchPass<Real>{this->pass(), m_orthotropic.data()}, this->blocks());
        return this->cornerSums();
    }
    std::vector<Vec3> times(const std::vector<Vec3>& p)
    {
        const std::vector<PaddedVec3> in = padded(p);
        runOrthotropicProduct(StretchProduct<Real>{this->product(in), m_orthotropic.data()}, this->blocks());
        return this->cornerSums();
    }

    std::vector<StretchBlock<Real>> m_orthotropic;
};

class OrthotropicKernel : public OnTarget
{
protected:
    // Rotates by 2 rad, compresses to `height` and adds random strain of `size`.
    void deform(double height, double size)
    {
        RandomVectors random(9);
        const Mat3 Q = rotationAbout({1, -2, 3}, 2);
        m_x.clear(), m_v.clear();
        for (const Vec3& X : m_mesh.restPositions())
            m_x.push_back(Q * (Vec3{X.x, height * X.y, X.z} + size * m_mesh.meanEdgeLength() * random.next()));
        for (std::size_t i = 0; i < m_x.size(); ++i) m_v.push_back(random.next());
    }

    const TetMesh m_mesh = makeBox({1, 0.6, 0.5}, {4, 2, 2}, {}, CellSplit::kuhnSix);
    std::vector<Vec3> m_x, m_v;
};

// Central differences of the energy. Without the torque-balance term W the error would be strain times force.
TEST_P(OrthotropicKernel, ForcesAreTheGradientOfTheEnergy)
{
    const RestShape shape(m_mesh, fibrous());
    for (const double height : {1.0, 1.3, 0.6})
    {
        deform(height, 0.05);
        OrthotropicCase<double> kernels(shape, m_x, std::vector<Vec3>(m_x.size()));
        const std::vector<Vec3> f = kernels.forces();
        const double d = 1e-6 * m_mesh.meanEdgeLength();
        for (std::size_t i = 0; i < m_x.size(); ++i)
            for (int c = 0; c < 3; ++c)
            {
                std::vector<Vec3> up = m_x, down = m_x;
                up[i][c] += d, down[i][c] -= d;
                const double slope = (orthotropicEnergy(shape, up) - orthotropicEnergy(shape, down)) / (2 * d);
                EXPECT_NEAR(f[i][c], -slope, 2e-6 * largest(f)) << height << ", " << i << ", " << c;
            }
    }
}

TEST_P(OrthotropicKernel, ElementsHaveNoTorqueAndNoForceOfTheirOwn)
{
    const RestShape shape(m_mesh, fibrous());
    deform(0.7, 0.1);
    OrthotropicCase<double> kernels(shape, m_x, std::vector<Vec3>(m_x.size()));
    const std::vector<Vec3> f = kernels.forces();
    Vec3 sum, torque;
    for (std::size_t i = 0; i < f.size(); ++i) sum += f[i], torque += cross(m_x[i], f[i]);
    EXPECT_LT(norm(sum), 1e-6 * largest(f));  // quaternions are in single precision
    EXPECT_LT(norm(torque), 1e-6 * largest(f));
}

TEST_P(OrthotropicKernel, MatchesItsScalarReference)
{
    const RestShape shape(m_mesh, fibrous());
    for (const double height : {1.2, 0.5, 0.12})
    {
        deform(height, 0.03);
        OrthotropicCase<float> kernels(shape, m_x, m_v), twin(shape, m_x, m_v);
        RandomVectors random(4);
        std::vector<StressBlock<float>> stress(kernels.m_elements.blockCount());
        for (StressBlock<float>& block : stress)
            for (auto& entries : block.m_entry)
                for (float& value : entries) value = static_cast<float>(5 * random.next().x);
        const auto withStress = [&](OrthotropicCase<float>& which)
        {
            ElementPass<float> pass = which.pass();
            pass.m_initialStress = stress.data();
            return StretchPass<float>{pass, which.m_orthotropic.data()};
        };
        runOrthotropicPass(withStress(kernels), kernels.blocks());
        const std::vector<Vec3> f = kernels.cornerSums();
        reference::runOrthotropicPass(withStress(twin), twin.blocks());
        EXPECT_LE(largestDistance(f, twin.cornerSums()), 1e-5 * largest(f)) << height;
        const std::vector<Vec3> Ap = kernels.times(m_v);
        const std::vector<PaddedVec3> p = padded(m_v);
        reference::runOrthotropicProduct(StretchProduct<float>{twin.product(p), twin.m_orthotropic.data()},
                                         twin.blocks());
        EXPECT_LE(largestDistance(Ap, twin.cornerSums()), 2e-5 * largest(Ap)) << height;
    }
}

// With isotropic constants the results are those of Hooke's law.
TEST_P(OrthotropicKernel, IsotropicConstantsGiveHookesLaw)
{
    const Material hooke = elasticMaterial(1e4, 0.35);
    const RestShape plain(m_mesh, hooke), shape(m_mesh, inNineConstants(hooke));
    deform(0.8, 0.1);
    ElementCase<double> expected(plain, m_x, m_v);
    OrthotropicCase<double> kernels(shape, m_x, m_v);
    const std::vector<Vec3> f = expected.forces(), found = kernels.forces();
    EXPECT_LE(largestDistance(found, f), 1e-13 * largest(f));
    const std::vector<Vec3> Ap = expected.times(m_v);
    EXPECT_LE(largestDistance(kernels.times(m_v), Ap), 2e-6 * largest(Ap));  // tension near a double eigenvalue
    ElementCase<float> single(plain, m_x, m_v);
    OrthotropicCase<float> singleKernels(shape, m_x, m_v);
    const std::vector<Vec3> fSingle = single.forces(), foundSingle = singleKernels.forces();
    EXPECT_LE(largestDistance(foundSingle, fSingle), 5e-6 * largest(f));
}

// x . A y = y . A x, and x . A x > 0 except for rigid motions.
TEST_P(OrthotropicKernel, ProductIsSymmetricAndPositive)
{
    const RestShape shape(m_mesh, fibrous());
    deform(0.7, 0.1);
    OrthotropicCase<double> kernels(shape, m_x, m_v);
    kernels.forces();
    RandomVectors random(12);
    for (int k = 0; k < 20; ++k)
    {
        std::vector<Vec3> x, y;
        for (std::size_t i = 0; i < m_x.size(); ++i) x.push_back(random.next()), y.push_back(random.next());
        const std::vector<Vec3> Ax = kernels.times(x), Ay = kernels.times(y);
        double xAy = 0, yAx = 0, xAx = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
            xAy += dot(x[i], Ay[i]), yAx += dot(y[i], Ax[i]), xAx += dot(x[i], Ax[i]);
        EXPECT_NEAR(xAy, yAx, 1e-10 * xAx);
        EXPECT_GT(xAx, 0);
    }
}

// A is the derivative of the forces at rest, where W vanishes.
TEST_P(OrthotropicKernel, ProductIsTheDerivativeOfTheForcesAtRest)
{
    const RestShape shape(m_mesh, fibrous());
    deform(1, 0);
    OrthotropicCase<double> kernels(shape, m_x, std::vector<Vec3>(m_x.size()));
    kernels.forces();
    std::vector<Vec3> x = m_x;
    const double d = 1e-7;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += d * m_v[i];
    OrthotropicCase<double> moved(shape, x, std::vector<Vec3>(m_x.size()));
    const std::vector<Vec3> f = moved.forces();
    std::vector<Vec3> expected;
    for (const Vec3& Ap : kernels.times(m_v)) expected.push_back(-d / OrthotropicCase<double>::kStiffnessFactor * Ap);
    EXPECT_LE(largestDistance(f, expected), 1e-5 * largest(f));
}

// Flat, collapsed and inverted elements have finite forces.
TEST_P(OrthotropicKernel, DegenerateElementsHaveFiniteForces)
{
    const RestShape shape(m_mesh, fibrous());
    for (const double height : {0.0, 1e-9, -0.5, -1.0})
    {
        deform(height, 0);
        OrthotropicCase<float> kernels(shape, m_x, m_v);
        for (const Vec3& force : kernels.forces()) EXPECT_LT(norm(force), 1e8) << height;
        for (const Vec3& Ap : kernels.times(m_v)) EXPECT_LT(norm(Ap), 1e8) << height;
    }
    m_x.assign(m_x.size(), Vec3());
    OrthotropicCase<float> kernels(shape, m_x, m_v);
    for (const Vec3& force : kernels.forces()) EXPECT_LT(norm(force), 1e8);
}

// Any division into ranges gives equal bits.
TEST_P(OrthotropicKernel, RangesDoNotMatter)
{
    const RestShape shape(m_mesh, fibrous());
    deform(0.8, 0.1);
    OrthotropicCase<float> whole(shape, m_x, m_v), parts(shape, m_x, m_v);
    const std::vector<Vec3> f = whole.forces(), Ap = whole.times(m_v);
    const StretchPass<float> pass = {parts.pass(), parts.m_orthotropic.data()};
    for (int b = parts.m_elements.blockCount() - 1; b >= 0; --b) runOrthotropicPass(pass, {b, b + 1});
    EXPECT_EQ(largestDistance(parts.cornerSums(), f), 0);
    const std::vector<PaddedVec3> p = padded(m_v);
    const StretchProduct<float> product = {parts.product(p), parts.m_orthotropic.data()};
    for (int b = parts.m_elements.blockCount() - 1; b >= 0; --b) runOrthotropicProduct(product, {b, b + 1});
    EXPECT_EQ(largestDistance(parts.cornerSums(), Ap), 0);
}

INSTANTIATE_TEST_SUITE_P(Targets, OrthotropicKernel, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
