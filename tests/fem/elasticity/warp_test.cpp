// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rigid motions: elastic forces are invariant, and the warped preconditioner rotates with them.
#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/reference/warped_elements.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

struct Turn
{
    const char* m_name;
    Vec3 m_axis;
    double m_degrees;
};

void PrintTo(const Turn& turn, std::ostream* out)
{
    *out << turn.m_name;
}

class ElasticityWarp : public testing::TestWithParam<Turn>
{
protected:
    Mat3 Q() const { return rotationAbout(GetParam().m_axis, GetParam().m_degrees * kPi / 180); }
};

void turn(const Mat3& Q, const Vec3& shift, std::vector<Vec3>& u)
{
    for (Vec3& ui : u) ui = Q * ui + shift;
}

Body clampedBeam()
{
    Material material = elasticMaterial(1e6, 0.3);
    material.m_stiffnessDamping = 0.01;
    return makeBody(makeBox({4, 1, 1}, {8, 2, 2}, {}, CellSplit::kuhnSix), material,
                    [](const Vec3& X) { return X.x == 0; });
}

// Random velocities of the free nodes [m/s] and loads [N].
void disturb(Body& body, double velocity, double force)
{
    RandomVectors random(7);
    for (std::size_t i = 0; i < body.m_state.m_v.size(); ++i)
    {
        const Vec3 v = velocity * random.next();
        body.m_state.m_v[i] = body.m_state.m_fixed[i] ? Vec3() : v;
        body.m_loads.m_force[i] = force * random.next();
    }
}

// A = Q A0 Q^T exactly, so that the rotated factor is the inverse up to its single precision (1e-7), far below 1e-3.
// Rotations start from the identity here and must be found by the polar decomposition, at 180 degrees, too.
TEST_P(ElasticityWarp, RigidlyRotatedBodyTakesOneIteration)
{
    Body body = clampedBeam();
    turn(Q(), {3, -2, 5}, body.m_state.m_x);
    disturb(body, 1e-3, 1);
    StepSettings settings;
    settings.m_warp = Warp::global;
    const SolveReport report = solveFreeMotion(body, settings);
    EXPECT_EQ(report.m_iterations, 1);
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_LE(report.m_residual, 1e-3);
    EXPECT_GT(largestDistance(velocity(body), body.m_state.m_v), 1e-4);  // the right-hand side was not zero
}

// f(Qx) = Q f(x) for a state of 20 % random strain; the sums of forces and of torques vanish.
TEST_P(ElasticityWarp, ForcesTurnWithTheState)
{
    const Body body = clampedBeam();
    const RestShape& shape = body.m_model->shape();
    std::vector<Vec3> x = shape.m_mesh.restPositions(), v(x.size()), f(x.size()), turned(x.size());
    RandomVectors random(3);
    for (Vec3& xi : x) xi += 0.1 * random.next();
    std::vector<Mat3> R(shape.m_elements.size(), Mat3::identity());
    updateElementRotations(shape, x, R);
    addElasticForces(shape, x, v, 0, R, f, nullptr);
    double scale = 0;
    Vec3 force, torque;
    for (std::size_t i = 0; i < f.size(); ++i)
    {
        scale += norm(f[i]);
        force += f[i];
        torque += cross(x[i], f[i]);
    }
    EXPECT_LE(norm(force), 1e-12 * scale);
    EXPECT_LE(norm(torque), 1e-12 * scale * 4);  // arms of up to 4 m

    turn(Q(), {}, x);
    R.assign(R.size(), Mat3::identity());
    updateElementRotations(shape, x, R);
    addElasticForces(shape, x, v, 0, R, turned, nullptr);
    turn(Q(), {}, f);
    EXPECT_LE(largestDistance(turned, f), 1e-12 * scale);
}

// Ten steps of the free body from a rotated state equal the rotated ten steps of the original; to the solver's
// tolerance.
TEST_P(ElasticityWarp, MotionTurnsWithTheState)
{
    Body body = makeBody(makeBox({1, .5, .5}, {4, 2, 2}), elasticMaterial(1e5, 0.3));
    disturb(body, 0.5, 20);
    Body turned(body.m_model);
    turned.m_state = body.m_state;
    turned.m_loads = body.m_loads;
    turn(Q(), {}, turned.m_state.m_x);
    turn(Q(), {}, turned.m_state.m_v);
    turn(Q(), {}, turned.m_loads.m_force);
    StepSettings settings;
    settings.m_tolerance = 1e-10;
    for (int k = 0; k < 10; ++k)
    {
        step(body, settings);
        step(turned, settings);
    }
    const double moved = largestDistance(body.m_state.m_x, body.m_model->mesh().restPositions());
    EXPECT_GT(moved, 0.01);
    turn(Q(), {}, body.m_state.m_x);
    EXPECT_LE(largestDistance(body.m_state.m_x, turned.m_state.m_x), 1e-8 * moved);
}

std::string turnName(const testing::TestParamInfo<Turn>& info)
{
    return info.param.m_name;
}
INSTANTIATE_TEST_SUITE_P(Turns, ElasticityWarp,
                         testing::Values(Turn{"None", {0, 0, 1}, 0}, Turn{"X30", {1, 0, 0}, 30},
                                         Turn{"Y90", {0, 1, 0}, 90}, Turn{"Z180", {0, 0, 1}, 180},
                                         Turn{"X180", {1, 0, 0}, 180}, Turn{"Oblique90", {1, 1, 1}, 90},
                                         Turn{"Oblique180", {1, -2, .5}, 180}, Turn{"Oblique137", {-3, 1, 2}, 137}),
                         turnName);

}  // namespace
}  // namespace bullet_fem
