// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Yielding materials against formulas of bars and material points (docs/materials.md, Plasticity).
#include <gtest/gtest.h>

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

constexpr double kElastic = 1e6, kYield = 1e3, kHardening = 0.25 * kElastic;  // [Pa]: yields at a strain of 1e-3

Material yielding(double hardening = 0, double nu = 0.3)
{
    Material material = elasticMaterial(kElastic, nu);
    material.m_yieldStress = kYield;
    material.m_hardeningModulus = hardening;
    return material;
}

TetMesh barOfSix()
{
    return makeBox({1, 0.25, 0.25}, {4, 1, 1}, {}, CellSplit::kuhnSix);
}

// A free bar in tension at its ends: the stress is uniform.
class PulledBar
{
public:
    explicit PulledBar(const Material& material) : m_body(makeBody(barOfSix(), material, {}, 0.05))
    {
        const TetMesh& mesh = m_body.m_model->mesh();
        m_left = faceAreas(mesh, [](const Vec3& X) { return X.x < 1e-9; });
        m_right = faceAreas(mesh, [](const Vec3& X) { return X.x > 1 - 1e-9; });
    }

    // Relaxes to equilibrium under a nominal axial stress [Pa], and returns the axial strain. A step from zero velocity
    // removes most of the remaining vibration, and H / (E + H) of the plastic flow.
    double pull(double stress)
    {
        StepSettings settings;
        settings.m_step = m_body.m_model->factorInput().m_step;
        settings.m_tolerance = 1e-8;
        double moved = 1;
        for (int k = 0; k < 400 && moved > 1e-9; ++k)
        {
            const std::vector<Vec3> before = m_body.m_state.m_x;
            const Vec3 axis = weightedMean(m_right, before) - weightedMean(m_left, before);
            for (std::size_t i = 0; i < m_left.size(); ++i)
                m_body.m_loads.m_force[i] = stress * (m_right[i] - m_left[i]) / norm(axis) * axis;
            std::fill(m_body.m_state.m_v.begin(), m_body.m_state.m_v.end(), Vec3());
            bullet_fem::step(m_body, settings);
            moved = largestDistance(before, m_body.m_state.m_x);
        }
        EXPECT_LE(moved, 1e-9);
        return strain(0);
    }

    double strain(int axis) const
    {
        const TetMesh& mesh = m_body.m_model->mesh();
        const Vec3 far[] = {{1, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}};
        const auto& x = m_body.m_state.m_x;
        return norm(x[nodeAt(mesh, far[axis])] - x[nodeAt(mesh, {0, 0, 0})]) / far[axis][axis] - 1;
    }

    double plasticStrain() const { return m_body.m_state.m_equivalentPlasticStrain[7]; }

    Body m_body;

private:
    std::vector<double> m_left, m_right;
};

TEST(Plasticity, ABarYieldsAtTheYieldStress)
{
    for (const double nu : {0.3, 0.45})
        for (const double sign : {1.0, -1.0})
        {
            PulledBar bar(yielding(kHardening, nu));
            EXPECT_NEAR(bar.pull(0.995 * sign * kYield), 0.995 * sign * kYield / kElastic, 1e-6);
            EXPECT_EQ(bar.plasticStrain(), 0);
            bar.pull(1.005 * sign * kYield);
            EXPECT_GT(bar.plasticStrain(), 1e-6);
        }
}

