// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rotations and tensions of the element kernels in hard cases: elements far from their last rotation, inverted, flat,
// of rank one or zero; stresses with equal eigenvalues.
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "fem/common/rotation.h"
#include "fem/scenes/dense_system.h"
#include "fem/scenes/element_case.h"

namespace bullet_fem
{
namespace
{

// Elements without common nodes, each with an F of its own.
class SingleElements
{
public:
    explicit SingleElements(const std::vector<Mat3>& F) : m_F(F), m_shape(mesh(F.size()), elasticMaterial(1e4, 0.3))
    {
        const std::vector<Vec3>& X = m_shape.m_mesh.restPositions();
        for (std::size_t i = 0; i < X.size(); ++i) m_x.push_back(F[i / 4] * (X[i] - X[i / 4 * 4]));
    }

    static TetMesh mesh(std::size_t count)
    {
        std::vector<Vec3> X;
        std::vector<Tet> tets;
        for (std::size_t e = 0; e < count; ++e)
        {
            const Vec3 at = {2.0 * static_cast<double>(e), 0, 0};
            const int i = static_cast<int>(4 * e);
            for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0.2, 0}, Vec3{0.1, 1.1, 0.3}, Vec3{-0.2, 0.1, 0.9}})
                X.push_back(at + corner);
            tets.push_back({i, i + 1, i + 2, i + 3});
        }
        return TetMesh(X, tets);
    }

    std::vector<Vec3> atRest() const { return std::vector<Vec3>(m_x.size()); }

    const std::vector<Mat3> m_F;
    const RestShape m_shape;
    std::vector<Vec3> m_x;
};

Mat3 scaling(const Vec3& s)
{
    return {{{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}};
}

// U diag(s) V^T of random rotations U, V.
std::vector<Mat3> withStretches(const std::vector<Vec3>& stretches, unsigned seed)
{
    RandomVectors random(seed);
    std::vector<Mat3> result;
    for (int k = 0; k < 40; ++k)
        for (const Vec3& s : stretches)
        {
            const Mat3 U = rotationAbout(random.next(), 3 * random.next().x), V = rotationAbout(random.next(), 2);
            result.push_back(U * timesTranspose(scaling(s), V));
        }
    return result;
}

class ElementRotation : public OnTarget
{
protected:
    // R is a rotation, and no other one has a larger tr(R^T F) beyond rounding, also if R is not unique.
    template <class Real>
    void expectPolar(const std::vector<Mat3>& F)
    {
        const SingleElements elements(F);
        ElementCase<Real> kernels(elements.m_shape, elements.m_x, elements.atRest());
        for (const Vec3& f : kernels.forces()) ASSERT_TRUE(isFinite(f));
        for (std::size_t e = 0; e < F.size(); ++e)
        {
            const Quaternion& q = kernels.m_rotation[e];
            EXPECT_NEAR(1, q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1e-6) << e;
            const double best = trace(transposeTimes(polarRotation(F[e], Mat3::identity()), F[e]));
            EXPECT_GE(trace(transposeTimes(kernels.rotation(static_cast<int>(e)), F[e])),
                      best - 1e-6 * std::sqrt(squaredNorm(F[e])))
                << e;
        }
    }

    void expectPolarInBoth(const std::vector<Mat3>& F)
    {
        expectPolar<float>(F);
        expectPolar<double>(F);
    }
};

TEST_P(ElementRotation, IsPolarForRandomStretches)
{
    expectPolarInBoth(withStretches({{1, 1, 1}, {1.1, 1, 0.9}, {3, 1, 0.2}, {100, 1, 0.01}, {1e3, 1e3, 1e3}}, 1));
}

TEST_P(ElementRotation, IsPolarForInvertedElements)
{
    expectPolarInBoth(withStretches({{1, 1, -0.2}, {1, 1, -1}, {1, 0.5, -0.49999}, {2, 1, -0.5}, {1, 1e-3, -1e-3}}, 2));
}

TEST_P(ElementRotation, IsPolarForFlatAndDegenerateElements)
{
    expectPolarInBoth(withStretches({{1, 1, 0}, {2, 0.5, 0}, {1, 0, 0}, {1e-20, 1e-20, 1e-20}, {0, 0, 0}}, 3));
}

// Values written to nodes by mistake: products of three entries overflow in single precision.
TEST_P(ElementRotation, IsPolarForHugeElements)
{
    const Vec3 size = {1, 0.7, 0.4};
    expectPolarInBoth(withStretches({1e8 * size, 1e10 * size, 1e13 * size, 1e16 * size}, 6));
}

// Such elements keep their last rotation, for any products in the kernels.
TEST_P(ElementRotation, IsFiniteForOverflowingEntries)
{
    const SingleElements elements(std::vector<Mat3>(20, scaling({1e36, 3e37, 1e38})));
    ElementCase<float> kernels(elements.m_shape, elements.m_x, elements.atRest());
    kernels.forces();
    for (int e = 0; e < 20; ++e) EXPECT_TRUE(isFinite(kernels.rotation(e).column(0))) << e;
}

// Half turns about the axes, exact to rounding: their trace, the scale of the definiteness test, is negative.
TEST_P(ElementRotation, IsPolarForHalfTurnsAboutTheAxes)
{
    std::vector<Mat3> F;
    for (const double s : {0.0, 1.2e-16, -1.2e-16, 3e-12, 1e-8})
        for (const double stretch : {1 - 2e-16, 1.0, 1 + 2e-16, 1 + 1e-9})
        {
            F.push_back({{{-stretch, -s, 0}, {s, -1, 0}, {0, 0, 1}}});
            F.push_back({{{1, 0, 0}, {0, -1, -s}, {0, s, -stretch}}});
            F.push_back({{{-1, 0, s}, {0, stretch, 0}, {-s, 0, -1}}});
        }
    expectPolarInBoth(F);
}

TEST_P(ElementRotation, IsPolarForHalfTurnsFromTheLastRotation)
{
    std::vector<Mat3> F;
    RandomVectors random(4);
    for (const double angle : {3.14159265358979, 3.1415, 3.0, -3.14159265358979})
        for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, random.next(), random.next()})
            F.push_back(rotationAbout(axis, angle) * scaling({1.05, 1, 0.95}));
    expectPolarInBoth(F);
}

