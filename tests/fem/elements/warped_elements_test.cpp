// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/reference/warped_elements.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <tuple>

#include "benchmarks/reference/positive_part.h"
#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

struct NamedMesh
{
    const char* m_name;
    TetMesh m_mesh;
};

struct NamedTurn
{
    const char* m_name;
    Mat3 m_Q;
};

void PrintTo(const NamedMesh& mesh, std::ostream* out)
{
    *out << mesh.m_name;
}

void PrintTo(const NamedTurn& turn, std::ostream* out)
{
    *out << turn.m_name;
}

// The textbook's K_e has no mean dilatation over patches.
Material withoutPatches(Material material)
{
    material.m_meanDilatation = MeanDilatation::off;
    return material;
}

using WarpCase = std::tuple<NamedMesh, double, NamedTurn>;  // mesh, nu, rotation of the whole state

// A state stretched by 10 % and strained by some 20 % more, turned by Q, with random velocities.
class WarpedElements : public testing::TestWithParam<WarpCase>
{
protected:
    WarpedElements()
    {
        RandomVectors random(9);
        for (const Vec3& X : m_mesh.restPositions())
        {
            m_x.push_back(m_Q * (1.1 * X + 0.1 * m_mesh.meanEdgeLength() * random.next()) + Vec3{1, 2, -1});
            m_v.push_back(random.next());
        }
        updateElementRotations(m_shape, m_x, m_R);
    }

    std::vector<Vec3> zero() const { return std::vector<Vec3>(m_x.size()); }

    std::vector<Vec3> forces(const std::vector<Vec3>& x, const std::vector<Mat3>& R) const
    {
        std::vector<Vec3> f = zero();
        addElasticForces(m_shape, x, zero(), 0, R, f, nullptr);
        return f;
    }

    std::vector<Vec3> product(const std::vector<Vec3>& p, const std::array<double, 2>& factors) const
    {
        std::vector<Vec3> out = zero();
        addStiffnessProduct(m_shape, m_R, m_tension, factors, p, out);
        return out;
    }

    // 1/2 sum (R^T x - X)^T K_e (R^T x - X), with the textbook's K_e.
    double energy(const std::vector<Vec3>& x) const
    {
        double sum = 0;
        for (int e = 0; e < m_mesh.tetCount(); ++e)
        {
            const Tet& tet = m_mesh.tets()[e];
            const std::vector<Vec3>& X = m_mesh.restPositions();
            std::vector<Vec3> u;
            for (int node : tet) u.push_back(transposeTimes(m_R[e], x[node]) - X[node]);
            const Eigen::MatrixXd K_e =
                textbookElementStiffness({X[tet[0]], X[tet[1]], X[tet[2]], X[tet[3]]}, m_material);
            sum += 0.5 * flat(u).dot(K_e * flat(u));
        }
        return sum;
    }

    void fillTension()
    {
        m_tension.resize(m_mesh.tetCount());
        std::vector<Vec3> f = zero();
        addElasticForces(m_shape, m_x, m_v, 0, m_R, f, &m_tension);
    }

    const TetMesh m_mesh = std::get<0>(GetParam()).m_mesh;
    const Material m_material = withoutPatches(elasticMaterial(1e4, std::get<1>(GetParam())));
    const Mat3 m_Q = std::get<2>(GetParam()).m_Q;
    const RestShape m_shape{m_mesh, m_material};
    std::vector<Vec3> m_x, m_v;
    std::vector<Mat3> m_R = std::vector<Mat3>(m_mesh.tetCount(), Mat3::identity());
    std::vector<std::array<double, 6>> m_tension;
};

// The energy is quadratic at fixed R: central differences are exact but for the rounding of E, 1e-16 |E| / d.
TEST_P(WarpedElements, ForcesAreTheGradientOfTheEnergyAtFixedRotations)
{
    const std::vector<Vec3> f = forces(m_x, m_R);
    const double d = 1e-2 * m_mesh.meanEdgeLength();
    for (std::size_t i = 0; i < m_x.size(); i += 3)
        for (int c = 0; c < 3; ++c)
        {
            std::vector<Vec3> ahead = m_x, behind = m_x;
            ahead[i][c] += d;
            behind[i][c] -= d;
            EXPECT_NEAR(f[i][c], -(energy(ahead) - energy(behind)) / (2 * d), 1e-10 * flat(f).norm()) << i << " " << c;
        }
}

