// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The initial stress in an element pass: against its energy, its torque balance, and plain C++.
#include "fem/common/rotation.h"
#include "fem/elements/element_pass.h"
#include "fem/scenes/element_case.h"
#include "fem/scenes/reference_elements.h"

namespace bullet_fem
{
namespace
{

constexpr double kSize = 5e3;  // [Pa], beside E 1e4

class InitialStressKernel : public OnTarget
{
protected:
    // Strained by some 20 %, turned by 2 rad and away from the origin, at rest.
    void deform(const TetMesh& mesh)
    {
        RandomVectors random(9);
        const Mat3 Q = rotationAbout({1, -2, 3}, 2);
        for (const Vec3& X : mesh.restPositions())
            m_x.push_back(Q * (1.1 * X + 0.1 * mesh.meanEdgeLength() * random.next()) + Vec3{10, 20, -10});
        m_v.resize(m_x.size());
    }

    // One tensor per lane, multiplied by V.
    template <class Real>
    std::vector<StressBlock<Real>> stressesOf(const ElementCase<Real>& kernels)
    {
        RandomVectors random(5);
        std::vector<Mat3> stress;
        for (std::size_t e = 0; e < kernels.m_shape.m_elements.size(); ++e)
        {
            const Mat3 A = Mat3::fromColumns(random.next(), random.next(), random.next());
            stress.push_back(kSize * kernels.m_shape.m_elements[e].m_volume * (A + transpose(A)));
        }
        std::vector<StressBlock<Real>> result(kernels.m_elements.blockCount());
        for (std::size_t lane = 0; lane < kernels.m_lanes.m_element.size(); ++lane)
        {
            const Mat3& s = stress[kernels.m_lanes.m_element[lane]];
            const double entries[6] = {s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1)};
            for (int k = 0; k < 6; ++k) result[lane / kLanes].m_entry[k][lane % kLanes] = static_cast<Real>(entries[k]);
        }
        m_stress = stress;
        return result;
    }

    template <class Real>
    static std::vector<Vec3> forces(ElementCase<Real>& kernels, const std::vector<StressBlock<Real>>* stress)
    {
        ElementPass<Real> pass = kernels.pass();
        if (stress) pass.m_initialStress = stress->data();
        runElementPass(pass, kernels.blocks());
        return kernels.cornerSums();
    }

    // V sigma_0 : (S - I), F = R S.
    double energy(const RestShape& shape, const std::vector<Vec3>& x) const
    {
        double sum = 0;
        for (std::size_t e = 0; e < shape.m_elements.size(); ++e)
        {
            const Tet& tet = shape.m_mesh.tets()[e];
            const Mat3 F = Mat3::fromColumns(x[tet[1]] - x[tet[0]], x[tet[2]] - x[tet[0]], x[tet[3]] - x[tet[0]]) *
                           shape.m_elements[e].m_DmInverse;
            const Mat3 S = transposeTimes(polarRotation(F, Mat3::identity()), F);
            sum += trace(m_stress[e] * (S - Mat3::identity()));
        }
        return sum;
    }

    std::vector<Vec3> m_x, m_v;
    std::vector<Mat3> m_stress;  // of the elements, multiplied by V
};

// Central differences of a smooth energy, with d 1e-5 of an edge: the error is of order d^2, the rounding 1e-16 / d.
TEST_P(InitialStressKernel, ForcesAreTheGradientOfTheEnergy)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {2, 2, 2}, {}, CellSplit::kuhnSix);
    deform(mesh);
    for (const MeanDilatation patches : {MeanDilatation::off, MeanDilatation::on})
    {
        Material material = elasticMaterial(1e4, 0.3);
        material.m_meanDilatation = patches;
        const RestShape shape(mesh, material);
        ElementCase<double> kernels(shape, m_x, m_v);
        const std::vector<StressBlock<double>> stress = stressesOf(kernels);
        const std::vector<Vec3> with = forces(kernels, &stress), without = forces<double>(kernels, nullptr);
        const double d = 1e-5 * mesh.meanEdgeLength();
        for (std::size_t i = 0; i < m_x.size(); ++i)
            for (int c = 0; c < 3; ++c)
            {
                std::vector<Vec3> up = m_x, down = m_x;
                up[i][c] += d, down[i][c] -= d;
                const double slope = (energy(shape, up) - energy(shape, down)) / (2 * d);
                EXPECT_NEAR(with[i][c] - without[i][c], -slope, 1e-6 * largest(with)) << i << ", " << c;
            }
    }
}

