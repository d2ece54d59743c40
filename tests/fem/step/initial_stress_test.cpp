// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies with an initial stress in their elements.
#include "bullet_fem/fem/body/initial_stress.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "bullet_fem/fem/batch/batch_memory.h"
#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/stress.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/stepping_scenes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

constexpr double kYoung = 1e5, kPoisson = 0.3;  // [Pa], [-]
constexpr double kBulk = kYoung / (3 * (1 - 2 * kPoisson));
constexpr double kThermal = 0.01;  // free thermal strain, alpha dT

// The initial stress that is relaxed by the free thermal strain: -3 K alpha dT I.
SymmetricTensor thermalStress()
{
    const double pressure = -3 * kBulk * kThermal;
    return {pressure, pressure, pressure, 0, 0, 0};
}

void fill(Body& body, const SymmetricTensor& stress)
{
    setInitialStress(body, std::vector<SymmetricTensor>(body.m_model->mesh().tetCount(), stress));
}

// A random stress for each element, a tenth of E.
std::vector<SymmetricTensor> randomStress(const Body& body)
{
    RandomVectors random(3);
    std::vector<SymmetricTensor> result;
    for (int e = 0; e < body.m_model->mesh().tetCount(); ++e)
    {
        const Vec3 a = 0.1 * kYoung * random.next(), b = 0.1 * kYoung * random.next();
        result.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
    }
    return result;
}

Material still(double nu = kPoisson)
{
    Material material = elasticMaterial(kYoung, nu);
    material.m_stiffnessDamping = 0.02;
    return material;
}

TetMesh bar()
{
    return makeBox({1, 0.2, 0.2}, {8, 2, 2}, {}, CellSplit::kuhnSix);
}

double distance(const Stress& a, const Stress& b)
{
    const Stress d = a + -1.0 * b;
    return std::sqrt(contraction(d, d));
}

// Free thermal expansion has no stress: each edge is longer by alpha dT.
TEST(InitialStress, AFreeBarExpandsByTheFormula)
{
    for (const double nu : {0.3, 0.45})  // without patches, and with them
    {
        Body body = makeBody(bar(), still(nu), {}, 1);
        const double bulk = kYoung / (3 * (1 - 2 * nu));
        fill(body, -3 * bulk * kThermal * SymmetricTensor{1, 1, 1, 0, 0, 0});
        EXPECT_LE(relax(body, 1e-9), 1e-9);
        const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
        for (std::size_t i = 1; i < X.size(); ++i)
        {
            const double rest = norm(X[i] - X[0]), now = norm(body.m_state.m_x[i] - body.m_state.m_x[0]);
            EXPECT_NEAR(now, (1 + kThermal) * rest, 1e-6 * rest) << i;
        }
        for (int e = 0; e < body.m_model->mesh().tetCount(); ++e)
            EXPECT_LE(distance(elementStress(body, e), {}), 1e-5 * kYoung * kThermal);
    }
}

// A prestressed bar between two walls: it stays at rest, and each section carries the stress. Released at one end, the
// bar is shorter by sigma / E, wider by Poisson's ratio times that, and free of stress.
TEST(InitialStress, AClampedBarCarriesItAndALooseOneGivesWay)
{
    const double pull = 0.01 * kYoung;
    Body clamped = makeBody(
        bar(), still(), [](const Vec3& X) { return X.x < 1e-9 || X.x > 1 - 1e-9; }, 1);
    Body loose = makeBody(bar(), still(), {}, 1);
    for (Body* body : {&clamped, &loose})
    {
        fill(*body, {pull, 0, 0, 0, 0, 0});
        EXPECT_LE(relax(*body, 1e-9), 1e-9);
    }
    const std::vector<Vec3>& X = clamped.m_model->mesh().restPositions();
    EXPECT_LE(largestDistance(clamped.m_state.m_x, X), 1e-6);
    for (int e = 0; e < clamped.m_model->mesh().tetCount(); ++e)
    {
        EXPECT_LE(distance(elementStress(clamped, e), {pull, 0, 0, 0, 0, 0}), 1e-4 * pull) << e;
        EXPECT_LE(distance(elementStress(loose, e), {}), 1e-4 * pull) << e;
    }
    const auto& x = loose.m_state.m_x;
    const int origin = nodeAt(loose.m_model->mesh(), {0, 0, 0}), along = nodeAt(loose.m_model->mesh(), {1, 0, 0}),
              across = nodeAt(loose.m_model->mesh(), {0, 0.2, 0});
    EXPECT_NEAR(norm(X[along] - X[origin]), 1, 1e-12);
    EXPECT_NEAR(norm(x[along] - x[origin]), 1 - 0.01, 1e-6);
    EXPECT_NEAR(norm(x[across] - x[origin]), 0.2 * (1 + 0.01 * kPoisson), 1e-6);
}

