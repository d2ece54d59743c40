// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact/elastic_rebound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

const double kPi = std::acos(-1);

constexpr double kMobility = 0.5;  // of a mass of 2 kg [1/kg]

// Separation over approach speed of one patch; 0: the two do not separate.
double elasticRestitution(const PatchResponse& response, double mobility, double speed, double acceleration)
{
    std::vector<double> parting;
    return findPartingSpeeds({{response}, {mobility}, {speed}, {acceleration}}, parting) ? parting[0] / speed : 0;
}

// A mass of 2 kg on a spring and a damper without mass.
PatchResponse springOf(double frequency, double dampingRatio)
{
    constexpr double kLight = 1e6;  // mobility of the spring's end over that of the mass [-]
    PatchResponse response;
    response.m_vibrations[0] = {kLight * kMobility, kLight * frequency * frequency, 2 * dampingRatio / frequency};
    response.m_count = 1;
    return response;
}

// A mass that meets a spring and a damper leaves when their force is zero [Schwager & Poeschel 2007].
TEST(ElasticRestitution, IsThatOfADampedSpring)
{
    for (const double ratio : {0.0, 0.05, 0.2, 0.5})
    {
        const double damped = std::sqrt(1 - ratio * ratio);
        const double expected = std::exp(-ratio / damped * std::atan2(2 * ratio * damped, 2 * ratio * ratio - 1));
        for (const double frequency : {10.0, 1000.0})
            EXPECT_NEAR(elasticRestitution(springOf(frequency, ratio), kMobility, 1, 0), expected, 0.02) << ratio;
    }
}

// A body whose weight holds the spring compressed does not leave; without damping every speed returns.
TEST(ElasticRestitution, IsZeroForBodiesThatDoNotLeave)
{
    constexpr double kFrequency = 20, kWeight = 9.81;  // [rad/s], [m/s2]
    const double slow = 0.1 * kWeight / kFrequency;
    EXPECT_EQ(elasticRestitution(springOf(kFrequency, 0.3), kMobility, slow, kWeight), 0);
    EXPECT_GT(elasticRestitution(springOf(kFrequency, 0), kMobility, 100 * slow, kWeight), 0.9);
    EXPECT_EQ(elasticRestitution(PatchResponse(), kMobility, 1, 0), 0);
}

// Equal masses in a row, with equal springs between them, of which one comes with a speed of 1: the last takes nearly
// all of it, and none of the energy is lost. The speeds of three masses are -.129, .148 and .981.
TEST(ElasticRestitution, PassesThroughARow)
{
    for (const std::size_t masses : {std::size_t(3), std::size_t(5)})
    {
        const std::size_t patches = masses - 1;
        MeetingPatches row;
        row.m_responses.assign(patches, springOf(100, 0));
        row.m_speed.assign(patches, 0);
        row.m_speed[0] = 1;
        row.m_acceleration.assign(patches, 0);
        row.m_compliance.assign(patches * patches, 0);
        for (std::size_t p = 0; p < patches; ++p)
        {
            row.m_compliance[p * patches + p] = 2 * kMobility;
            if (p > 0) row.m_compliance[p * patches + p - 1] = row.m_compliance[(p - 1) * patches + p] = -kMobility;
        }
        std::vector<double> parting;
        ASSERT_TRUE(findPartingSpeeds(row, parting));
        std::vector<double> v(masses, 0);
        for (std::size_t p = 0; p < patches; ++p)
            for (std::size_t k = 0; k < masses; ++k)
                v[k] += parting[p] * (double(p + 1) / double(masses) - (k <= p ? 1 : 0));
        double energy = 0;
        for (double& speed : v)
        {
            speed += 1 / double(masses);
            energy += speed * speed;
        }
        EXPECT_NEAR(energy, 1, 0.05);
        EXPECT_GT(v.back(), 0.9);
        if (masses == 3)
        {
            EXPECT_NEAR(v.back(), 0.981, 0.02);
        }
    }
}

// A bar that is struck on its end face.
class StruckBar : public testing::Test
{
protected:
    StruckBar()
    {
        StepSettings settings;
        solveFreeMotion(m_body, settings);
        const BodyState& state = m_body.m_state;
        m_impulses.resize(state.m_x.size());
        double mass = 0;
        for (std::size_t i = 0; i < m_impulses.size(); ++i)
            if (isStruck(state.m_x[i])) mass += state.m_mass[i];
        for (std::size_t i = 0; i < m_impulses.size(); ++i)
            if (isStruck(state.m_x[i])) m_impulses[i].x = state.m_mass[i] / mass;
    }

