// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Free bodies that spin: their stretch, their energy, and the motion of their axes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fem/scenes/free_bodies.h"

namespace bullet_fem
{
namespace
{

constexpr double kDensity = 1000;  // of all bodies [kg/m3]

// From the centroid of one end face of the bar to that of the other [m].
Vec3 axisOf(const Body& body)
{
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    std::vector<double> left, right;
    for (const Vec3& Xi : X)
    {
        left.push_back(Xi.x < -0.499 * kBarLength);
        right.push_back(Xi.x > 0.499 * kBarLength);
    }
    return weightedMean(right, body.m_state.m_x) - weightedMean(left, body.m_state.m_x);
}

// Stretch of a bar of E [Pa] that spins about its centre [-]: of E u'' = -rho w^2 (X + u), u' = 0 at the ends, which is
// rho w^2 L^2 / 12 E for small ones.
double stretchOf(double young, double omega)
{
    const double angle = omega * std::sqrt(kDensity / young) * kBarLength / 2;
    return std::tan(angle) / angle - 1;
}

class SpinningBar : public testing::TestWithParam<std::tuple<double, double, double>>  // E [Pa], w [rad/s], damping
{
protected:
    SpinningBar()
    {
        spin(m_body, {0, 0, std::get<1>(GetParam())});
        m_settings.m_numericalDamping = std::get<2>(GetParam());
    }

    static Material material()
    {
        Material result = barMaterial(std::get<0>(GetParam()));
        result.m_poissonRatio = 0;
        return result;
    }

