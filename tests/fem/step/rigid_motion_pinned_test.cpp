// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies pinned at a point or on a line have three rigid modes or one, which are as exact as those of free bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fem/body/step_scratch.h"
#include "fem/scenes/free_bodies.h"

namespace bullet_fem
{
namespace
{

constexpr double kRightAngle = 1.5707963267948966;  // [rad]

// Nodes of the bar's end that are fixed: a corner, or those of an edge along z.
enum class Pins
{
    point,
    line
};

class PinnedBar
{
public:
    PinnedBar(Pins pins, double young, double bend) : m_body(makeBody(makeFreeBar(), barMaterial(young), isFixed(pins)))
    {
        if (bend > 0) bullet_fem::bend(m_body, bend);
        const std::vector<Vec3>& X = m_body.m_model->mesh().restPositions();
        for (std::size_t i = 0; i < X.size(); ++i)
            if (m_body.m_state.m_fixed[i])
            {
                m_pin = m_body.m_state.m_x[i];
                if (pins == Pins::point) break;
            }
        // Pins on an edge along z stay on a line, because the bend is about z.
        m_axis = pins == Pins::line ? Vec3{0, 0, 1} : Vec3{};
    }

    // Spins about the pins [rad/s], with random velocities in addition.
    void release(const Vec3& omega)
    {
        RandomVectors random(5);
        for (std::size_t i = 0; i < m_body.m_state.m_x.size(); ++i)
        {
            const Vec3 added = 0.1 * random.next();
            if (!m_body.m_state.m_fixed[i]) m_body.m_state.m_v[i] = cross(omega, m_body.m_state.m_x[i] - m_pin) + added;
        }
    }

    // Sums of r x p about the pin, of the part along the hinge, with that of |r| |p|.
    struct Sum
    {
        Vec3 m_angular;
        double m_size = 0;
    };
    Sum sumOf(const std::vector<Vec3>& x, const std::vector<Vec3>& p) const
    {
        Sum sum;
        for (std::size_t i = 0; i < x.size(); ++i)
        {
            if (m_body.m_state.m_fixed[i]) continue;
            sum.m_angular += cross(x[i] - m_pin, p[i]);
            sum.m_size += norm(x[i] - m_pin) * norm(p[i]);
        }
        if (dot(m_axis, m_axis) > 0) sum.m_angular = dot(sum.m_angular, m_axis) * m_axis;
        return sum;
    }
    Sum momentum() const
    {
        std::vector<Vec3> p = m_body.m_state.m_v;
        for (std::size_t i = 0; i < p.size(); ++i) p[i] *= m_body.m_state.m_mass[i];
        return sumOf(m_body.m_state.m_x, p);
    }

    Body m_body;

private:
    static NodePredicate isFixed(Pins pins)
    {
        return [pins](const Vec3& X)
        { return X.x < -0.499 * kBarLength && X.y < -0.0149 && (pins == Pins::line || X.z < -0.0149); };
    }

    Vec3 m_pin, m_axis;
};

class PinnedResponses : public testing::TestWithParam<std::tuple<Pins, double, double>>  // E [Pa], bend [rad]
{
};

TEST_P(PinnedResponses, NeedFewIterationsWhateverTheStiffness)
{
    const auto& [pins, young, bend] = GetParam();
    int most = 0;
    for (unsigned seed = 1; seed <= 5; ++seed)
    {
        PinnedBar bar(pins, young, bend);
        RandomVectors random(seed);
        std::vector<Vec3> impulses;
        for (const Vec3& X : bar.m_body.m_model->mesh().restPositions())
            impulses.push_back(X.x > 0.499 * kBarLength ? 0.01 * random.next() : Vec3());
        const StepSettings settings;
        solveFreeMotion(bar.m_body, settings);
        const SolveReport report = applyImpulses(bar.m_body, impulses, settings);
        EXPECT_EQ(report.m_stop, SolveStop::converged);
        most = std::max(most, report.m_iterations);
    }
    RecordProperty("iterations", most);
    // A dense prototype needs 8 and 14.
    EXPECT_LE(most, bend < 1 ? 9 : pins == Pins::point ? 15 : 22);
}

std::string nameOfPins(Pins pins)
{
    return pins == Pins::point ? "AtAPoint" : "OnALine";
}

INSTANTIATE_TEST_SUITE_P(Bars, PinnedResponses,
                         testing::Combine(testing::Values(Pins::point, Pins::line), testing::Values(1e4, 1e6, 1e8, 1e9),
                                          testing::Values(kRightAngle / 3, kRightAngle)),
                         [](const auto& suite)
                         {
                             return nameOfPins(std::get<0>(suite.param)) + "_" + nameOfYoung(std::get<1>(suite.param)) +
                                    (std::get<2>(suite.param) < 1 ? "_Bent30" : "_Bent90");
                         });

class PinnedMomentum : public testing::TestWithParam<std::tuple<Pins, double, double, double>>  // E, damping, tolerance
{
};

// Impulses and loads act about the pin or the line of the pins.
TEST_P(PinnedMomentum, IsExactAboutThePins)
{
    const auto& [pins, young, damping, tolerance] = GetParam();
    PinnedBar bar(pins, young, kRightAngle / 3);
    bar.release(pins == Pins::point ? Vec3{3, 5, 8} : Vec3{0, 0, 8});
    StepSettings settings;
    settings.m_numericalDamping = damping;
    settings.m_tolerance = tolerance;
    Body& body = bar.m_body;
    RandomVectors random(9);
    for (Vec3& f : body.m_loads.m_force) f = 0.02 * random.next();
    double error = 0;
    for (int k = 0; k < 60; ++k)
    {
        const PinnedBar::Sum before = bar.momentum();
        std::vector<Vec3> given = body.m_loads.m_force, impulses(given.size());
        for (std::size_t i = 0; i < given.size(); ++i)
        {
            if (i % 5 == 0) impulses[i] = 1e-3 * random.next();
            given[i] = settings.m_step * given[i] + impulses[i];
        }
        solveFreeMotion(body, settings);
        applyImpulses(body, impulses, settings);
        finishStep(body, settings);
        const Vec3 torque = bar.sumOf(body.m_workspace.scratch().m_kickPosition, given).m_angular;
        const PinnedBar::Sum now = bar.momentum();
        error = std::max(error, norm(now.m_angular - before.m_angular - torque) / now.m_size);
    }
    RecordProperty("angular", std::to_string(1e12 * error) + "e-12");
    EXPECT_LE(error, 1e-12);
    EXPECT_GT(kineticEnergy(body.m_state), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Bars, PinnedMomentum,
                         testing::Combine(testing::Values(Pins::point, Pins::line), testing::Values(1e5, 1e8),
                                          testing::Values(0, 1), testing::Values(1e-3, 1e-10)),
                         [](const auto& suite)
                         {
                             return nameOfPins(std::get<0>(suite.param)) + "_" + nameOfYoung(std::get<1>(suite.param)) +
                                    "_" + nameOfDamping(std::get<2>(suite.param)) +
                                    (std::get<3>(suite.param) < 1e-6 ? "_Double" : "_Single");
                         });

}  // namespace
}  // namespace bullet_fem
