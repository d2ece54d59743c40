// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fem/body/step_scratch.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

struct Solver
{
    const char* m_name;
    Warp m_warp;
    bool m_direct;
    double m_tolerance;
    double m_numericalDamping = 1;
};

void PrintTo(const Solver& solver, std::ostream* out)
{
    *out << solver.m_name;
}

StepSettings settingsOf(const Solver& solver)
{
    StepSettings settings;
    settings.m_warp = solver.m_warp;
    settings.m_direct = solver.m_direct;
    settings.m_tolerance = solver.m_tolerance;
    settings.m_numericalDamping = solver.m_numericalDamping;
    return settings;
}

// The weight theta of the end velocities in the displacement of a step [-].
double theta(double numericalDamping)
{
    return 0.5 * (1 + numericalDamping);
}

double sumOfMomenta(const BodyState& s)
{
    double sum = 0;
    for (std::size_t i = 0; i < s.m_v.size(); ++i) sum += s.m_mass[i] * norm(s.m_v[i]);
    return sum;
}

class ElasticityMomentum : public testing::TestWithParam<Solver>
{
};

// x0 + n h v0 + g h^2 (n (n - 1) / 2 + theta n), the integrator's exact sum; elastic forces vanish.
TEST_P(ElasticityMomentum, FreeFlightIsExact)
{
    Body body = makeBody(makeBox({1, .5, .5}, {4, 2, 2}), elasticMaterial(1e6, .3));
    const Vec3 v0 = {3, -1, 4}, g = {0, 0, -9.81};
    setGravity(body, g);
    body.m_state.m_v.assign(body.m_state.m_v.size(), v0);
    const StepSettings settings = settingsOf(GetParam());
    const int n = 120;
    for (int k = 0; k < n; ++k) step(body, settings);
    std::vector<Vec3> exact = body.m_model->mesh().restPositions();
    const double h = settings.m_step;
    for (Vec3& x : exact) x += n * h * v0 + h * h * (0.5 * n * (n - 1) + theta(settings.m_numericalDamping) * n) * g;
    // A uniform increment is the rigid warm start of the solve: only rounding of 120 sums of order 20 m remains.
    EXPECT_LE(largestDistance(body.m_state.m_x, exact), 1e-11);
}

// p = p0 + n h F and L = L0 + h sum of the torques about y, the positions at which a step's forces act, for a deformed,
// vibrating and rotating body, at any solver tolerance.
TEST_P(ElasticityMomentum, FollowsTheLoads)
{
    Body body = makeBody(makeBox({1, .5, .5}, {4, 2, 2}), elasticMaterial(1e5, .3));
    RandomVectors random(2);
    BodyState& s = body.m_state;
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        s.m_x[i] += 0.05 * random.next();
        s.m_v[i] = cross({1, 5, -3}, s.m_x[i]) + random.next();
        body.m_loads.m_force[i] = 10 * random.next();
    }
    const StepSettings settings = settingsOf(GetParam());
    const double h = settings.m_step;
    Vec3 p = linearMomentum(s), L = angularMomentum(s);
    for (int k = 0; k < 120; ++k)
    {
        step(body, settings);
        for (std::size_t i = 0; i < s.m_x.size(); ++i)
        {
            p += h * body.m_loads.m_force[i];
            L += h * cross(body.m_workspace.scratch().m_kickPosition[i], body.m_loads.m_force[i]);
        }
    }
    EXPECT_LE(norm(linearMomentum(s) - p), 1e-12 * sumOfMomenta(s));
    EXPECT_LE(norm(angularMomentum(s) - L), 1e-11 * sumOfMomenta(s));  // arms of order 1 m
    EXPECT_GT(kineticEnergy(s), 1);
}

std::string solverName(const testing::TestParamInfo<Solver>& info)
{
    return info.param.m_name;
}
INSTANTIATE_TEST_SUITE_P(Solvers, ElasticityMomentum,
                         testing::Values(Solver{"Nodal", Warp::nodal, false, 1e-3},
                                         Solver{"Global", Warp::global, false, 1e-3},
                                         Solver{"Accurate", Warp::nodal, false, 1e-10},
                                         Solver{"Direct", Warp::nodal, true, 1e-3},
                                         Solver{"SecondOrder", Warp::nodal, false, 1e-3, 0},
                                         Solver{"SecondOrderDirect", Warp::global, true, 1e-3, 0},
                                         Solver{"SomeDamping", Warp::nodal, false, 1e-3, 0.3}),
                         solverName);

// A plate of 1 x 1 x .25 m, 8 x 8 x 2 Kuhn cells, E 1e6, spinning about its short axis at omega [rad/s], h 1/60.
class Plate
{
public:
    explicit Plate(double omega, const Vec3& seed = {})
        : m_body(makeBody(makeBox({1, 1, .25}, {8, 8, 2}, {-.5, -.5, -.125}, CellSplit::kuhnSix),
                          elasticMaterial(1e6, .3)))
    {
        RandomVectors random(3);
        for (std::size_t i = 0; i < m_body.m_state.m_x.size(); ++i)
        {
            const Vec3 r = random.next();
            m_body.m_state.m_v[i] =
                cross({0, 0, omega}, m_body.m_state.m_x[i]) + Vec3{seed.x * r.x, seed.y * r.y, seed.z * r.z};
        }
        m_momentum = norm(angularMomentum(m_body.m_state));
    }

    void run(int steps, const StepSettings& settings)
    {
        for (int k = 0; k < steps; ++k) step(m_body, settings);
    }

    /// |L| over its initial value [-].
    double momentumRatio() const { return norm(angularMomentum(m_body.m_state)) / m_momentum; }

    Body m_body;

private:
    double m_momentum = 0;
};

TEST(ElasticitySpin, KeepsAngularMomentum)
{
    for (const double omega : {6., 12.})
        for (const double tolerance : {1e-10, 1e-3})
        {
            StepSettings settings;
            settings.m_tolerance = tolerance;
            Plate plate(omega);
            plate.run(60, settings);
            EXPECT_NEAR(plate.momentumRatio(), 1, 1e-12) << omega << " rad/s";
        }
}

TEST(ElasticitySpin, SlowSpinKeepsItsEnergy)
{
    Plate plate(1.5);  // omega h = .025
    const double start = mechanicalEnergy(plate.m_body);
    for (int k = 0; k < 60; ++k)
    {
        plate.run(1, StepSettings());
        EXPECT_NEAR(mechanicalEnergy(plate.m_body) / start, 1, 2e-3) << "step " << k;
    }
}

// The plate turns along arcs, which are no strain. The energy never grows, with vibrations of 1 cm/s everywhere.
TEST(ElasticitySpin, FastSpinGainsNoEnergy)
{
    Plate plate(6, {.01, .01, .01});
    const double kineticAtStart = kineticEnergy(plate.m_body.m_state);
    plate.run(2, StepSettings());
    const double after = mechanicalEnergy(plate.m_body);
    EXPECT_NEAR(after / kineticAtStart, 1, 0.005);
    for (int k = 0; k < 300; ++k)
    {
        plate.run(1, StepSettings());
        ASSERT_LE(mechanicalEnergy(plate.m_body), after) << "step " << k;
        ASSERT_LE(kineticEnergy(plate.m_body.m_state), kineticAtStart) << "step " << k;
    }
    EXPECT_GT(mechanicalEnergy(plate.m_body), 0.95 * kineticAtStart);  // nor is it damped
}

}  // namespace
}  // namespace bullet_fem