// The bilinear law: strain = sigma / E + (sigma - sigma_y) / H, unloading along E, and reloading to yield at the former
// maximum.
TEST(Plasticity, ABarHardensUnloadsAndStaysLonger)
{
    for (const double nu : {0.3, 0.45})
    {
        PulledBar bar(yielding(kHardening, nu));
        const double unit = kYield / kElastic, plastic = kYield / kHardening, close = 0.01 * unit;
        for (const double load : {1.25, 1.5, 1.75, 2.0})
            EXPECT_NEAR(bar.pull(load * kYield), load * unit + (load - 1) * plastic, close);
        EXPECT_NEAR(bar.plasticStrain(), plastic, 0.01 * plastic);
        for (const double load : {1.5, 1.0, 0.0})
        {
            const double along = bar.pull(load * kYield);
            EXPECT_NEAR(along, plastic + load * unit, close);
            // Plastic strain preserves volume: half of it transversely, and Poisson's ratio of the elastic part.
            EXPECT_NEAR(bar.strain(1), -0.5 * plastic - nu * load * unit, close);
            EXPECT_NEAR(bar.strain(2), -0.5 * plastic - nu * load * unit, close);
        }
        const double flown = bar.plasticStrain();
        EXPECT_NEAR(bar.pull(1.98 * kYield), plastic + 1.98 * unit, close);
        EXPECT_NEAR(bar.pull(-1.98 * kYield), plastic - 1.98 * unit, close);  // isotropic: equal in compression
        EXPECT_NEAR(bar.plasticStrain(), flown, 0.001 * plastic);
        EXPECT_NEAR(bar.pull(-2.5 * kYield), 0.5 * plastic - 2.5 * unit, close);
        EXPECT_NEAR(bar.plasticStrain(), 1.5 * plastic, 0.01 * plastic);
    }
}

// A single element with all nodes prescribed by F: a material point.
class Point
{
public:
    Point(const Material& material, const Mat3& F)
        : m_body(makeBody(TetMesh({{0.1, 0.2, 0.3}, {1.2, 0.1, 0.2}, {0.3, 1.1, 0.4}, {0.2, 0.4, 0.9}}, {{0, 1, 2, 3}}),
                          material, [](const Vec3&) { return true; }))
    {
        deform(F);
    }

    void deform(const Mat3& F)
    {
        const std::vector<Vec3>& X = m_body.m_model->mesh().restPositions();
        for (std::size_t i = 0; i < X.size(); ++i) m_body.m_state.m_x[i] = F * X[i];
    }

    void step(int count = 1)
    {
        for (int k = 0; k < count; ++k) bullet_fem::step(m_body, StepSettings());
    }

    Stress stress() const { return elementStress(m_body, 0); }
    double vonMises() const { return bullet_fem::vonMises(stress()); }

    Body m_body;
};

const Mat3 kStretch = {{{1.01, 0.004, 0}, {0.004, 0.998, -0.003}, {0, -0.003, 1.002}}};

// Radial return: pressure and the deviator's direction are kept, and its size becomes sigma_y.
TEST(Plasticity, StressReturnsRadially)
{
    Point elastic(elasticMaterial(kElastic, 0.3), kStretch), plastic(yielding(), kStretch);
    const double beyond = elastic.vonMises();
    ASSERT_GT(beyond, 2 * kYield);
    plastic.step();
    EXPECT_NEAR(plastic.vonMises(), kYield, 1e-6 * kYield);
    EXPECT_NEAR(trace(plastic.stress()), trace(elastic.stress()), 1e-6 * kYield);
    const SymmetricTensor expected = kYield / beyond * deviator(elastic.stress());
    const SymmetricTensor difference = deviator(plastic.stress()) + -1.0 * expected;
    EXPECT_LT(std::sqrt(contraction(difference, difference)), 1e-6 * kYield);
    const double mu = elasticMaterial(kElastic, 0.3).lameMu();
    EXPECT_NEAR(plastic.m_body.m_state.m_equivalentPlasticStrain[0], (beyond - kYield) / (3 * mu), 1e-9);
    EXPECT_NEAR(trace(plastic.m_body.m_state.m_plasticStrain[0]), 0, 1e-12);
    plastic.step(10);
    EXPECT_NEAR(plastic.m_body.m_state.m_equivalentPlasticStrain[0], (beyond - kYield) / (3 * mu), 1e-9);
}