// All nodes are held: the stress equals the initial one, rotated with the body.
TEST(InitialStress, IsTheStressOfAnUnstrainedBody)
{
    Body body = makeBody(bar(), still(0.45));
    const SymmetricTensor s = {3e3, -1e3, 2e3, 500, -700, 900};
    fill(body, s);
    const Mat3 Q = rotationAbout({1, 2, -1}, 2.1);
    for (Vec3& x : body.m_state.m_x) x = Q * x;
    const Stress expected = symmetricPart(Q * timesTranspose(toMatrix(s), Q));
    for (int e = 0; e < body.m_model->mesh().tetCount(); ++e)
        EXPECT_LE(distance(elementStress(body, e), expected), 1e-9 * kYoung);
}

// In a patch only the mean pressure counts, because of mean dilatation.
TEST(InitialStress, PressureIsSharedInPatches)
{
    Body body = makeBody(bar(), still(0.45));
    setInitialStress(body, randomStress(body));
    const RestShape& shape = body.m_model->shape();
    ASSERT_FALSE(shape.m_patches.empty());
    std::vector<double> sum(shape.m_patches.count(), 0.0), expected = sum;
    for (int e = 0; e < body.m_model->mesh().tetCount(); ++e)
    {
        const Stress s = elementStress(body, e);
        const double first =
            trace(elementStress(body, shape.m_patches.m_element[shape.m_patches.m_start[shape.m_patches.m_patch[e]]]));
        EXPECT_NEAR(trace(s), first, 1e-9 * kYoung);
        sum[shape.m_patches.m_patch[e]] += shape.m_elements[e].m_volume * trace(s);
        expected[shape.m_patches.m_patch[e]] += shape.m_elements[e].m_volume * trace(body.m_state.m_initialStress[e]);
    }
    for (std::size_t p = 0; p < sum.size(); ++p) EXPECT_NEAR(sum[p], expected[p], 1e-9 * kYoung);
}

// A half-filled element has half the force: a half-filled body expands as a full one does.
TEST(InitialStress, ForcesCountTheFilledVolume)
{
    const TetMesh mesh = bar();
    const auto shape = std::make_shared<RestShape>(mesh, still(), std::vector<double>(mesh.tetCount(), 0.25));
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_fixed.assign(mesh.nodeCount(), 0);
    input.m_step = 1;
    Body body(BodyModel::create(shape, input));
    fill(body, thermalStress());
    EXPECT_LE(relax(body, 1e-9), 1e-9);
    const auto& x = body.m_state.m_x;
    EXPECT_NEAR(norm(x.back() - x.front()),
                (1 + kThermal) * norm(mesh.restPositions().back() - mesh.restPositions()[0]), 1e-6);
}

// The motion in a rotated frame is the rotated motion, to the solver's tolerance.
TEST(InitialStress, TurnsWithTheBody)
{
    const Mat3 Q = rotationAbout({1, -2, 3}, 2);
    Body body = makeBody(bar(), still()), turned = makeBody(bar(), still());
    for (Body* b : {&body, &turned}) setInitialStress(*b, randomStress(*b));
    for (Vec3& x : turned.m_state.m_x) x = Q * x;
    StepSettings settings;
    settings.m_tolerance = 1e-9;
    for (int k = 0; k < 60; ++k) step(body, settings), step(turned, settings);
    std::vector<Vec3> expected;
    for (const Vec3& x : body.m_state.m_x) expected.push_back(Q * x);
    EXPECT_GT(largestDistance(body.m_state.m_x, body.m_model->mesh().restPositions()), 0.005);
    EXPECT_LE(largestDistance(turned.m_state.m_x, expected), 1e-6);
}

