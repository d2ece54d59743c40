// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/fem/body/actuators.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/hollow_meshes.h"

namespace bullet_fem
{
namespace
{

const double kInner = 0.06, kOuter = 0.1;  // [m]

TetMesh ball(int cells = 6, int layers = 2)
{
    return hollowSphere(kInner, kOuter, cells, layers);
}

Chamber cavityOf(const TetMesh& mesh)
{
    Chamber chamber;
    chamber.m_triangles = findCavities(mesh).at(0);
    return chamber;
}

Body hollowBall(double young = 1e6, double poisson = 0.3, int cells = 6, double step = 1.0 / 60, int layers = 4)
{
    const TetMesh mesh = ball(cells, layers);
    Body body = makeBody(mesh, elasticMaterial(young, poisson), {}, step);
    body.m_actuators.m_chambers.push_back(cavityOf(mesh));
    return body;
}

// Moves the nodes at random by up to `size` [m].
void shake(std::vector<Vec3>& x, double size, unsigned seed = 5)
{
    RandomVectors random(seed);
    for (Vec3& xi : x) xi += size * random.next();
}

// Impulses of a step from rest: for short steps h times the nodal forces.
std::vector<Vec3> impulsesOf(Body& body, double step)
{
    StepSettings settings;
    settings.m_step = step;
    settings.m_tolerance = 1e-12;
    solveFreeMotion(body, settings);
    std::vector<Vec3> impulses = velocity(body);
    for (std::size_t i = 0; i < impulses.size(); ++i) impulses[i] *= body.m_state.m_mass[i];
    return impulses;
}

// --- Cavities ---

TEST(Cavities, AreFoundAndTurnedToTheirGas)
{
    const TetMesh mesh = ball();
    const Chamber chamber = cavityOf(mesh);
    EXPECT_EQ(findCavities(mesh).size(), 1u);
    EXPECT_EQ(2 * chamber.m_triangles.size(), mesh.surface().size());
    double solid = 0;  // the outer polyhedron is similar to the inner one
    for (int e = 0; e < mesh.tetCount(); ++e) solid += mesh.tetVolume(e);
    const double ratio = std::pow(kOuter / kInner, 3);
    EXPECT_NEAR(chamber.volume(mesh.restPositions()), solid / (ratio - 1), 1e-12 * solid);
    chamber.validate(mesh);
    chamber.validateVolume(mesh.restPositions());
}

TEST(Cavities, AreAsManyAsThereAre)
{
    EXPECT_TRUE(findCavities(makeBox({1, 1, 1}, {3, 3, 3})).empty());
    const auto inTwo = [](const Vec3& X) { return std::fabs(X.x - 1.5) < 0.5 || std::fabs(X.x - 3.5) < 0.5; };
    const TetMesh mesh = withHoles(makeBox({5, 3, 3}, {5, 3, 3}), [&](const Vec3& X)
                                   { return inTwo(X) && std::fabs(X.y - 1.5) < 0.5 && std::fabs(X.z - 1.5) < 0.5; });
    const auto cavities = findCavities(mesh);
    ASSERT_EQ(cavities.size(), 2u);
    for (const auto& triangles : cavities)
    {
        Chamber chamber;
        chamber.m_triangles = triangles;
        EXPECT_NEAR(chamber.volume(mesh.restPositions()), 1, 1e-12);
    }
    // A hole through the whole body is no cavity.
    EXPECT_TRUE(findCavities(withHoles(makeBox({3, 3, 3}, {3, 3, 3}), [](const Vec3& X)
                                       { return std::fabs(X.y - 1.5) < 0.5 && std::fabs(X.z - 1.5) < 0.5; }))
                    .empty());
}

// --- Forces ---

TEST(ChamberForces, ArePressureTimesTheSlopeOfTheVolume)
{
    Body body = hollowBall(1e-3);
    shake(body.m_state.m_x, 0.004);
    Chamber& chamber = body.m_actuators.m_chambers[0];
    chamber.m_pressure = 2e4;
    const double h = 1e-6;
    const std::vector<Vec3> impulses = impulsesOf(body, h);
    double largest = 0, off = 0;
    for (std::size_t i = 0; i < impulses.size(); ++i)
        for (int c = 0; c < 3; ++c)
        {
            std::vector<Vec3> x = body.m_state.m_x;
            const double way = 1e-5;
            x[i][c] += way;
            const double above = chamber.volume(x);
            x[i][c] -= 2 * way;
            const double slope = (above - chamber.volume(x)) / (2 * way);
            largest = std::max(largest, std::fabs(chamber.m_pressure * slope));
            off = std::max(off, std::fabs(impulses[i][c] / h - chamber.m_pressure * slope));
        }
    EXPECT_LE(off, 1e-6 * largest);
}

TEST(ChamberForces, HaveNoSumAndNoTorque)
{
    for (const bool isSealed : {false, true})
    {
        Body body = hollowBall(1e-3);
        shake(body.m_state.m_x, 0.004);
        for (Vec3& x : body.m_state.m_x) x += Vec3{1, 2, 3};
        Chamber& chamber = body.m_actuators.m_chambers[0];
        chamber.m_isSealed = isSealed;
        chamber.m_pressure = 2e4;
        chamber.m_gas = 3e5 * chamber.volume(body.m_state.m_x);
        const std::vector<Vec3> impulses = impulsesOf(body, 1.0 / 60);
        Vec3 sum, torque;
        double size = 0;
        for (std::size_t i = 0; i < impulses.size(); ++i)
        {
            sum += impulses[i];
            torque += cross(body.m_state.m_x[i], impulses[i]);
            size += norm(impulses[i]);
        }
        EXPECT_GT(size, 0.1);
        EXPECT_LE(norm(sum), 1e-8 * size);
        EXPECT_LE(norm(torque), 1e-8 * size * 4);
    }
}

// [Timoshenko & Goodier 1970, art. 142] u(r) = p a^3 / (E (b^3 - a^3)) ((1 - 2 nu) r + (1 + nu) b^3 / (2 r^2))
TEST(ChamberForces, InflateABallAsLameSays)
{
    const double young = 1e6, poisson = 0.3, p = 2e3;
    Body body = hollowBall(young, poisson, 10, 0.2, 8);
    body.m_actuators.m_chambers[0].m_pressure = p;
    EXPECT_LE(relax(body, 1e-9), 1e-9);
    const double a3 = std::pow(kInner, 3), b3 = std::pow(kOuter, 3);
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    for (const double r : {kInner, kOuter})
    {
        double sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < X.size(); ++i)
        {
            if (std::fabs(norm(X[i]) - r) > 1e-9) continue;
            sum += dot(body.m_state.m_x[i] - X[i], X[i]) / r;
            ++count;
        }
        const double lame = p * a3 / (young * (b3 - a3)) * ((1 - 2 * poisson) * r + (1 + poisson) * b3 / (2 * r * r));
        EXPECT_NEAR(sum / count, lame, 0.025 * lame) << "at r = " << r;
    }
}

// --- A sealed gas ---

// The equilibrium has V = V0 + compliance p and (p + p0) V = gas; the compliance comes from a small prescribed
// pressure.
TEST(SealedGas, KeepsItsAmountInEquilibrium)
{
    Body body = hollowBall(2e6, 0.3, 6, 0.2);
    Chamber& chamber = body.m_actuators.m_chambers[0];
    const double V0 = chamber.volume(body.m_state.m_x);
    chamber.m_pressure = 1e4;
    EXPECT_LE(relax(body, 1e-9), 1e-9);
    const double compliance = (chamber.volume(body.m_state.m_x) - V0) / chamber.m_pressure;
    chamber.m_isSealed = true;
    chamber.m_gas = 1.05 * kStandardAtmosphere * V0;
    EXPECT_LE(relax(body, 1e-9), 1e-9);
    const double b = V0 + compliance * -kStandardAtmosphere;  // V^2 - b V - compliance gas = 0
    const double expected = 0.5 * (b + std::sqrt(b * b + 4 * compliance * chamber.m_gas));
    const double V = chamber.volume(body.m_state.m_x);
    EXPECT_GT(expected, 1.002 * V0);
    EXPECT_NEAR(V - V0, expected - V0, 0.02 * (expected - V0));
    EXPECT_NEAR((chamber.pressureAt(V) + kStandardAtmosphere) * V, chamber.m_gas, 1e-12 * chamber.m_gas);
}

// A gas a thousand times stiffer than the stability limit of an explicit step of 1/60 s.
TEST(SealedGas, IsStableAtAnyStiffness)
{
    for (const double damping : {1.0, 0.0})
        for (const double pressure : {1e5, 1e7})
        {
            Body body = hollowBall(2e7, 0.3, 4);
            Chamber& chamber = body.m_actuators.m_chambers[0];
            chamber.m_isSealed = true;
            chamber.m_outsidePressure = pressure;
            const double V0 = chamber.volume(body.m_state.m_x);
            chamber.m_gas = pressure * V0;
            for (std::size_t i = 0; i < body.m_state.m_v.size(); ++i)
                body.m_state.m_v[i] = -1 / kOuter * body.m_state.m_x[i];
            StepSettings settings;
            settings.m_numericalDamping = damping;
            const double before = mechanicalEnergy(body);
            double largest = 0;
            int iterations = 0;
            body.m_loads.m_priorVelocity.assign(body.m_state.m_v.size(), Vec3());  // the velocity acts as an impulse
            for (int k = 0; k < 240; ++k)
            {
                iterations = std::max(iterations, step(body, settings).m_iterations);
                body.m_loads.m_priorVelocity.clear();
                largest = std::max(largest, mechanicalEnergy(body));
            }
            EXPECT_LE(largest, 1.05 * before) << damping << " at " << pressure;
            EXPECT_LE(mechanicalEnergy(body), 0.01 * before) << damping << " at " << pressure;
            EXPECT_NEAR(chamber.volume(body.m_state.m_x), V0, 1e-3 * V0);
            EXPECT_LE(iterations, 12) << damping << " at " << pressure;
        }
}

// Velocities of a rigid rotation do not change the volume.
TEST(SealedGas, LetsASpinningBallSpin)
{
    Body body = hollowBall(1e5, 0.3, 4);
    Chamber& chamber = body.m_actuators.m_chambers[0];
    chamber.m_isSealed = true;
    chamber.m_outsidePressure = 5e7;
    chamber.m_gas = chamber.m_outsidePressure * chamber.volume(body.m_state.m_x);
    for (std::size_t i = 0; i < body.m_state.m_v.size(); ++i)
        body.m_state.m_v[i] = cross(Vec3{0, 0, 4}, body.m_state.m_x[i]);
    StepSettings settings;
    settings.m_numericalDamping = 0;
    const double before = mechanicalEnergy(body), V0 = chamber.volume(body.m_state.m_x);
    double largest = 0;
    for (int k = 0; k < 120; ++k)
    {
        step(body, settings);
        largest = std::max(largest, std::fabs(chamber.volume(body.m_state.m_x) - V0) / V0);
    }
    EXPECT_LE(largest, 2e-3);
    EXPECT_NEAR(mechanicalEnergy(body), before, 0.01 * before);
}

// Crushed by hand until its walls have crossed: the pressure stays finite and restores the shape.
TEST(SealedGas, ComesBackFromInsideOut)
{
    Body body = hollowBall(1e5, 0.3, 4);
    Chamber& chamber = body.m_actuators.m_chambers[0];
    const double V0 = chamber.volume(body.m_state.m_x);
    chamber.m_isSealed = true;
    chamber.m_gas = kStandardAtmosphere * V0;
    for (Vec3& x : body.m_state.m_x) x.z *= -0.01;
    EXPECT_LT(chamber.volume(body.m_state.m_x), 0);
    EXPECT_EQ(chamber.pressureAt(-1), 1e8 - kStandardAtmosphere);
    for (int k = 0; k < 300; ++k)
    {
        step(body, StepSettings());
        ASSERT_TRUE(canFinishStep(body));
    }
    EXPECT_NEAR(chamber.volume(body.m_state.m_x), V0, 0.2 * V0);
}

TEST(SealedGas, EmptyChamberIsAVacuum)
{
    const Body body = hollowBall();
    Chamber chamber = body.m_actuators.m_chambers[0];
    chamber.m_isSealed = true;
    for (const double volume : {1.0, 0.0, -1.0}) EXPECT_EQ(chamber.pressureAt(volume), -kStandardAtmosphere);
}

// --- Errors ---

TEST(ChamberErrors, NameValueRangeAndRemedy)
{
    const TetMesh mesh = ball(2, 1);
    const Chamber good = cavityOf(mesh);
    const auto expect = [&](const Chamber& chamber, const std::string& part)
    {
        expectRejected(
            [&]
            {
                chamber.validate(mesh);
                chamber.validateVolume(mesh.restPositions());
            },
            {part.c_str()});
    };
    good.validate(mesh);
    Chamber c = good;
    c.m_gas = 1e12;
    c.m_pressure = c.m_outsidePressure = 1e8;
    c.validate(mesh);
    c.m_outsidePressure = 1.01e8;
    expect(c, "outside pressure is 101000000");
    c = good;
    c.m_triangles.pop_back();
    expect(c, "is not closed: the edge from node");
    c = good;
    std::swap(c.m_triangles[3][0], c.m_triangles[3][1]);
    expect(c, "run the same way along the edge");
    c = good;
    for (Triangle& t : c.m_triangles) std::swap(t[0], t[1]);
    expect(c, "m3, not in (0, inf); list the nodes of every triangle in the opposite order");
    c = good;
    c.m_triangles[0][0] = mesh.nodeCount();
    expect(c, "is not in [0, " + std::to_string(mesh.nodeCount()) + ")");
    c.m_triangles[0][0] = -1;
    expect(c, "node -1 of the chamber");
    c.m_triangles.clear();
    expect(c, "has 0 triangles");
    c = good;
    for (const double pressure : {std::nan(""), 1.1e8, -1.1e5, HUGE_VAL})
    {
        c.m_pressure = pressure;
        expect(c, "the chamber's pressure is");
    }
    c = good;
    for (const double gas : {std::nan(""), -1e-9, 1.01e12})
    {
        c.m_gas = gas;
        expect(c, "the chamber's gas is");
    }
    c = good;
    c.m_outsidePressure = -1;
    expect(c, "outside pressure is -1, not in [0, 100000000] Pa");
}

TEST(ChamberErrors, RejectSurfacesOnDifferentComponents)
{
    const TetMesh one = makeBox({1, 1, 1}, {1, 1, 1});
    std::vector<Vec3> X = one.restPositions();
    std::vector<Tet> tets = one.tets();
    for (const Vec3& x : one.restPositions()) X.push_back(x + Vec3{2, 0, 0});
    for (const Tet& t : one.tets()) tets.push_back({t[0] + 8, t[1] + 8, t[2] + 8, t[3] + 8});
    const TetMesh two(X, tets);
    Chamber both;
    both.m_triangles = two.surface();
    expectRejected([&] { both.validate(two); }, {"in different components of the body"});
}

}  // namespace
}  // namespace bullet_fem