    Body m_body = makeBody(makeFreeBar({16, 2, 2}), material());
    StepSettings m_settings;
};

// The bar stretches and so spins slower: the theory's spin is the present one. Positions and forces in single precision
// resolve a stretch of 1e-8.
TEST_P(SpinningBar, StretchesByTheCentrifugalForce)
{
    double stretch = 0, theory = 0;
    for (int k = 0; k < 240; ++k)
    {
        step(m_body, m_settings);
        if (k < 120) continue;
        const Vec3 axis = axisOf(m_body);
        const double across = norm(cross(rigidMotionOf(m_body).spin(), axis)) / norm(axis);
        stretch += (norm(axis) / kBarLength - 1) / 120;
        theory += stretchOf(std::get<0>(GetParam()), across) / 120;
    }
    RecordProperty("stretch", std::to_string(stretch / theory));
    EXPECT_NEAR(stretch, theory, 0.03 * theory + 1e-8) << stretch / theory;
}

std::string nameOfSpinning(const testing::TestParamInfo<SpinningBar::ParamType>& suite)
{
    const auto& [young, omega, damping] = suite.param;
    return nameOfDamping(damping) + "_" + nameOfYoung(young) + "_" + std::to_string(std::lround(omega)) + "PerSecond";
}

INSTANTIATE_TEST_SUITE_P(Soft, SpinningBar,
                         testing::Combine(testing::Values(1e4), testing::Values(2.0, 6.0, 9.0), testing::Values(0, 1)),
                         nameOfSpinning);
INSTANTIATE_TEST_SUITE_P(Stiff, SpinningBar,
                         testing::Combine(testing::Values(1e5, 1e6, 1e7), testing::Values(2.0, 6.0, 20.0),
                                          testing::Values(0, 1)),
                         nameOfSpinning);

class SpinningMinute : public SpinningBar
{
};

// Stretched by 1.3e-3 at 1e6 Pa, a bar has lost 1.6e-3 of its energy.
TEST_P(SpinningMinute, KeepsItsEnergy)
{
    const double start = mechanicalEnergy(m_body);
    const RigidMotion before = rigidMotionOf(m_body);
    double lowest = 1, highest = 1;
    for (int k = 1; k <= 3600; ++k)
    {
        step(m_body, m_settings);
        if (k % 20 > 0) continue;
        const double share = mechanicalEnergy(m_body) / start;
        lowest = std::min(lowest, share);
        highest = std::max(highest, share);
    }
    const RigidMotion after = rigidMotionOf(m_body);
    const double change = norm(after.m_angular - before.m_angular) / before.m_angularSize;
    RecordProperty("energy", std::to_string(lowest) + ".." + std::to_string(highest));
    EXPECT_GT(lowest, 0.99);
    EXPECT_LT(highest, 1.01);
    EXPECT_LT(change, 3600 * 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Bars, SpinningMinute,
                         testing::Combine(testing::Values(1e6, 1e7, 1e8, 1e9), testing::Values(20.0),
                                          testing::Values(0, 1)),
                         nameOfSpinning);

// Euler's equations in the frame of a rigid body, dL/dt = L x I^-1 L, by the classical Runge-Kutta method.
class RigidSpin
{
public:
    explicit RigidSpin(const RigidMotion& motion) : m_inverse(inverse(motion.m_inertia)), m_angular(motion.m_angular) {}

    void advance(double time)
    {
        constexpr int kSteps = 100;
        const double h = time / kSteps;
        for (int k = 0; k < kSteps; ++k)
        {
            const Vec3 a = rate(m_angular), b = rate(m_angular + 0.5 * h * a), c = rate(m_angular + 0.5 * h * b),
                       d = rate(m_angular + h * c);
            m_angular += h / 6 * (a + 2 * b + 2 * c + d);
        }
    }

    const Vec3& angularMomentum() const { return m_angular; }

private:
    Vec3 rate(const Vec3& L) const { return cross(L, m_inverse * L); }

    Mat3 m_inverse;
    Vec3 m_angular;  // in the body's frame
};

// Times at which a quantity, given once a step, passes zero.
class ZeroCrossings
{
public:
    explicit ZeroCrossings(double value) : m_last(value) {}

    void add(double value)
    {
        if (value * m_last < 0) m_times.push_back(m_count + m_last / (m_last - value));
        m_last = value;
        ++m_count;
    }

    int count() const { return static_cast<int>(m_times.size()); }

    // Mean distance of the first `count` crossings, at least 2 [steps].
    double interval(int count) const { return (m_times[count - 1] - m_times[0]) / (count - 1); }

private:
    double m_last;
    int m_count = 0;
    std::vector<double> m_times;  // [steps]
};

// A stiff body that spins freely, and a rigid one beside it. Axes of the body are given by nodes of the mesh.
class StiffSpin
{
public:
    StiffSpin(const TetMesh& mesh, const Vec3& omega, double numericalDamping)
        : m_body(makeBody(mesh, barMaterial(1e8)))
    {
        spin(m_body, omega);
        m_start = rigidMotionOf(m_body);
        m_settings.m_numericalDamping = numericalDamping;
    }

    // Component of angular momentum along the axis between the nodes at -X and X.
    double along(const Vec3& X) const
    {
        const Vec3 axis = position(X) - position(-X);
        return dot(rigidMotionOf(m_body).m_angular, axis) / norm(axis);
    }

    // Angle between angular momentum and that axis in the plane across a fixed angular momentum [rad].
    Vec3 axis(const Vec3& X) const { return position(X) - position(-X); }

    void advance()
    {
        const RigidMotion before = rigidMotionOf(m_body);
        step(m_body, m_settings);
        const RigidMotion after = rigidMotionOf(m_body);
        m_error = std::max(m_error, norm(after.m_angular - before.m_angular) / after.m_angularSize);
    }

    const RigidMotion& start() const { return m_start; }
    double momentumError() const { return m_error; }  // maximum of a step, of sum m |r| |v|
    double stepSize() const { return m_settings.m_step; }

private:
    Vec3 position(const Vec3& X) const { return m_body.m_state.m_x[nodeAt(m_body.m_model->mesh(), X)]; }

    Body m_body;
    StepSettings m_settings;
    RigidMotion m_start;
    double m_error = 0;
};

class StiffBody : public testing::TestWithParam<std::tuple<double, double>>  // spin [rad/s], numerical damping
{
};

// The spin about the middle axis is unstable: the body turns over again and again, and the interval depends on the
// energy.
TEST_P(StiffBody, FlipsAboutItsMiddleAxisAsEulersEquationsDo)
{
    const auto& [omega, damping] = GetParam();
    const Vec3 middle = {0, 0.06, 0};
    StiffSpin box(makeBox({0.2, 0.12, 0.05}, {4, 2, 2}, {-0.1, -0.06, -0.025}), {0.05 * omega, omega, 0}, damping);
    RigidSpin rigid(box.start());
    ZeroCrossings flips(box.along(middle)), expected(rigid.angularMomentum().y);
    const int steps = static_cast<int>(std::lround(150 / (omega * box.stepSize())));
    for (int k = 0; k < steps; ++k)
    {
        box.advance();
        rigid.advance(box.stepSize());
        flips.add(box.along(middle));
        expected.add(rigid.angularMomentum().y);
    }
    const int count = std::min(flips.count(), expected.count());
    EXPECT_LT(box.momentumError(), 1e-12);
    ASSERT_GE(count, 6);
    RecordProperty("interval", std::to_string(flips.interval(count) / expected.interval(count)));
    // The interval depends on the logarithm of the energy's distance from that of a steady spin: faster bodies lose
    // some of it by the damping of their vibrations.
    const bool isSlow = omega < (damping > 0 ? 15 : 30);
    EXPECT_NEAR(flips.interval(count) / expected.interval(count), 1, isSlow ? 0.012 : 0.2);
}

// The axis of a disc nods about its angular momentum L at the rate |L| / I of a diameter.
TEST_P(StiffBody, NodsAsASymmetricTop)
{
    const auto& [omega, damping] = GetParam();
    const Vec3 axis = {0, 0, 0.015};
    StiffSpin disc(makeCylinder(0.1, 0.03, 6, 2), {0.2 * omega, 0, omega}, damping);
    const Vec3 L = disc.start().m_angular;
    const double across = 0.5 * (trace(disc.start().m_inertia) - disc.start().m_inertia(2, 2));
    const auto beside = [&]
    {
        const Vec3 a = disc.axis(axis);
        return a - (dot(a, L) / dot(L, L)) * L;
    };
    double turned = 0;
    Vec3 last = beside();
    constexpr int kSteps = 300;
    for (int k = 0; k < kSteps; ++k)
    {
        disc.advance();
        const Vec3 now = beside();
        turned += std::atan2(dot(cross(last, now), L) / norm(L), dot(last, now));
        last = now;
    }
    const double expected = norm(L) / across * kSteps * disc.stepSize();
    RecordProperty("rate", std::to_string(turned / expected));
    EXPECT_LT(disc.momentumError(), 1e-12);
    EXPECT_NEAR(turned / expected, 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Spins, StiffBody,
                         testing::Combine(testing::Values(5.0, 10.0, 20.0, 40.0), testing::Values(0, 1)),
                         [](const auto& suite)
                         {
                             return nameOfDamping(std::get<1>(suite.param)) + "_" +
                                    std::to_string(std::lround(std::get<0>(suite.param))) + "PerSecond";
                         });

}  // namespace
}  // namespace bullet_fem