// The overstress falls by 3 mu gamma, and the yield stress grows by H gamma.
TEST(Plasticity, HardeningMeetsTheReturningStress)
{
    Point elastic(elasticMaterial(kElastic, 0.3), kStretch), plastic(yielding(kHardening), kStretch);
    plastic.step();
    const double mu = elasticMaterial(kElastic, 0.3).lameMu();
    const double flown = (elastic.vonMises() - kYield) / (3 * mu + kHardening);
    EXPECT_NEAR(plastic.m_body.m_state.m_equivalentPlasticStrain[0], flown, 1e-9);
    EXPECT_NEAR(plastic.vonMises(), kYield + kHardening * flown, 1e-6 * kYield);
}

TEST(Plasticity, PressureFromAllSidesNeverYields)
{
    Point point(yielding(), Mat3::diagonal(0.7));
    point.step(3);
    EXPECT_EQ(point.m_body.m_state.m_equivalentPlasticStrain[0], 0);
}

// The overstress decays as exp(-creep t), for any step.
TEST(Plasticity, CreepHasItsRate)
{
    for (const double creep : {0.5, 5.0, 50.0})
        for (const double h : {1.0 / 60, 1.0 / 240})
        {
            Material material = yielding();
            material.m_plasticCreep = creep;
            Point point(material, kStretch);
            const double before = point.vonMises() - kYield;
            StepSettings settings;
            settings.m_step = h;
            for (int k = 1; k <= 30; ++k)
            {
                step(point.m_body, settings);
                EXPECT_NEAR(point.vonMises() - kYield, before * std::exp(-creep * k * h), 1e-6 * before);
            }
        }
}

// Beyond the maximum plastic strain the response is elastic, with the shear modulus.
TEST(Plasticity, StrainBeyondTheLargestPlasticOneIsElastic)
{
    Material material = yielding();
    material.m_mostPlasticStrain = 0.1;
    Point elastic(elasticMaterial(kElastic, 0.3), Mat3{{{1.3, 0, 0}, {0, 0.9, 0}, {0, 0, 0.9}}});
    Point plastic(material, Mat3{{{1.3, 0, 0}, {0, 0.9, 0}, {0, 0, 0.9}}});
    plastic.step(3);
    const SymmetricTensor& strain = plastic.m_body.m_state.m_plasticStrain[0];
    EXPECT_NEAR(std::sqrt(2.0 / 3 * contraction(strain, strain)), 0.1, 1e-12);
    EXPECT_NEAR(plastic.vonMises(), elastic.vonMises() - 3 * material.lameMu() * 0.1, 1e-6 * kElastic);
}

// A rotation is no strain, and the plastic strain rotates with the body.
TEST(Plasticity, TurnsWithTheBody)
{
    const Mat3 Q = rotationAbout({1, -2, 3}, 2.4);
    Point still(yielding(), kStretch), turned(yielding(), Q * kStretch);
    still.step(), turned.step();
    const SymmetricTensor& a = still.m_body.m_state.m_plasticStrain[0];
    SymmetricTensor difference = turned.m_body.m_state.m_plasticStrain[0] + -1.0 * a;
    EXPECT_LT(std::sqrt(contraction(difference, difference)), 1e-7);  // single precision of strains of 0.01
    still.deform(Q);
    still.step();
    turned.deform(Mat3::identity());
    turned.step();
    const Stress expected = symmetricPart(Q * timesTranspose(toMatrix(turned.stress()), Q));
    difference = still.stress() + -1.0 * expected;
    EXPECT_LT(std::sqrt(contraction(difference, difference)), 1e-6 * kYield);
    EXPECT_GT(turned.vonMises(), 0.5 * kYield);
}

// The deviator of the initial stress counts for yielding.
TEST(Plasticity, InitialStressCounts)
{
    Point point(yielding(), Mat3::identity());
    point.m_body.m_state.m_initialStress = {{2 * kYield, 0, 0, 0, 0, 0}};
    point.step();
    EXPECT_NEAR(point.vonMises(), kYield, 1e-6 * kYield);
}