// Balance in each element, not only in the sum; shear strains make R sigma_0 alone unbalanced.
TEST_P(InitialStressKernel, ForcesOfAnElementHaveNoSumAndNoTorque)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {2, 2, 2});
    deform(mesh);
    const RestShape shape(mesh, elasticMaterial(1e4, 0.3));
    ElementCase<double> kernels(shape, m_x, m_v);
    const std::vector<StressBlock<double>> stress = stressesOf(kernels);
    const double size = largest(forces(kernels, &stress));
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        const int place = kernels.m_lanes.m_lane[e];
        Vec3 sum, torque;
        for (int a = 0; a < 4; ++a)
        {
            const double* f = kernels.m_corners[place / kLanes].m_vector[a][place % kLanes];
            const Vec3 force = {f[0], f[1], f[2]};
            sum += force;
            torque += cross(m_x[mesh.tets()[e][a]], force);
        }
        EXPECT_LE(norm(sum), 1e-12 * size) << e;
        EXPECT_LE(norm(torque), 1e-7 * size) << e;  // the state's rotations are in single precision
    }
}

TEST_P(InitialStressKernel, MatchesItsScalarReference)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {4, 2, 2}, {}, CellSplit::kuhnSix);
    deform(mesh);
    for (const double nu : {0.3, 0.45})
    {
        const RestShape shape(mesh, elasticMaterial(1e4, nu));
        ElementCase<float> kernels(shape, m_x, m_v), twin(shape, m_x, m_v);
        const std::vector<StressBlock<float>> stress = stressesOf(kernels);
        const std::vector<Vec3> force = forces(kernels, &stress);
        ElementPass<float> pass = twin.pass();
        pass.m_initialStress = stress.data();
        reference::runElementPass(pass, twin.blocks());
        const std::vector<Vec3> expected = twin.cornerSums();
        EXPECT_LE(largestDistance(force, expected), 1e-5 * largest(force));
        for (int e = 0; e < mesh.tetCount(); ++e)
        {
            const int block = kernels.m_lanes.m_lane[e] / kLanes, lane = kernels.m_lanes.m_lane[e] % kLanes;
            const double scale = kernels.kTensionFactor * 4 * kSize * shape.m_elements[e].m_volume;
            for (int k = 0; k < 6; ++k)
                EXPECT_NEAR(kernels.m_warped[block].m_tension[k][lane], twin.m_warped[block].m_tension[k][lane],
                            1e-5 * scale)
                    << e;
        }
    }
}

// S = diag(1, s, s): tr(S) I - S has the pivot 2 s, a hundredth of its trace 2 + 4 s at s = .0102.
TEST_P(InitialStressKernel, TorqueIsBalancedUntilAnElementIsNearlyALine)
{
    const TetMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const RestShape shape(mesh, elasticMaterial(1e4, 0.3));
    m_v.resize(4);
    for (const double s : {0.0105, 0.0099})
    {
        m_x.clear();
        for (const Vec3& X : mesh.restPositions()) m_x.push_back({X.x, s * X.y, s * X.z});
        ElementCase<double> kernels(shape, m_x, m_v);
        std::vector<StressBlock<double>> stress(1);
        for (double& xy : stress[0].m_entry[5]) xy = kSize / 6;
        Vec3 torque;
        const std::vector<Vec3> f = forces(kernels, &stress), without = forces<double>(kernels, nullptr);
        for (std::size_t i = 0; i < f.size(); ++i) torque += cross(m_x[i], f[i] - without[i]);
        const double unbalanced = (1 - s) * kSize / 6;
        EXPECT_NEAR(std::fabs(torque.z), s > 0.0102 ? 0 : unbalanced, 1e-3 * unbalanced) << s;
    }
}

