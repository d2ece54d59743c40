// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Relaxing materials against their Prony series and the standard solid (docs/materials.md, Relaxation).
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

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

constexpr double kFast = 1e5;  // instantaneous Young's modulus [Pa]

Material relaxing(const std::array<PronyTerm, 3>& terms, double nu = 0.3, double density = 1000)
{
    Material material = elasticMaterial(kFast, nu, density);
    material.m_relaxation = terms;
    return material;
}

constexpr std::array<PronyTerm, 3> kThreeTerms = {{{0.3, 0.1}, {0.2, 1}, {0.1, 7}}};

// A strain applied at once and held: the deviator follows the series, the pressure is constant.
TEST(Relaxation, HeldBodyFollowsThePronySeries)
{
    for (const double nu : {0.3, 0.45})
    {
        Body body = makeBody(makeBox({1, 0.5, 0.5}, {2, 1, 1}, {}, CellSplit::kuhnSix), relaxing(kThreeTerms, nu),
                             [](const Vec3&) { return true; });
        const Mat3 F = rotationAbout({1, 2, 3}, 1.7) * Mat3{{{1.05, 0.02, 0}, {0.02, 0.97, 0.01}, {0, 0.01, 1.01}}};
        for (Vec3& x : body.m_state.m_x) x = F * x;
        const Stress first = elementStress(body, 3);
        StepSettings settings;
        for (int k = 1; k <= 600; ++k)
        {
            step(body, settings);
            double left = 1;
            for (const PronyTerm& term : kThreeTerms)
                left -= term.m_share * -std::expm1(-k * settings.m_step / term.m_time);
            const Stress now = elementStress(body, 3);
            SymmetricTensor difference = deviator(now) + -left * deviator(first);
            EXPECT_LT(std::sqrt(contraction(difference, difference)), 1e-6 * vonMises(first)) << k;
            EXPECT_NEAR(trace(now), trace(first), 1e-6 * vonMises(first));
        }
    }
}

// Under a suddenly applied weight a bar creeps as the standard solid in shear, with elastic volume: strain = sigma / 9
// K + sigma J(t) / 3, J = (1 - g exp(-(1 - g) t / tau)) / ((1 - g) G). The relaxation lags by one step, h / tau = 1.7
// %, and the bar vibrates for a tenth of a second.
TEST(Relaxation, CreepOfAPulledBarIsThatOfTheStandardSolid)
{
    constexpr double kShare = 0.6, kTime = 1, kPull = 50;
    for (const double nu : {0.3, 0.45})
    {
        Body body =
            makeBody(makeBox({1, 0.25, 0.25}, {4, 1, 1}, {}, CellSplit::kuhnSix), relaxing({{{kShare, kTime}}}, nu, 1));
        const TetMesh& mesh = body.m_model->mesh();
        const std::vector<double> left = faceAreas(mesh, [](const Vec3&X) { return X.x < 1e-9; }),
                                  right = faceAreas(mesh, [](const Vec3&X) { return X.x > 1 - 1e-9; });
        for (std::size_t i = 0; i < left.size(); ++i) body.m_loads.m_force[i] = {kPull * (right[i] - left[i]), 0, 0};
        const double shear = kFast / (2 * (1 + nu)), bulk = kFast / (3 * (1 - 2 * nu));
        const int near = nodeAt(mesh, {0, 0, 0}), far = nodeAt(mesh, {1, 0, 0});
        StepSettings settings;
        for (int k = 1; k <= 600; ++k)
        {
            step(body, settings);
            const double t = k * settings.m_step;
            if (t < 0.1) continue;
            const double J = (1 - kShare * std::exp(-(1 - kShare) * t / kTime)) / ((1 - kShare) * shear);
            const double expected = kPull * (1 / (9 * bulk) + J / 3);
            EXPECT_NEAR(norm(body.m_state.m_x[far] - body.m_state.m_x[near]) - 1, expected, 0.02 * expected) << t;
        }
    }
}

// The response is bounded by elastic materials of the instantaneous and of the long-term modulus.
TEST(Relaxation, MaterialsOfFastAndSlowLoadsBoundIt)
{
    Body body = makeBody(makeBox({1, 0.5, 0.5}, {2, 1, 1}), relaxing(kThreeTerms), [](const Vec3&) { return true; });
    Body elastic = makeBody(body.m_model->mesh(), elasticMaterial(kFast, 0.3), [](const Vec3&) { return true; });
    for (Body* b : {&body, &elastic})
        for (Vec3& x : b->m_state.m_x) x.x *= 1.02;
    EXPECT_EQ(vonMises(elementStress(body, 0)), vonMises(elementStress(elastic, 0)));
    StepSettings settings;
    settings.m_step = 1;
    for (int k = 0; k < 100; ++k) step(body, settings);
    EXPECT_NEAR(vonMises(elementStress(body, 0)), 0.4 * vonMises(elementStress(elastic, 0)), 1e-3);
}

Body shaken(const NodePredicate& fixed = {})
{
    Material material = relaxing(kThreeTerms, 0.45);
    material.m_yieldStress = 2e3;
    Body body = makeBody(makeBox({1, 0.3, 0.3}, {6, 2, 2}, {}, CellSplit::kuhnSix), material, fixed);
    RandomVectors random(3);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
    {
        body.m_state.m_x[i] += 0.01 * random.next();
        if (!body.m_state.m_fixed[i]) body.m_state.m_v[i] = 0.5 * random.next();
    }
    return body;
}