    // Static compliance of the patch, without rigid motion [m/N].
    static double softness(const PatchResponse& response)
    {
        double sum = 0;
        for (int k = 0; k < response.m_count; ++k)
            sum += response.m_vibrations[k].m_mobility / response.m_vibrations[k].m_frequency;
        return sum;
    }

    static bool isStruck(const Vec3& x) { return x.x < 1e-6; }

    static constexpr double kLength = 2, kWidth = 0.2;      // [m]
    static constexpr double kYoung = 1e6, kDensity = 1000;  // [Pa], [kg/m3]
    const double m_mass = kLength * kWidth * kWidth * kDensity;
    Body m_body = makeBody(makeBox(Vec3{kLength, kWidth, kWidth}, {20, 2, 2}), elasticMaterial(kYoung, 0, kDensity));
    std::vector<Vec3> m_impulses;
    PatchResponse m_response;
};

// The longitudinal vibrations of a bar have the frequencies k pi c / L, and its end the mobility 2 / m in each.
TEST_F(StruckBar, HasLongitudinalVibrations)
{
    ASSERT_TRUE(addVibrations(m_body, m_impulses, m_response));
    const PatchResponse::Vibration* lowest = &m_response.m_vibrations[0];
    double all = 0;
    for (int k = 0; k < m_response.m_count; ++k)
    {
        const PatchResponse::Vibration& vibration = m_response.m_vibrations[k];
        if (vibration.m_frequency < lowest->m_frequency) lowest = &vibration;
        all += vibration.m_mobility;
    }
    const double speedOfSound = std::sqrt(kYoung / kDensity);
    EXPECT_NEAR(std::sqrt(lowest->m_frequency), kPi * speedOfSound / kLength, 0.01 * kPi * speedOfSound / kLength);
    EXPECT_NEAR(lowest->m_mobility, 2 / m_mass, 0.02 * 2 / m_mass);
    double expected = -1 / m_mass;
    for (std::size_t i = 0; i < m_impulses.size(); ++i)
        expected += dot(m_impulses[i], m_impulses[i]) / m_body.m_state.m_mass[i];
    EXPECT_NEAR(all, expected, 1e-3 * expected);
}

// The wave returns to the struck end when the bar leaves: all of the speed returns, as in the theory of impacts of
// bars.
TEST_F(StruckBar, ReturnsItsSpeed)
{
    ASSERT_TRUE(addVibrations(m_body, m_impulses, m_response));
    EXPECT_GT(elasticRestitution(m_response, 1 / m_mass, 1, 0), 0.9);
}

// The response of a turned body is turned.
TEST_F(StruckBar, RespondsAlikeWhereTurned)
{
    ASSERT_TRUE(addVibrations(m_body, m_impulses, m_response));
    const Mat3 turn = rotationAbout({1, 2, 3}, 1);
    for (Vec3& x : m_body.m_state.m_x) x = turn * x;
    for (Vec3& impulse : m_impulses) impulse = turn * impulse;
    solveFreeMotion(m_body, StepSettings());
    PatchResponse turned;
    ASSERT_TRUE(addVibrations(m_body, m_impulses, turned));
    EXPECT_NEAR(softness(turned), softness(m_response), 1e-3 * softness(m_response));
}

TEST(ElasticRestitution, RefusesTooManyPatchesAndListsOfOtherSizes)
{
    MeetingPatches patches;
    const auto resize = [&patches](std::size_t count)
    {
        patches.m_responses.resize(count);
        patches.m_speed.resize(count, 1);
        patches.m_acceleration.resize(count);
        patches.m_compliance.resize(count * count, 1);
    };
    std::vector<double> parting;
    resize(MeetingPatches::kMaxCount);
    EXPECT_FALSE(findPartingSpeeds(patches, parting));
    patches.m_speed.pop_back();
    EXPECT_THROW(findPartingSpeeds(patches, parting), std::invalid_argument);
    resize(MeetingPatches::kMaxCount + 1);
    EXPECT_THROW(findPartingSpeeds(patches, parting), std::invalid_argument);
}

}  // namespace
}  // namespace bullet_fem