Body thrown(double creep, double nu, const NodePredicate& fixed = {})
{
    Material material = yielding(0, nu);
    material.m_plasticCreep = creep;
    Body body = makeBody(makeBox({1, 0.3, 0.3}, {6, 2, 2}, {}, CellSplit::kuhnSix), material, fixed);
    RandomVectors random(3);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
    {
        body.m_state.m_x[i] += 0.02 * random.next();
        body.m_state.m_v[i] = 0.5 * random.next() + cross({0, 0, 2}, body.m_state.m_x[i]);
    }
    return body;
}

TEST(Plasticity, EnergyOnlyFalls)
{
    for (const double creep : {Material::kInfinite, 10.0})
        for (const double nu : {0.3, 0.45})
        {
            // Fixed at one end, because free spinning bodies gain energy in implicit Euler's step, plastic or not.
            Body body = thrown(creep, nu, [](const Vec3& X) { return X.x == 0; });
            double energy = mechanicalEnergy(body);
            for (int k = 0; k < 200; ++k)
            {
                step(body, StepSettings());
                const double now = mechanicalEnergy(body);
                EXPECT_LE(now, energy * (1 + 1e-6)) << k;
                energy = now;
            }
            const auto& flown = body.m_state.m_equivalentPlasticStrain;
            EXPECT_GT(*std::max_element(flown.begin(), flown.end()), 0.01);
        }
}

// Plastic flow at fixed positions never increases the energy, in elements of any shape.
TEST(Plasticity, FlowTakesEnergy)
{
    Material material = yielding();
    material.m_mostPlasticStrain = 0.2;
    RandomVectors random(11);
    for (int k = 0; k < 200; ++k)
    {
        Point point(material, Mat3::identity());
        for (int turn = 0; turn < 3; ++turn)
        {
            point.deform(Mat3::identity() + 0.3 * Mat3::fromColumns(random.next(), random.next(), random.next()));
            const double before = mechanicalEnergy(point.m_body);
            point.step();
            EXPECT_LE(mechanicalEnergy(point.m_body), before * (1 + 1e-9));
        }
    }
}

TEST(Plasticity, MomentumIsExact)
{
    Body body = thrown(Material::kInfinite, 0.3);
    const Vec3 p = linearMomentum(body.m_state), L = angularMomentum(body.m_state);
    for (int k = 0; k < 100; ++k) step(body, StepSettings());
    EXPECT_LE(norm(linearMomentum(body.m_state) - p), 1e-11 * norm(L));
    EXPECT_LE(norm(angularMomentum(body.m_state) - L), 1e-11 * norm(L));
}

void takeSteps(Body& body, int steps, const Threads* threads = nullptr, BatchMemory* memory = nullptr)
{
    StepSettings settings;
    settings.m_threads = threads;
    settings.m_batchMemory = memory;
    for (int k = 0; k < steps; ++k) step(body, settings);
}

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool sameState(const Body& a, const Body& b)
{
    const BodyState &s = a.m_state, &t = b.m_state;
    return sameBytes(s.m_x, t.m_x) && sameBytes(s.m_v, t.m_v) && sameBytes(s.m_plasticStrain, t.m_plasticStrain) &&
           sameBytes(s.m_equivalentPlasticStrain, t.m_equivalentPlasticStrain);
}

class PlasticityBits : public testing::TestWithParam<int>
{
};

TEST_P(PlasticityBits, AreTheSameForAllThreadCounts)
{
    const Body model = makeBody(makeBox({1, 0.5, 0.5}, {20, 8, 8}), yielding());
    Body one(model.m_model), many(model.m_model);
    for (Body* body : {&one, &many}) disturb(*body);
    takeSteps(one, 3);
    const Threads threads(GetParam());
    takeSteps(many, 3, &threads);
    EXPECT_TRUE(sameState(one, many));
    EXPECT_GT(one.m_state.m_equivalentPlasticStrain[5], 0);
}
INSTANTIATE_TEST_SUITE_P(Threads, PlasticityBits, testing::Values(1, 2, 3, 8));

