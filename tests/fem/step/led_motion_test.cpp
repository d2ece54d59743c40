// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bars without gravity whose fixed nodes lead them on.
#include "fem/body/led_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

constexpr double kOmega = 2, kAcceleration = 6;  // [rad/s], [m/s2]
constexpr double kArm = 1;                       // distance of the bar's end from the axis [m]

enum class Lead
{
    turn,       // about an axis beyond the bar's end
    accelerate  // along the bar, from rest
};

// Lead, numerical damping [-], stiffness damping [s].
class LedBar : public testing::TestWithParam<std::tuple<Lead, double, double>>
{
protected:
    LedBar() : m_body(bar())
    {
        m_settings.m_numericalDamping = std::get<1>(GetParam());
        m_settings.m_tolerance = 1e-5;
        for (std::size_t i = 0; i < m_rest.size(); ++i)
            if (turns()) m_body.m_state.m_v[i] = cross({0, 0, kOmega}, m_rest[i]);
    }

    static bool turns() { return std::get<0>(GetParam()) == Lead::turn; }

    static Body bar()
    {
        Material material = elasticMaterial(1e6, 0);
        material.m_stiffnessDamping = std::get<2>(GetParam());
        return makeBody(makeBox({1, 0.08, 0.08}, {10, 2, 2}, {kArm, -0.04, -0.04}), material,
                        [](const Vec3& X) { return X.x == kArm; });
    }

    Vec3 led(const Vec3& X, double time) const
    {
        return turns() ? rotationAbout({0, 0, 1}, kOmega * time) * X
                       : X + Vec3{0.5 * kAcceleration * time * time, 0, 0};
    }

    void stepTo(double time)
    {
        for (std::size_t i = 0; i < m_rest.size(); ++i)
            if (m_body.m_state.m_fixed[i])
                m_body.m_loads.m_targetVelocity[i] =
                    (1 / m_settings.m_step) * (led(m_rest[i], time) - m_body.m_state.m_x[i]);
        step(m_body, m_settings);
    }

    // Distance between the centroids of the end faces [m].
    double length() const
    {
        Vec3 apart;
        for (std::size_t i = 0; i < m_rest.size(); ++i)
            if (m_rest[i].x == kArm)
                apart -= 1.0 / 9 * m_body.m_state.m_x[i];
            else if (m_rest[i].x > kArm + 0.999)
                apart += 1.0 / 9 * m_body.m_state.m_x[i];
        return norm(apart);
    }

    // E y'' = -rho w^2 y in the turned state, or E u'' = rho a.
    static double expectedStretch()
    {
        if (!turns()) return -0.5e-3 * kAcceleration;
        const double k = kOmega * std::sqrt(1e-3);
        return kArm * std::cos(k) + (1 / k + kArm * std::sin(k)) * std::tan(k) - kArm - 1;
    }

    Body m_body;
    const std::vector<Vec3>& m_rest = m_body.m_model->mesh().restPositions();
    StepSettings m_settings;
};

TEST_P(LedBar, IsStretchedByItsInertia)
{
    double stretch = 0;
    const int count = 120;  // two seconds
    for (int k = 1; k <= 2 * count; ++k)
    {
        stepTo(k * m_settings.m_step);
        if (k > count) stretch += (length() - 1) / count;
    }
    EXPECT_NEAR(stretch / expectedStretch(), 1, 0.02);
}

TEST_P(LedBar, ArrivesAtItsTargets)
{
    double farthest = 0, fastest = 0;
    for (int k = 1; k <= 20; ++k)
    {
        stepTo(k * m_settings.m_step);
        for (std::size_t i = 0; i < m_rest.size(); ++i)
        {
            if (!m_body.m_state.m_fixed[i]) continue;
            farthest = std::max(farthest, norm(m_body.m_state.m_x[i] - led(m_rest[i], k * m_settings.m_step)));
            fastest = std::max(fastest, norm(m_body.m_state.m_v[i] - m_body.m_loads.m_targetVelocity[i]));
        }
    }
    EXPECT_LT(farthest, 1e-14);
    EXPECT_EQ(fastest, 0);
}

INSTANTIATE_TEST_SUITE_P(Bars, LedBar,
                         testing::Combine(testing::Values(Lead::turn, Lead::accelerate), testing::Values(0.0, 1.0),
                                          testing::Values(0.005, 0.1)),
                         [](const auto& suite)
                         {
                             return std::string(std::get<0>(suite.param) == Lead::turn ? "turned_" : "accelerated_") +
                                    (std::get<1>(suite.param) == 1 ? "implicitEuler_" : "secondOrder_") +
                                    std::to_string(std::lround(1000 * std::get<2>(suite.param))) + "ms";
                         });

// --- The motion of the fixed nodes ---

class FoundMotion : public testing::Test
{
protected:
    // A bar whose nodes at the places turn by `angle` about z through the origin, along with its motion.
    void find(const NodePredicate& fixed, double angle)
    {
        m_body = std::make_unique<Body>(makeBody(makeBox({1, 0.1, 0.1}, {4, 2, 2}), elasticMaterial(1e6, 0.3), fixed));
        const Mat3 R = rotationAbout({0, 0, 1}, angle);
        for (std::size_t i = 0; i < x().size(); ++i)
            m_body->m_loads.m_targetVelocity[i] = (1 / kStep) * (R * x()[i] - x()[i]);
        m_led = std::make_unique<LedMotion>(m_body->m_model->mesh());
        m_led->find(m_body->m_model->mesh(), m_body->m_state, m_body->m_loads, kStep);
    }

    const std::vector<Vec3>& x() const { return m_body->m_state.m_x; }

    static constexpr double kStep = 0.01;
    std::unique_ptr<Body> m_body;
    std::unique_ptr<LedMotion> m_led;
};

TEST_F(FoundMotion, IsTheTurnOfThePatch)
{
    find([](const Vec3& X) { return X.x == 0; }, 0.4);
    const std::size_t far = x().size() - 1;
    ASSERT_TRUE(m_led->turns());
    const Vec3 lever = x()[far] - x()[0];
    EXPECT_LT(norm(m_led->inwardAt(0, x()[far]) + 40 * 40 * Vec3{lever.x, lever.y, 0}), 1e-9);
}

TEST_F(FoundMotion, OfALineHasNoSpinAboutIt)
{
    find([](const Vec3& X) { return X.y == 0 && X.z == 0; }, 0.4);
    const std::size_t far = x().size() - 1;
    ASSERT_TRUE(m_led->turns());
    const Vec3 lever = x()[far] - x()[0];
    EXPECT_LT(norm(m_led->inwardAt(0, x()[far]) + 40 * 40 * Vec3{lever.x, lever.y, 0}), 1e-9);
}

TEST_F(FoundMotion, OfAHingeIsNone)
{
    find([](const Vec3& X) { return X.x == 0 && X.y == 0; }, 0.4);  // turns the axis in itself
    EXPECT_FALSE(m_led->turns());
}

}  // namespace
}  // namespace bullet_fem