// Also without the rigid correction: elements have no torque, apart from K' of the velocities.
TEST(InitialStress, MomentumIsExact)
{
    for (const double damping : {1.0, 0.0})
    {
        Body body = makeBody(bar(), still());
        setInitialStress(body, randomStress(body));
        for (Vec3& v : body.m_state.m_v) v = {0.1, 0, 0};
        StepSettings settings;
        settings.m_numericalDamping = damping;
        const Vec3 p = linearMomentum(body.m_state), L = angularMomentum(body.m_state);
        for (int k = 0; k < 100; ++k) step(body, settings);
        EXPECT_GT(kineticEnergy(body.m_state), 0.005 * 40);
        EXPECT_LE(norm(linearMomentum(body.m_state) - p), 1e-12 * norm(p));
        EXPECT_LE(norm(angularMomentum(body.m_state) - L), 1e-11 * norm(p));
    }
}

// The initial stress only shifts the equilibrium: with implicit Euler the energy falls to its minimum.
TEST(InitialStress, EnergyOnlyFalls)
{
    Body body = makeBody(bar(), still(0.45));
    setInitialStress(body, randomStress(body));
    double energy = mechanicalEnergy(body);
    for (int k = 0; k < 200; ++k)
    {
        step(body, StepSettings());
        const double now = mechanicalEnergy(body);
        EXPECT_LE(now, energy + 1e-12 * kYoung) << k;
        energy = now;
    }
    EXPECT_LT(energy, -1e-3);  // of 0.04 m3 times some (0.1 E)^2 / E
}

// With the second-order step a strip under strong initial tension comes to rest: A includes the tension of the initial
// stress.
TEST(InitialStress, APulledStripComesToRest)
{
    for (const double damping : {1.0, 0.0})
    {
        Material material = elasticMaterial(kYoung, kPoisson);
        Body body = makeBody(makeBox({1, 0.1, 0.1}, {12, 1, 1}), material,
                             [](const Vec3& X) { return X.x < 1e-9 || X.x > 1 - 1e-9; });
        fill(body, {0.5 * kYoung, 0, 0, 0, 0, 0});
        for (Vec3& v : body.m_state.m_v) v = {0, 0, 0.1};
        StepSettings settings;
        settings.m_numericalDamping = damping;
        for (int k = 0; k < 600; ++k) step(body, settings);
        EXPECT_LT(kineticEnergy(body.m_state), 0.3 * 0.5 * 10 * 0.01) << damping;
    }
}

class InitialStressBits : public testing::TestWithParam<int>
{
};

void run(Body& body, int steps, const Threads* threads = nullptr)
{
    StepSettings settings;
    settings.m_threads = threads;
    for (int k = 0; k < steps; ++k) step(body, settings);
}

bool sameBits(const Body& a, const Body& b)
{
    return std::memcmp(a.m_state.m_x.data(), b.m_state.m_x.data(), a.m_state.m_x.size() * sizeof(Vec3)) == 0 &&
           std::memcmp(a.m_state.m_v.data(), b.m_state.m_v.data(), a.m_state.m_v.size() * sizeof(Vec3)) == 0;
}

TEST_P(InitialStressBits, AreTheSameForAllThreadCounts)
{
    for (const double nu : {0.3, 0.45})
    {
        Body one = makeBody(makeBox({1, 0.5, 0.5}, {20, 8, 8}), still(nu)), many(one.m_model);
        for (Body* body : {&one, &many}) setInitialStress(*body, randomStress(*body));
        run(one, 3);
        const Threads threads(GetParam());
        run(many, 3, &threads);
        EXPECT_TRUE(sameBits(one, many));
    }
}
INSTANTIATE_TEST_SUITE_P(Threads, InitialStressBits, testing::Values(1, 2, 3, 8));