// With plastic flow, too.
TEST(Relaxation, EnergyOnlyFalls)
{
    Body body = shaken([](const Vec3& X) { return X.x == 0; });
    double energy = mechanicalEnergy(body);
    for (int k = 0; k < 200; ++k)
    {
        step(body, StepSettings());
        const double now = mechanicalEnergy(body);
        EXPECT_LE(now, energy * (1 + 1e-6)) << k;
        EXPECT_GE(now, 0);
        energy = now;
    }
    EXPECT_GT(body.m_state.m_equivalentPlasticStrain[5], 0);
}

// Relaxed stress does not count for yielding.
TEST(Relaxation, RelaxedStressDoesNotYield)
{
    Material material = relaxing({{{0.5, 1e-3}}});
    const double mu = material.lameMu();
    material.m_yieldStress = 3 * mu * 0.01;  // at a uniaxial strain of 0.01 that keeps the volume
    Body body = makeBody(makeBox({1, 0.5, 0.5}, {2, 1, 1}), material, [](const Vec3&) { return true; });
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    const auto stretch = [&](double strain)
    {
        for (std::size_t i = 0; i < X.size(); ++i)
            body.m_state.m_x[i] = {(1 + strain) * X[i].x, (1 - strain / 2) * X[i].y, (1 - strain / 2) * X[i].z};
        step(body, StepSettings());
        return vonMises(elementStress(body, 0));
    };
    EXPECT_NEAR(stretch(0.009), 0.5 * 3 * mu * 0.009, 1e-3 * mu * 0.01);
    EXPECT_NEAR(stretch(0.014), 0.5 * 3 * mu * 0.014, 1e-3 * mu * 0.01);
    EXPECT_EQ(body.m_state.m_equivalentPlasticStrain[0], 0);
    stretch(0.025);
    EXPECT_GT(body.m_state.m_equivalentPlasticStrain[0], 1e-3);
}

bool isSame(const Body& a, const Body& b)
{
    const BodyState &s = a.m_state, &t = b.m_state;
    return largestDistance(s.m_x, t.m_x) <= 0 && s.m_relaxedStrain == t.m_relaxedStrain &&
           s.m_plasticStrain == t.m_plasticStrain;
}

TEST(Relaxation, BitsAreTheSameForAllThreadCountsAndRestored)
{
    const Body model = makeBody(makeBox({1, 0.5, 0.5}, {20, 8, 8}), relaxing(kThreeTerms));
    Body one(model.m_model);
    disturb(one);
    for (int k = 0; k < 3; ++k) step(one, StepSettings());
    for (const int count : {1, 2, 3, 8})
    {
        Body many(model.m_model);
        disturb(many);
        const Threads threads(count);
        StepSettings settings;
        settings.m_threads = &threads;
        for (int k = 0; k < 3; ++k) step(many, settings);
        EXPECT_TRUE(isSame(one, many)) << count;
    }
    Body restored(model.m_model);
    restored.m_loads = one.m_loads;
    const BodySnapshot snapshot = snapshotOf(one);
    check(snapshot, *restored.m_model);
    restore(snapshot, restored);
    step(one, StepSettings()), step(restored, StepSettings());
    EXPECT_TRUE(isSame(one, restored));
    BodySnapshot bad = snapshot;
    bad.m_relaxedStrain.pop_back();
    expectRejected([&] { check(bad, *one.m_model); }, {"relaxed strains"});
    bad = snapshot;
    bad.m_relaxedStrain[7].xx = std::nan("");
    expectRejected([&] { check(bad, *one.m_model); }, {"relaxed strain of element 2"});
}

TEST(Relaxation, StepsDoNotAllocate)
{
    Body body = shaken();
    step(body, StepSettings());
    const AllocationCounter counter;
    for (int k = 0; k < 5; ++k) step(body, StepSettings());
    EXPECT_EQ(counter.count(), 0);
}

TEST(Relaxation, MomentumIsExact)
{
    Body body = shaken();
    const Vec3 p = linearMomentum(body.m_state), L = angularMomentum(body.m_state);
    for (int k = 0; k < 100; ++k) step(body, StepSettings());
    EXPECT_LE(norm(linearMomentum(body.m_state) - p), 1e-11 * norm(p));
    EXPECT_LE(norm(angularMomentum(body.m_state) - L), 1e-11 * norm(p));
}

TEST(Relaxation, BadTermsAreRefused)
{
    const auto rejects = [](const std::array<PronyTerm, 3>& terms, std::initializer_list<const char*> parts)
    { expectRejected([&] { relaxing(terms).validate(); }, parts); };
    rejects({{{1, 1}}}, {"relaxation term 0", "share [-] is 1, outside [0, 0.99]"});
    rejects({{{-0.1, 1}}}, {"relaxation term 0", "share [-] is -0.1"});
    rejects({{{0.1, 1}, {std::nan(""), 1}}}, {"relaxation term 1", "share"});
    rejects({{{0.1, 0}}}, {"relaxation term 0", "time [s] is 0, outside [1e-06, 1000000000]"});
    rejects({{{0.5, 1}, {0.3, 1}, {0.3, 1}}}, {"sum of the relaxation terms' shares [-] is 1.1, outside [0, 0.99]"});
    rejects({{{0.5, 1}, {0, 1}, {0.3, 1}}}, {"relaxation term 2", "close the gap"});
    EXPECT_TRUE(relaxing({{{0.99, 1e-6}}}).valid());
    EXPECT_TRUE(relaxing({{{0.33, 1e9}, {0.33, 1}, {0.33, 1}}}).valid());
    EXPECT_NE(relaxing({{{0.3, 1}}}), relaxing({{{0.3, 2}}}));
    EXPECT_EQ(relaxing(kThreeTerms).relaxationTerms(), 3);
    EXPECT_EQ(Material().relaxationTerms(), 0);
}

}  // namespace
}  // namespace bullet_fem