TEST(Plasticity, IsRestored)
{
    Body body = thrown(10, 0.3), other(body.m_model);
    takeSteps(body, 20);
    const BodySnapshot snapshot = snapshotOf(body);
    check(snapshot, *other.m_model);
    restore(snapshot, other);
    takeSteps(body, 20), takeSteps(other, 20);
    EXPECT_TRUE(sameState(body, other));
}

TEST(Plasticity, DamagedSnapshotsAreRefused)
{
    Body body = thrown(10, 0.3);
    const BodySnapshot good = snapshotOf(body);
    BodySnapshot bad = good;
    bad.m_plasticStrain.clear();
    expectRejected([&] { check(bad, *body.m_model); }, {"0 plastic strains"});
    bad = good;
    bad.m_plasticStrain[2].xy = std::nan("");
    expectRejected([&] { check(bad, *body.m_model); }, {"plastic strain of element 2"});
    bad = good;
    bad.m_equivalentPlasticStrain[3] = -1;
    expectRejected([&] { check(bad, *body.m_model); }, {"equivalent plastic strain of element 3", "[0, inf)"});
}

TEST(Plasticity, BatchedStepsHaveTheSameBits)
{
    const Body model = makeBody(barOfSix(), yielding());
    std::vector<Body> together, alone;
    for (int k = 0; k < 8; ++k)
        for (std::vector<Body>* bodies : {&together, &alone})
        {
            bodies->emplace_back(model.m_model);
            disturb(bodies->back(), static_cast<unsigned>(k));
        }
    BatchMemory memory;
    for (int k = 0; k < 5; ++k)
    {
        std::vector<FreeMotion> motions;
        std::vector<StepEnd> ends;
        StepSettings settings;
        settings.m_batchMemory = &memory;
        for (Body& body : together) motions.push_back({&body, settings, {}}), ends.push_back({&body, settings, false});
        solveFreeMotions(motions.data(), static_cast<int>(motions.size()));
        finishSteps(ends.data(), static_cast<int>(ends.size()));
        for (Body& body : alone) step(body, StepSettings());
    }
    for (std::size_t k = 0; k < together.size(); ++k) EXPECT_TRUE(sameState(together[k], alone[k])) << k;
}

TEST(Plasticity, StepsDoNotAllocate)
{
    Body body = thrown(10, 0.3);
    takeSteps(body, 1);
    const AllocationCounter counter;
    takeSteps(body, 5);
    EXPECT_EQ(counter.count(), 0);
}

// With a new material that does not yield the plastic strain stays and does not grow.
TEST(Plasticity, DentsOutliveTheMaterial)
{
    Body body = thrown(Material::kInfinite, 0.3);
    takeSteps(body, 30);
    const std::vector<SymmetricTensor> dents = body.m_state.m_plasticStrain;
    const auto shape = std::make_shared<RestShape>(body.m_model->mesh(), elasticMaterial(kElastic, 0.3));
    body.setModel(BodyModel::create(shape, body.m_model->factorInput()));
    takeSteps(body, 30);
    EXPECT_TRUE(sameBytes(body.m_state.m_plasticStrain, dents));
    check(snapshotOf(body), *body.m_model);
}

// A yield stress far above the stress: the only difference is rounding, from rotations computed twice a step.
TEST(Plasticity, BehavesElasticallyBelowTheYieldStress)
{
    Material strong = elasticMaterial(kElastic, 0.3);
    strong.m_yieldStress = 1e12;
    Body elastic = makeBody(barOfSix(), elasticMaterial(kElastic, 0.3)), plastic = makeBody(barOfSix(), strong);
    for (Body* body : {&elastic, &plastic}) disturb(*body), takeSteps(*body, 10);
    EXPECT_LE(largestDistance(elastic.m_state.m_x, plastic.m_state.m_x), 1e-8);
}

}  // namespace
}  // namespace bullet_fem