TEST(InitialStress, IsRestored)
{
    Body body = makeBody(bar(), still()), other(body.m_model);
    setInitialStress(body, randomStress(body));
    run(body, 5);
    const BodySnapshot snapshot = snapshotOf(body);
    check(snapshot, *other.m_model);
    restore(snapshot, other);
    EXPECT_EQ(other.m_state.m_initialStress, body.m_state.m_initialStress);
    run(body, 5), run(other, 5);
    EXPECT_TRUE(sameBits(body, other));
    BodySnapshot bad = snapshot;
    bad.m_initialStress.pop_back();
    expectRejected([&] { check(bad, *other.m_model); }, {"initial stress"});
}

// Zero initial stress is bitwise equal to none, alone and beside others.
TEST(InitialStress, ZeroIsNone)
{
    Body none = makeBody(bar(), still()), zero(none.m_model);
    fill(zero, {});
    for (Body* body : {&none, &zero}) disturb(*body);
    run(none, 10), run(zero, 10);
    EXPECT_LE(largestDistance(none.m_state.m_x, zero.m_state.m_x), 0);
}

// A body with an initial stress is solved alone, and the others in their batch.
TEST(InitialStress, BatchedStepsHaveTheSameBits)
{
    const Body first = makeBody(bar(), still());
    std::vector<Body> together, alone;
    for (int k = 0; k < 8; ++k)
        for (std::vector<Body>* bodies : {&together, &alone})
        {
            bodies->emplace_back(first.m_model);
            disturb(bodies->back(), static_cast<unsigned>(k));
            if (k % 2) setInitialStress(bodies->back(), randomStress(bodies->back()));
        }
    BatchMemory memory;
    for (int k = 0; k < 5; ++k)
    {
        std::vector<FreeMotion> motions;
        for (Body& body : together)
        {
            StepSettings settings;
            settings.m_batchMemory = &memory;
            motions.push_back({&body, settings, {}});
        }
        solveFreeMotions(motions.data(), static_cast<int>(motions.size()));
        for (Body& body : together) finishStep(body, StepSettings());
        for (Body& body : alone) step(body, StepSettings());
    }
    for (std::size_t k = 0; k < together.size(); ++k) EXPECT_TRUE(sameBits(together[k], alone[k])) << k;
}

// Neither does changing the stress in each step, as a muscle does.
TEST(InitialStress, StepsDoNotAllocate)
{
    Body body = makeBody(bar(), still());
    std::vector<SymmetricTensor> stress = randomStress(body);
    setInitialStress(body, stress);
    run(body, 1);
    const AllocationCounter counter;
    for (int k = 0; k < 5; ++k)
    {
        for (SymmetricTensor& s : stress) s *= 0.9;
        setInitialStress(body, stress);
        run(body, 1);
    }
    EXPECT_EQ(counter.count(), 0);
}

TEST(InitialStress, ChangesAreCounted)
{
    Body body = makeBody(bar(), still());
    EXPECT_EQ(body.m_state.m_initialStressChanges, 0u);
    setInitialStress(body, randomStress(body));
    setInitialStress(body, randomStress(body));
    EXPECT_EQ(body.m_state.m_initialStressChanges, 1u);
    setInitialStress(body, {});
    EXPECT_EQ(body.m_state.m_initialStressChanges, 2u);
}

TEST(InitialStress, BadValuesAreRefused)
{
    Body body = makeBody(bar(), still());
    const std::vector<SymmetricTensor> good = randomStress(body);
    setInitialStress(body, good);
    expectRejected([&] { setInitialStress(body, {SymmetricTensor()}); },
                   {"1 tensors given for", "give one each or none"});
    for (const double bad : {std::nan(""), 1.1e13, -HUGE_VAL})
        for (int k = 0; k < 6; ++k)
        {
            std::vector<SymmetricTensor> stress = good;
            SymmetricTensor& s = stress[7];
            *std::array<double*, 6>{&s.xx, &s.yy, &s.zz, &s.xy, &s.yz, &s.xz}[static_cast<std::size_t>(k)] = bad;
            expectRejected([&] { setInitialStress(body, stress); }, {"element 7", "[-1e13, 1e13]"});
        }
    EXPECT_EQ(body.m_state.m_initialStress, good);
}

}  // namespace
}  // namespace bullet_fem
