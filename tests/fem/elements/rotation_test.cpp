// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <limits>
#include <tuple>

#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

struct NamedMatrix
{
    const char* m_name;
    Mat3 m_matrix;
};

void PrintTo(const NamedMatrix& matrix, std::ostream* out)
{
    *out << matrix.m_name;
}

Mat3 scaledAxes(double a, double b, double c)
{
    return {{{a, 0, 0}, {0, b, 0}, {0, 0, c}}};
}

Mat3 oblique(double degrees)
{
    return rotationAbout({1, -2, 0.5}, degrees * kPi / 180);
}

double distance(const Mat3& a, const Mat3& b)
{
    return std::sqrt(squaredNorm(a - b));
}

void expectRotation(const Mat3& R)
{
    EXPECT_LE(distance(transposeTimes(R, R), Mat3::identity()), 1e-14);
    EXPECT_NEAR(determinant(R), 1, 1e-14);
}

// The largest tr(R^T F) that a rotation can reach: s1 + s2 + s3, or s1 + s2 - s3 where det F < 0.
double largestTrace(const Mat3& F)
{
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(dense(F), Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d s = svd.singularValues();
    const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
    return s(0) + s(1) + sign * s(2);
}

using PolarCase = std::tuple<NamedMatrix, NamedMatrix>;  // F, initial guess

class PolarRotation : public testing::TestWithParam<PolarCase>
{
};

// For any F and initial guess the result is a rotation, and no rotation is nearer to F.
TEST_P(PolarRotation, IsTheNearestRotation)
{
    const Mat3 F = std::get<0>(GetParam()).m_matrix, guess = std::get<1>(GetParam()).m_matrix;
    const Mat3 R = polarRotation(F, guess);
    expectRotation(R);
    const double size = std::sqrt(squaredNorm(F));
    EXPECT_NEAR(trace(transposeTimes(R, F)), largestTrace(F), 2e-12 * size);
    const Mat3 S = transposeTimes(R, F);
    EXPECT_LE(distance(S, transpose(S)), 1e-8 * size);  // the gradient; the trace is stationary at its maximum
}

const NamedMatrix kGradients[] = {
    {"Identity", Mat3::identity()},
    {"Turned30", oblique(30)},
    {"Turned180", oblique(180)},
    {"Stretched", oblique(70) * scaledAxes(2, 1, 0.5)},
    {"StretchedAbout180", rotationAbout({0, 0, 1}, kPi) * scaledAxes(1.5, 1, 0.8)},
    {"Sheared", Mat3{{{1, 3, 0}, {0, 1, -2}, {0, 0, 1}}}},
    {"NearlyFlat", oblique(40) * scaledAxes(1, 1, 1e-9)},
    {"Flat", oblique(40) * scaledAxes(2, 1, 0)},
    {"Line", outer({1, 2, 3}, {0.5, -1, 0.2})},
    {"Point", Mat3()},
    {"Inverted", oblique(100) * scaledAxes(1.2, 0.9, -0.4)},
    {"Mirrored", scaledAxes(1, 1, -1)},
    {"InsideOut", scaledAxes(-1, -1, -1)},
    {"Large", 1e100 * (oblique(20) * scaledAxes(1, 2, 3))},
    {"Small", 1e-100 * (oblique(20) * scaledAxes(1, 2, 3))},
};

const NamedMatrix kGuesses[] = {
    {"FromIdentity", Mat3::identity()},
    {"From90", rotationAbout({0, 1, 0}, kPi / 2)},
    {"FromX180", rotationAbout({1, 0, 0}, kPi)},
    {"FromOblique180", oblique(180)},
    {"FromOblique179", oblique(179)},
};

INSTANTIATE_TEST_SUITE_P(Polar, PolarRotation,
                         testing::Combine(testing::ValuesIn(kGradients), testing::ValuesIn(kGuesses)),
                         [](const auto& suite)
                         { return std::string(std::get<0>(suite.param).m_name) + std::get<1>(suite.param).m_name; });

// det F > 0: the rotation is unique and does not depend on the initial guess.
TEST(Rotation, KnownFactorsAreFound)
{
    RandomVectors random(5);
    for (int k = 0; k < 200; ++k)
    {
        const Mat3 Q = rotationAbout(random.next(), kPi * random.next().x);
        const Mat3 guess = rotationAbout(random.next(), kPi * random.next().x);
        const Mat3 axes = rotationAbout(random.next(), 1);
        const Vec3 s = random.next();
        const Mat3 S = axes * timesTranspose(scaledAxes(1 + 0.9 * s.x, 1 + 0.9 * s.y, 1 + 0.9 * s.z), axes);
        EXPECT_LE(distance(polarRotation(Q * S, guess), Q), 1e-13 * 20) << k;  // 20: the condition of F
    }
}

TEST(Rotation, TurnsWithF)
{
    const Mat3 F = {{{1, .2, -.3}, {.1, .8, .5}, {0, -.4, 1.3}}}, Q = oblique(130);
    const Mat3 R = polarRotation(F, Mat3::identity());
    EXPECT_LE(distance(polarRotation(Q * F, Mat3::identity()), Q * R), 1e-14);
    EXPECT_LE(distance(polarRotation(F * Q, Mat3::identity()), R * Q), 1e-14);
}

// With its own result as initial guess R changes by rounding only: an element at rest does not creep.
TEST(Rotation, IsAFixedPointOfItself)
{
    Mat3 R = polarRotation(oblique(77) * scaledAxes(1.1, 1, 0.9), Mat3::identity());
    const Mat3 first = R;
    for (int k = 0; k < 1000; ++k) R = polarRotation(oblique(77) * scaledAxes(1.1, 1, 0.9), R);
    EXPECT_LE(distance(R, first), 1e-14);
    expectRotation(R);
}

// Directions that F does not determine are taken from the initial guess; the threshold of 1e-12 leaves 2e-16 / 1e-12 of
// rounding.
TEST(Rotation, ReturnsGuessInUndeterminedDirections)
{
    const Mat3 guess = oblique(50);
    EXPECT_LE(distance(polarRotation(Mat3(), guess), guess), 1e-14);

    const Vec3 a = {1, 2, 3};
    const Mat3 about = rotationAbout(a, 0.7);
    EXPECT_LE(distance(polarRotation(outer(a, a), about), about), 1e-3);
}

// NaN gives the initial guess, with no read of uninitialised memory.
TEST(Rotation, ReturnsGuessForNaN)
{
    const Mat3 guess = oblique(50);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200})
    {
        Mat3 F = oblique(10);
        F(1, 2) = bad;
        F(2, 0) = -bad;
        EXPECT_EQ(0, distance(polarRotation(F, guess), guess)) << bad;
    }
}

// F from regular to inverted and back: R stays a rotation, and equals the first one at the end.
TEST(Rotation, RecoversFromInversion)
{
    const Mat3 Q = oblique(25);
    Mat3 R = Q;
    for (int k = 0; k <= 40; ++k)
    {
        R = polarRotation(Q * scaledAxes(1.2, 1, std::cos(2 * kPi * k / 40)), R);
        expectRotation(R);
    }
    EXPECT_LE(distance(R, Q), 1e-13);
}

}  // namespace
}  // namespace bullet_fem