// R is continuous if F does not determine it: a collapsed element keeps its rotation.
TEST_P(ElementRotation, KeepsTheLastRotationOfACollapsedElement)
{
    const SingleElements elements(std::vector<Mat3>(20, Mat3()));
    ElementCase<float> kernels(elements.m_shape, elements.m_x, elements.atRest());
    const Mat3 last = rotationAbout({1, 2, 3}, 1);
    std::fill(kernels.m_rotation.begin(), kernels.m_rotation.end(), rounded(toQuaternion(last)));
    kernels.forces();
    for (int e = 0; e < 20; ++e) EXPECT_LE(squaredNorm(kernels.rotation(e) - last), 1e-12);
}

// Forces of elements rotated by up to a radian since the last step, and of degenerate ones beside them.
TEST_P(ElementRotation, ForcesAgreeWithTheDoubleLoop)
{
    std::vector<Mat3> F = withStretches({{1.2, 1, 0.9}, {1, 1, 0.3}, {1, 0.8, -0.3}}, 5);
    const SingleElements elements(F);
    ElementCase<float> kernels(elements.m_shape, elements.m_x, elements.atRest());
    std::vector<Mat3> R(F.size(), Mat3::identity());
    std::vector<Vec3> expected(elements.m_x.size());
    updateElementRotations(elements.m_shape, elements.m_x, R);
    addElasticForces(elements.m_shape, elements.m_x, elements.atRest(), 0, R, expected, nullptr);
    EXPECT_LE(largestDistance(kernels.forces(), expected), 6e-6 * largest(expected));
}

// V sigma+ of pure stretches whose stresses have all signs, and eigenvalues that are equal or nearly so.
TEST_P(ElementRotation, TensionIsPositiveAndRightForEqualEigenvalues)
{
    std::vector<Mat3> F;
    const Mat3 Q = rotationAbout({1, 2, -1}, 0.8);
    for (const double size : {0.1, 1e-3})
        for (const Vec3& strain : {Vec3{1, 1, -1}, Vec3{1, -1, -1}, Vec3{1, 1, -1e-4}, Vec3{1, 1.0001, -1},
                                   Vec3{1, -1, -0.9999}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 0, 0},
                                   Vec3{1, 1, 1}, Vec3{-1, -1, -1}, Vec3{1e-4, -1e-4, -1}, Vec3{1e-3, -1e-3, 1},
                                   Vec3{1, -0.3, -0.3}, Vec3{1, -0.6, -0.2}, Vec3{1, -0.25, -0.4}, Vec3{-1, 0.25, 0.4}})
            F.push_back(Q * timesTranspose(scaling(Vec3{1, 1, 1} + size * strain), Q));
    const SingleElements elements(F);
    ElementCase<float> kernels(elements.m_shape, elements.m_x, elements.atRest());
    kernels.forces();
    const Material& material = elements.m_shape.m_material;
    for (std::size_t e = 0; e < F.size(); ++e)
    {
        const Mat3 E = F[e] - Mat3::identity();
        const double V = elements.m_shape.m_elements[e].m_volume;
        const Mat3 stress = V * (2 * material.lameMu() * E + Mat3::diagonal(material.lameLambda() * trace(E)));
        const auto& t = kernels.m_warped[e / kLanes].m_tension;
        const int lane = static_cast<int>(e % kLanes);
        Eigen::Matrix3d got;
        got << t[0][lane], t[5][lane], t[4][lane], t[5][lane], t[1][lane], t[3][lane], t[4][lane], t[3][lane],
            t[2][lane];
        got /= kernels.kTensionFactor;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(dense(stress));
        const Eigen::Matrix3d expected =
            eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
        // Rounding of the strain is 3e-7, of the spectral part 1e-6 of the stress.
        const double tolerance = V * (3e-7 * 1e4 * 3) + 3e-6 * dense(stress).norm();
        EXPECT_LE((got - expected).norm(), tolerance) << e;
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(got).eigenvalues()(0), -1e-6 * got.norm()) << e;
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, ElementRotation, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