TEST_P(WarpedElements, ARigidMotionMakesNoForce)
{
    std::vector<Vec3> x;
    for (const Vec3& X : m_mesh.restPositions()) x.push_back(m_Q * X + Vec3{3, 1, 2});
    std::vector<Mat3> R(m_R.size(), Mat3::identity());
    updateElementRotations(m_shape, x, R);
    for (const Mat3& R_e : R) EXPECT_LE(squaredNorm(R_e - m_Q), 1e-26);
    // Rounding of x, some 10 edges from the origin, against 1 % of strain.
    EXPECT_LE(flat(forces(x, R)).norm(), 1e-12 * flat(forces(m_x, m_R)).norm());
}

TEST_P(WarpedElements, ForcesTurnWithTheStateAndHaveNeitherSumNorTorque)
{
    const std::vector<Vec3> f = forces(m_x, m_R);
    const double size = flat(f).norm();
    Vec3 sum, torque;
    std::vector<Vec3> turned, expected;
    const Mat3 Q = rotationAbout({-1, 3, 2}, 2.5);
    for (std::size_t i = 0; i < f.size(); ++i)
    {
        sum += f[i];
        torque += cross(m_x[i] - m_x[0], f[i]);
        turned.push_back(Q * m_x[i]);
        expected.push_back(Q * f[i]);
    }
    EXPECT_LE(norm(sum), 1e-13 * size);
    EXPECT_LE(norm(torque), 1e-13 * size);  // arms of 1 m
    std::vector<Mat3> R = m_R;
    updateElementRotations(m_shape, turned, R);
    EXPECT_LE(largestDistance(forces(turned, R), expected), 1e-12 * size);
}

TEST_P(WarpedElements, DampingForcesAreMinusTheDampedProduct)
{
    std::vector<Vec3> f = zero();
    addElasticForces(m_shape, m_x, m_v, 0.05, m_R, f, nullptr);
    const Eigen::VectorXd viscous = flat(f) - flat(forces(m_x, m_R));
    const Eigen::VectorXd expected = -0.05 * flat(product(m_v, {1, 0}));
    EXPECT_LE((viscous - expected).norm(), 1e-12 * flat(f).norm());
    EXPECT_LT(viscous.dot(flat(m_v)), 0);  // it dissipates
}

TEST_P(WarpedElements, ProductIsThatOfTheAssembledMatrix)
{
    const Eigen::VectorXd expected = 0.7 * denseStiffness(m_mesh, m_material, m_R) * flat(m_v);
    EXPECT_LE((flat(product(m_v, {0.7, 0})) - expected).norm(), 1e-13 * expected.norm());
}

TEST_P(WarpedElements, ProductIsAddedToTheOutput)
{
    std::vector<Vec3> out = m_v;
    addStiffnessProduct(m_shape, m_R, {}, {1, 0}, m_v, out);
    const Eigen::VectorXd expected = flat(m_v) + flat(product(m_v, {1, 0}));
    EXPECT_LE((flat(out) - expected).norm(), 1e-15 * expected.norm());
}

// One rotation Q for all elements: K' kills translations and Q (w x X).
TEST_P(WarpedElements, StiffnessKillsRigidModes)
{
    m_R.assign(m_R.size(), m_Q);
    const double size = flat(product(m_v, {1, 0})).norm() / flat(m_v).norm();
    for (int mode = 0; mode < 6; ++mode)
    {
        Vec3 axis;
        axis[mode % 3] = 1;
        std::vector<Vec3> p;
        for (const Vec3& X : m_mesh.restPositions()) p.push_back(mode < 3 ? axis : m_Q * cross(axis, X));
        EXPECT_LE(flat(product(p, {1, 0})).norm(), 1e-13 * size * flat(p).norm()) << mode;
    }
}

