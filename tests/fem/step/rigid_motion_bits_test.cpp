// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Spinning strained bodies have equal bits for every number of threads, in batches, and after a snapshot.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/fem/batch/batch_memory.h"
#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/common/threads.h"
#include "fem/scenes/free_bodies.h"

namespace bullet_fem
{
namespace
{

// Bends, twists and spins a bar, differently for each k; every fourth one hangs on a point, every fourth on a line.
void release(Body& body, int k)
{
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    if (k % 2 == 0)
        bend(body, 0.3 + 0.1 * k);
    else
        twist(body, 0.2 * k);
    rotate(body, rotationAbout({1, 0.3 * k, -1}, 0.2 * k));
    spin(body, {2.0 + k, -0.5 * k, 20});
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        const bool isOnEdge = X[i].x < -0.499 * kBarLength && X[i].y < -0.0149;
        const bool isPinned = isOnEdge && (k % 4 == 3 || X[i].z < -0.0149);
        if (k % 4 < 2 || !isPinned) continue;
        body.m_state.m_fixed[i] = 1;
        body.m_state.m_v[i] = {};
        if (k % 4 == 3) body.m_state.m_x[i] = X[i];
    }
    setGravity(body, {0.1 * k, 0, -9.81});
}

// Free motion, two answers to impulses, a position correction and the end of a step, of all bodies at once.
void stepTogether(std::vector<Body>& bodies, const StepSettings& settings)
{
    std::vector<FreeMotion> motions;
    std::vector<ImpulseResponse> responses;
    std::vector<StepEnd> ends;
    std::vector<std::vector<Vec3>> impulses;
    RandomVectors random(3);
    for (Body& body : bodies)
    {
        impulses.emplace_back(body.m_state.m_x.size());
        for (Vec3& J : impulses.back()) J = 1e-4 * random.next();
    }
    for (std::size_t k = 0; k < bodies.size(); ++k)
    {
        motions.push_back({&bodies[k], settings, {}});
        responses.push_back({&bodies[k], &impulses[k], settings, 0, false, {}});
        ends.push_back({&bodies[k], settings, false});
    }
    const int count = static_cast<int>(bodies.size());
    solveFreeMotions(motions.data(), count);
    for (int round = 0; round < 2; ++round) applyImpulses(responses.data(), count);
    for (std::size_t k = 0; k < bodies.size(); ++k) applyPositionCorrection(bodies[k], impulses[k], settings);
    finishSteps(ends.data(), count);
}

std::vector<Body> copiesOf(const std::shared_ptr<const BodyModel>& model, int count)
{
    std::vector<Body> bodies;
    for (int k = 0; k < count; ++k)
    {
        bodies.emplace_back(model);
        release(bodies.back(), k);
    }
    return bodies;
}

void expectSameBits(const Body& a, const Body& b, const char* what)
{
    EXPECT_EQ(largestDistance(a.m_state.m_x, b.m_state.m_x), 0) << what;
    EXPECT_EQ(largestDistance(a.m_state.m_v, b.m_state.m_v), 0) << what;
    EXPECT_GT(kineticEnergy(a.m_state), 0) << what;
}

class SpinningBits : public testing::TestWithParam<double>  // numerical damping
{
protected:
    SpinningBits() { m_settings.m_numericalDamping = GetParam(); }

    StepSettings m_settings;
};

// Bodies large enough to be shared.
TEST_P(SpinningBits, AreEqualForEveryNumberOfThreads)
{
    const auto model = makeBody(makeFreeBar({40, 5, 5}), barMaterial(1e7)).m_model;
    ASSERT_GE(model->nodeCount(), 1000);
    for (const int k : {0, 1, 2, 3})
    {
        Body first(model);
        release(first, k);
        std::vector<Body> alone;
        alone.push_back(std::move(first));
        for (int s = 0; s < 2; ++s) stepTogether(alone, m_settings);
        for (const int count : {1, 2, 3})
        {
            const Threads threads(count);
            StepSettings settings = m_settings;
            settings.m_threads = &threads;
            std::vector<Body> shared;
            shared.emplace_back(model);
            release(shared[0], k);
            for (int s = 0; s < 2; ++s) stepTogether(shared, settings);
            expectSameBits(shared[0], alone[0], count == 1 ? "1 thread" : count == 2 ? "2 threads" : "3 threads");
        }
    }
}

// Full and partial batches; those on pins are among the others.
TEST_P(SpinningBits, AreEqualInABatchAndAlone)
{
    const auto model = makeBody(makeFreeBar(), barMaterial(1e6)).m_model;
    for (const int count : {1, 5, 17, 32})
    {
        BatchMemory memory;
        StepSettings settings = m_settings;
        settings.m_batchMemory = &memory;
        std::vector<Body> together = copiesOf(model, count);
        for (int s = 0; s < 10; ++s) stepTogether(together, settings);
        std::vector<Body> alone = copiesOf(model, count);
        for (int s = 0; s < 10; ++s) stepTogether(alone, m_settings);
        for (int k = 0; k < count; ++k) expectSameBits(together[k], alone[k], std::to_string(k).c_str());
    }
}

// A body that is restored before each step moves as the one that is not.
TEST_P(SpinningBits, AreEqualAfterASnapshot)
{
    const auto model = makeBody(makeFreeBar(), barMaterial(1e6)).m_model;
    std::vector<Body> bodies = copiesOf(model, 4);
    for (int s = 0; s < 20; ++s)
    {
        m_settings.m_step = s % 3 == 2 ? 1.0 / 240 : 1.0 / 60;
        std::vector<Body> restored;
        for (const Body& body : bodies)
        {
            const BodySnapshot snapshot = snapshotOf(body);
            restored.emplace_back(model);
            check(snapshot, *model);
            restore(snapshot, restored.back());
            restored.back().m_loads = body.m_loads;
        }
        stepTogether(bodies, m_settings);
        stepTogether(restored, m_settings);
        for (std::size_t k = 0; k < bodies.size(); ++k) expectSameBits(bodies[k], restored[k], "restored");
    }
}

INSTANTIATE_TEST_SUITE_P(Steps, SpinningBits, testing::Values(0, 1),
                         [](const auto& suite) { return nameOfDamping(suite.param); });

}  // namespace
}  // namespace bullet_fem
