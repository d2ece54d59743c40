// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies solved in a batch are bitwise equal to bodies solved one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "bullet_fem/fem/batch/batch_memory.h"
#include "bullet_fem/fem/common/threads.h"
#include "fem/batch/batched_solve.h"
#include "fem/scenes/element_case.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

constexpr int kSteps = 100;

bool sameBits(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Vec3& p, const Vec3& q) { return p.x == q.x && p.y == q.y && p.z == q.z; });
}

bool operator==(const SolveReport& a, const SolveReport& b)
{
    return a.m_iterations == b.m_iterations && a.m_residual == b.m_residual && a.m_stop == b.m_stop;
}

/// Copies of a block that differ in all state and parameters in which bodies of one model may differ.
class Copies
{
public:
    Copies(const std::shared_ptr<const BodyModel>& model, int count)
    {
        for (int k = 0; k < count; ++k) add(model, static_cast<unsigned>(k));
    }

    void add(const std::shared_ptr<const BodyModel>& model, unsigned k)
    {
        m_bodies.emplace_back(model);
        Body& body = m_bodies.back();
        if (k % 3 == 1)
            for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i) body.m_state.m_fixed[i] = i % 7 == 0;
        disturb(body, 7 + k);
        for (Vec3& v : body.m_state.m_v) v *= 0.2 * k;  // only the first one is at rest
        for (Vec3& v : body.m_loads.m_targetVelocity) v = {0, 0.05 * k, 0};
        StepSettings settings;
        settings.m_tolerance = k % 5 == 2 ? 1e-6 : 1e-3;
        settings.m_direct = k % 7 == 3;
        settings.m_warp = k % 4 == 3 ? Warp::global : Warp::nodal;
        if (k % 6 == 5) settings.m_maxIterations = 2;
        m_settings.push_back(settings);
        std::vector<Vec3> impulses(body.m_state.m_x.size());
        RandomVectors random(50 + k);
        for (Vec3& J : impulses) J = 0.01 * k * random.next();
        m_impulses.push_back(impulses);
    }

    int count() const { return static_cast<int>(m_bodies.size()); }

    void stepTogether(const Threads* threads = nullptr)
    {
        for (StepSettings& settings : m_settings) settings.m_batchMemory = &m_memory;
        std::vector<FreeMotion> motions;
        std::vector<ImpulseResponse> responses;
        for (int k = 0; k < count(); ++k)
        {
            m_settings[k].m_threads = threads;
            motions.push_back({&m_bodies[k], m_settings[k], {}});
            if (isPushed(k)) responses.push_back(responseOf(k));
        }
        solveFreeMotions(motions.data(), count());
        applyImpulses(responses.data(), static_cast<int>(responses.size()));
        m_reports.clear();
        auto response = responses.begin();
        for (int k = 0; k < count(); ++k)
        {
            m_reports.push_back(motions[k].m_report);
            m_reports.push_back(isPushed(k) ? response++->m_report : SolveReport());
        }
        std::vector<StepEnd> ends;
        for (int k = 0; k < count(); ++k) ends.push_back({&m_bodies[k], m_settings[k], false});
        finishSteps(ends.data(), count());
        ++m_step;
    }

    void stepAlone()
    {
        m_reports.clear();
        for (int k = 0; k < count(); ++k)
        {
            m_reports.push_back(solveFreeMotion(m_bodies[k], m_settings[k]));
            ImpulseResponse response = responseOf(k);
            if (isPushed(k)) applyImpulses(&response, 1);
            m_reports.push_back(response.m_report);
            finishStep(m_bodies[k], m_settings[k]);
        }
        ++m_step;
    }

    // The number of bodies that may be batched.
    int sideBySide()
    {
        int result = 0;
        for (int k = 0; k < count(); ++k) result += canBeBatched(FreeMotion{&m_bodies[k], m_settings[k], {}});
        return result;
    }

    void expectSameBits(const Copies& other, int step) const
    {
        for (int k = 0; k < count(); ++k)
        {
            const BodyState &a = m_bodies[k].m_state, &b = other.m_bodies[k].m_state;
            ASSERT_TRUE(sameBits(a.m_x, b.m_x) && sameBits(a.m_v, b.m_v)) << "body " << k << ", step " << step;
            ASSERT_TRUE(m_reports[2 * k] == other.m_reports[2 * k]) << "body " << k << ", step " << step;
            ASSERT_TRUE(m_reports[2 * k + 1] == other.m_reports[2 * k + 1]) << "body " << k << ", step " << step;
        }
    }

    bool isPushed(int k) const { return (m_step / 2 + k) % m_pushedEvery == 0; }
    ImpulseResponse responseOf(int k) { return {&m_bodies[k], &m_impulses[k], m_settings[k], 0.1 * k, k % 2 == 1, {}}; }

    BatchMemory m_memory;
    int m_step = 0, m_pushedEvery = 1;  // body and two steps
    std::vector<Body> m_bodies;
    std::vector<StepSettings> m_settings;
    std::vector<std::vector<Vec3>> m_impulses;
    std::vector<SolveReport> m_reports;  // of the free motion and the response of every body
};