// V sigma+ of an element, from the textbook: sigma = lambda tr(eps) I + 2 mu eps, eps = sym(R^T F) - I.
TEST_P(WarpedElements, TensionIsThePositivePartOfTheStress)
{
    fillTension();
    for (int e = 0; e < m_mesh.tetCount(); ++e)
    {
        const Tet& t = m_mesh.tets()[e];
        const Mat3 Ds = Mat3::fromColumns(m_x[t[1]] - m_x[t[0]], m_x[t[2]] - m_x[t[0]], m_x[t[3]] - m_x[t[0]]);
        const Eigen::Matrix3d S = dense(transposeTimes(m_R[e], Ds * m_shape.m_elements[e].m_DmInverse));
        const Eigen::Matrix3d strain = 0.5 * (S + S.transpose()) - Eigen::Matrix3d::Identity();
        const Eigen::Matrix3d stress =
            m_material.lameLambda() * strain.trace() * Eigen::Matrix3d::Identity() + 2 * m_material.lameMu() * strain;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(m_mesh.tetVolume(e) * stress);
        const Eigen::Matrix3d expected =
            eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
        const auto& s = m_tension[e];
        Eigen::Matrix3d got;
        got << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
        EXPECT_LE((got - expected).norm(), 1e-7 * m_mesh.tetVolume(e) * stress.norm()) << e;
    }
}

// T = sum V (g_a . sigma+ g_b) I by its columns: equal for x, y and z, symmetric, positive semidefinite, zero for
// translations.
TEST_P(WarpedElements, TensionTermIsSymmetricAndPositiveSemidefinite)
{
    fillTension();
    const int n = static_cast<int>(m_x.size());
    Eigen::MatrixXd T(3 * n, 3 * n);
    for (int j = 0; j < 3 * n; ++j) T.col(j) = flat(product(nodes(Eigen::VectorXd::Unit(3 * n, j)), {0, 1}));
    EXPECT_GT(T.norm(), 0);
    EXPECT_LE((T - T.transpose()).norm(), 1e-14 * T.norm());
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(T).eigenvalues()(0), -1e-14 * T.norm());
    EXPECT_LE((T * Eigen::Vector3d(1, 2, 3).replicate(n, 1)).norm(), 1e-13 * T.norm());
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            EXPECT_LE((T.block<3, 3>(3 * i, 3 * j) - T(3 * i, 3 * j) * Eigen::Matrix3d::Identity()).norm(),
                      1e-15 * T.norm());
}

TEST_P(WarpedElements, FactorsWeighStiffnessAndTension)
{
    fillTension();
    const Eigen::VectorXd both = flat(product(m_v, {0.3, 2}));
    const Eigen::VectorXd expected = 0.3 * flat(product(m_v, {1, 0})) + 2 * flat(product(m_v, {0, 1}));
    EXPECT_LE((both - expected).norm(), 1e-14 * expected.norm());
}

const TetMesh& oneTet()
{
    static const TetMesh mesh({{0.1, 0, 0}, {1, 0.2, 0}, {0, 1.1, 0.3}, {-0.2, 0.1, 0.9}}, {{0, 1, 2, 3}});
    return mesh;
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, WarpedElements,
    testing::Combine(testing::Values(NamedMesh{"Tet", oneTet()}, NamedMesh{"Box", makeBox({1, 0.6, 0.5}, {2, 1, 2})},
                                     NamedMesh{"KuhnBox", makeBox({1, 0.6, 0.5}, {2, 1, 2}, {}, CellSplit::kuhnSix)},
                                     NamedMesh{"Sphere", makeSphere(0.5, 2)}),
                     testing::Values(0, 0.3, 0.49),
                     testing::Values(NamedTurn{"Unturned", Mat3::identity()},
                                     NamedTurn{"Y90", rotationAbout({0, 1, 0}, kPi / 2)},
                                     NamedTurn{"Oblique180", rotationAbout({1, -2, 3}, kPi)})),
    [](const auto& suite)
    {
        return std::string(std::get<0>(suite.param).m_name) + "Nu" +
               std::to_string(std::lround(100 * std::get<1>(suite.param))) + std::get<2>(suite.param).m_name;
    });