// Flat, collapsed and inverted elements: their torque cannot be balanced, and the forces stay finite.
TEST_P(InitialStressKernel, DegenerateElementsHaveFiniteForces)
{
    const TetMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const RestShape shape(mesh, elasticMaterial(1e4, 0.3));
    m_v.resize(4);
    for (const Mat3& F : {Mat3{}, Mat3{{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}}, Mat3{{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}},
                          Mat3{{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}, Mat3::diagonal(-2)})
    {
        m_x.clear();
        for (const Vec3& X : mesh.restPositions()) m_x.push_back(F * X);
        ElementCase<float> kernels(shape, m_x, m_v);
        const std::vector<StressBlock<float>> stress = stressesOf(kernels);
        for (const Vec3& f : forces(kernels, &stress)) EXPECT_LT(norm(f), 10 * (kSize + 3e4));
    }
}

class ElementStrainKernel : public OnTarget
{
};

// Prescribed strains at any rotation: accurate to rounding of the largest, even if small.
template <class Real>
void expectGivenStrains(double size, double rounding)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {3, 2, 2}, {}, CellSplit::kuhnSix);
    const Mat3 E = {{{0.7 * size, 0.2 * size, -0.1 * size},
                     {0.2 * size, -0.5 * size, 0.3 * size},
                     {-0.1 * size, 0.3 * size, 0.4 * size}}};
    const Mat3 F = rotationAbout({1, -2, 3}, 2.9) * (Mat3::identity() + E);
    std::vector<Vec3> x;
    for (const Vec3& X : mesh.restPositions()) x.push_back(F * X + Vec3{3, -1, 2});
    for (const double nu : {0.3, 0.45})
    {
        const RestShape shape(mesh, elasticMaterial(1e4, nu));
        ElementCase<Real> kernels(shape, x, x);
        std::vector<StrainBlock<Real>> strain(kernels.m_elements.blockCount()), twin = strain;
        std::vector<Quaternion> rotation = kernels.m_rotation;
        const Range all = {0, kernels.m_elements.blockCount()};
        runElementStrains(
            ElementStrains<Real>{&kernels.m_elements, kernels.m_x.data(), kernels.m_rotation.data(), strain.data()},
            all);
        reference::runElementStrains(
            ElementStrains<Real>{&kernels.m_elements, kernels.m_x.data(), rotation.data(), twin.data()}, all);
        const double entries[6] = {E(0, 0), E(1, 1), E(2, 2), E(1, 2), E(0, 2), E(0, 1)};
        for (int e = 0; e < mesh.tetCount(); ++e)
        {
            const int lane = kernels.m_lanes.m_lane[e];
            for (int k = 0; k < 6; ++k)
            {
                EXPECT_NEAR(strain[lane / kLanes].m_entry[k][lane % kLanes], entries[k], rounding * size) << e;
                EXPECT_NEAR(twin[lane / kLanes].m_entry[k][lane % kLanes], entries[k], rounding * size) << e;
            }
            EXPECT_LE(squaredNorm(kernels.rotation(e) - rotationAbout({1, -2, 3}, 2.9)), 1e-12) << e;
        }
    }
}

TEST_P(ElementStrainKernel, FindsTheStrainsOfTheElementsFrames)
{
    for (const double size : {1e-4, 0.01, 0.3})
    {
        expectGivenStrains<float>(size, 5e-6);
        expectGivenStrains<double>(size, 5e-6);  // the state's rotations are floats: 1e-7 about the strain's axes
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, ElementStrainKernel, testing::ValuesIn(availableTargets()), targetName);
INSTANTIATE_TEST_SUITE_P(Targets, InitialStressKernel, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