// Makes `count` steps, with batches in `together` and one by one in `alone`; expects equal bits.
void expectSameSteps(Copies& together, Copies& alone, int count)
{
    for (int k = 0; k < count; ++k)
    {
        together.stepTogether();
        alone.stepAlone();
        together.expectSameBits(alone, k);
    }
}

class Batch : public testing::TestWithParam<int>
{
};

TEST_P(Batch, GivesEveryBodyItsOwnBits)
{
    const auto model = freeBlock().m_model;
    Copies together(model, GetParam()), alone(model, GetParam());
    expectSameSteps(together, alone, kSteps);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Batch, testing::Values(1, 5, 17, 40));

class BatchOnTarget : public OnTarget
{
};

TEST_P(BatchOnTarget, GivesEveryBodyItsOwnBits)
{
    for (const int element : {0, 1, 2})
    {
        Material material = dampedMaterial();
        material.m_meanDilatation = element == 0 ? MeanDilatation::off : MeanDilatation::on;
        material.m_bending = element == 2 ? Bending::accurate : Bending::plain;
        const auto model = makeBody(makeBox({1, 0.8, 0.7}, {3, 3, 2}), material).m_model;
        Copies together(model, 40), alone(model, 40);
        expectSameSteps(together, alone, 5);
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, BatchOnTarget, testing::ValuesIn(availableTargets()), targetName);

// Checks that the comparison is meaningful: the bodies need different numbers of iterations, and stop for different
// reasons.
TEST(BatchOfCopies, ConvergesBodyByBody)
{
    Copies bodies(freeBlock().m_model, 17);
    bodies.stepTogether();
    std::set<int> iterations;
    std::set<SolveStop> stops;
    for (const SolveReport& report : bodies.m_reports)
    {
        iterations.insert(report.m_iterations);
        stops.insert(report.m_stop);
    }
    EXPECT_GE(iterations.size(), 5u);
    EXPECT_GE(bodies.sideBySide(), kSmallestBatch);
    EXPECT_EQ(stops, (std::set<SolveStop>{SolveStop::converged, SolveStop::budget}));
}

TEST(BatchOfCopies, TakesBodiesOfOtherModelsAmongThem)
{
    const auto block = freeBlock().m_model, beam = clampedBeam().m_model;
    Copies together(block, 0), alone(block, 0);
    for (unsigned k = 0; k < 9; ++k)
        for (Copies* copies : {&together, &alone}) copies->add(k == 2 || k > 6 ? beam : block, k);
    expectSameSteps(together, alone, 10);
}

// Bodies large enough to be divided among threads, on the low-memory path, too.
TEST(BatchOfCopies, HasTheSameBitsForEveryNumberOfThreads)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {10, 10, 9});
    for (const FactorChoice choice : {FactorChoice::full, FactorChoice::lowMemory})
    {
        const auto full = makeBody(mesh, dampedMaterial()).m_model;
        FactorInput input = full->factorInput();
        input.m_choice = choice;
        const auto model = BodyModel::create(full->sharedShape(), input);
        ASSERT_GE(model->nodeCount(), 1000);
        Copies alone(model, 5);
        alone.stepAlone();
        for (const int count : {1, 2, 3})
        {
            const Threads threads(count);
            Copies together(model, 5);
            together.stepTogether(&threads);
            together.expectSameBits(alone, count);
        }
    }
}