// A cube under uniform pressure has no tension; under uniform tension it has its whole stress.
TEST(Tension, VanishesInCompressionAndIsFullInStretch)
{
    const RestShape shape(makeBox({1, 1, 1}, {1, 1, 1}), elasticMaterial(1e4, 0.3));
    const std::vector<Mat3> R(5, Mat3::identity());
    for (const double strain : {-0.1, 0.0, 0.1})
    {
        std::vector<Vec3> x = shape.m_mesh.restPositions(), v(x.size()), f(x.size());
        for (Vec3& xi : x) xi *= 1 + strain;
        std::vector<std::array<double, 6>> tension(5, {9, 9, 9, 9, 9, 9});
        addElasticForces(shape, x, v, 0, R, f, &tension);
        const double bulk = 1e4 / (3 * (1 - 2 * 0.3));
        for (int e = 0; e < 5; ++e)
        {
            // 3 K eps, with rounding of the strain, 1e-16.
            const double pull = std::max(0.0, 3 * bulk * strain) * shape.m_mesh.tetVolume(e);
            for (int k = 0; k < 6; ++k) EXPECT_NEAR(tension[e][k], k < 3 ? pull : 0, 1e-11) << e << k;
        }
    }
}

Mat3 symmetric(const Vec3& eigenvalues, const Mat3& Q)
{
    return Q * timesTranspose(Mat3{{{eigenvalues.x, 0, 0}, {0, eigenvalues.y, 0}, {0, 0, eigenvalues.z}}}, Q);
}

double rotationDistance(const Mat3& a, const Mat3& b)
{
    return std::sqrt(squaredNorm(a - b));
}

class PositivePart : public testing::TestWithParam<double>  // scale of the matrix
{
};

TEST_P(PositivePart, SetsNegativeEigenvaluesToZero)
{
    const double scale = GetParam();
    RandomVectors random(4);
    for (int k = 0; k < 300; ++k)
    {
        const Mat3 Q = rotationAbout(random.next(), 3);
        const Vec3 d = scale * random.next();
        const Mat3 A = symmetric(d, Q);
        const Mat3 expected = symmetric({std::max(0.0, d.x), std::max(0.0, d.y), std::max(0.0, d.z)}, Q);
        EXPECT_LE(rotationDistance(positivePart(0.5 * (A + transpose(A))), expected), 1e-7 * scale) << k;
    }
}

// Double and triple eigenvalues, where closed formulas divide by differences.
TEST_P(PositivePart, HandlesEqualEigenvalues)
{
    const double scale = GetParam();
    const Mat3 Q = rotationAbout({1, 2, -1}, 0.8);
    for (const Vec3& d :
         {Vec3{1, 1, -1}, Vec3{1, -1, -1}, Vec3{1, 1, -1e-9}, Vec3{1, 1 + 1e-9, -1}, Vec3{1, -1, -1 + 1e-9},
          Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 0, 0}, Vec3{1e-9, -1e-9, 1}})
    {
        Mat3 A = symmetric(scale * d, Q);
        A = 0.5 * (A + transpose(A));
        const Mat3 expected = symmetric(scale * Vec3{std::max(0.0, d.x), std::max(0.0, d.y), std::max(0.0, d.z)}, Q);
        EXPECT_LE(rotationDistance(positivePart(A), expected), 1e-7 * scale) << d.x << " " << d.y << " " << d.z;
        EXPECT_LE(rotationDistance(positivePart(A) - positivePart(-1.0 * A), A), 1e-7 * scale);
    }
}

TEST_P(PositivePart, LeavesPositiveAndRemovesNegativeMatrices)
{
    const Mat3 A = symmetric(GetParam() * Vec3{1, 2, 3}, rotationAbout({1, 2, -1}, 0.8));
    EXPECT_EQ(rotationDistance(positivePart(A), A), 0);
    EXPECT_EQ(squaredNorm(positivePart(-1.0 * A)), 0);
}

INSTANTIATE_TEST_SUITE_P(Scales, PositivePart, testing::Values(1e-12, 1., 1e12),
                         [](const auto& suite) { return suite.param < 1   ? "Tiny"
                                                        : suite.param > 1 ? "Huge"
                                                                          : "One"; });

}  // namespace
}  // namespace bullet_fem