// Bodies without impulses in the last step skip the work that only impulses need.
TEST(BatchOfCopies, TakesIntermittentImpulses)
{
    const auto model = freeBlock().m_model;
    for (const bool tension : {true, false})
    {
        Copies together(model, 40), alone(model, 40);
        for (Copies* copies : {&together, &alone})
        {
            copies->m_pushedEvery = 3;
            for (StepSettings& settings : copies->m_settings) settings.m_tension = tension;
        }
        expectSameSteps(together, alone, 20);
    }
}

// The ends of second-order steps are batched, too.
TEST(BatchOfCopies, TakesStepsOfSecondOrder)
{
    const auto model = freeBlock().m_model;
    for (const double damping : {0.0, 0.4})
    {
        Copies together(model, 40), alone(model, 40);
        for (Copies* copies : {&together, &alone})
            for (StepSettings& settings : copies->m_settings) settings.m_numericalDamping = damping;
        expectSameSteps(together, alone, 10);
    }
}

// The damping by tension of varying steps needs one more product. A body added later has another history of steps.
TEST(BatchOfCopies, TakesVaryingSteps)
{
    const auto model = freeBlock().m_model;
    for (const double damping : {0.0, 1.0})
    {
        Copies together(model, 40), alone(model, 40);
        for (int k = 0; k < 12; ++k)
        {
            for (Copies* copies : {&together, &alone})
            {
                if (k == 6) copies->add(model, 3);
                for (StepSettings& settings : copies->m_settings)
                {
                    settings.m_numericalDamping = damping;
                    settings.m_step = 1 / (k % 3 == 2 ? 240.0 : 60.0);
                }
            }
            expectSameSteps(together, alone, 1);
        }
    }
}

// The breakdown of one body does not affect the others.
TEST(BatchOfCopies, LosesNoBodyBesideABadOne)
{
    const auto model = freeBlock().m_model;
    Copies together(model, 6), alone(model, 6);
    for (Copies* copies : {&together, &alone})
        copies->m_bodies[2].m_loads.m_force[0].x = std::numeric_limits<double>::quiet_NaN();
    together.stepTogether();
    alone.stepAlone();
    EXPECT_EQ(together.m_reports[4].m_stop, SolveStop::breakdown);
    for (const int k : {0, 1, 3, 4, 5})
    {
        EXPECT_TRUE(sameBits(together.m_bodies[k].m_state.m_v, alone.m_bodies[k].m_state.m_v)) << k;
        EXPECT_TRUE(std::isfinite(together.m_bodies[k].m_state.m_v[0].x)) << k;
    }
}

TEST(BatchOfCopies, ConservesTheMomentumOfEveryBody)
{
    Copies bodies(freeBlock().m_model, 5);
    std::vector<Vec3> expected;
    for (int k = 0; k < 5; ++k)
    {
        const Body& body = bodies.m_bodies[k];
        const double h = bodies.m_settings[k].m_step, alpha = body.m_model->shape().m_material.m_massDamping;
        Vec3 force, impulse;
        for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        {
            force += body.m_loads.m_force[i];
            impulse += bodies.m_impulses[k][i];
        }
        expected.push_back((1 / (1 + h * alpha)) * (linearMomentum(body.m_state) + h * force + impulse));
    }
    bodies.stepTogether();
    for (const int k : {0, 2, 3})  // without fixed nodes
        EXPECT_LE(norm(linearMomentum(bodies.m_bodies[k].m_state) - expected[k]), 1e-12 * (1 + norm(expected[k]))) << k;
}

TEST(BatchOfCopies, MayBeEmpty)
{
    solveFreeMotions(nullptr, 0);
    applyImpulses(static_cast<ImpulseResponse*>(nullptr), 0);
}

}  // namespace
}  // namespace bullet_fem
