// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The guarantees of a step hold for bodies with actuators: equal bits, momentum, no allocation.
#include <gtest/gtest.h>

#include "bullet_fem/fem/batch/batch_memory.h"
#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/hollow_meshes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

// A ball of some 2,000 nodes with a sealed gas and two cables, in motion.
Body actuatedBall(const std::shared_ptr<const BodyModel>& model = nullptr)
{
    Body body = model ? Body(model) : makeBody(hollowSphere(0.06, 0.1, 8, 4), elasticMaterial(1e6, 0.3));
    const TetMesh& mesh = body.m_model->mesh();
    Chamber chamber;
    chamber.m_triangles = findCavities(mesh).at(0);
    chamber.m_isSealed = true;
    chamber.m_gas = 1.2 * kStandardAtmosphere * chamber.volume(mesh.restPositions());
    body.m_actuators.m_chambers = {chamber};
    const auto point = [&](const Vec3& X)
    {
        CablePoint p;
        p.m_nodes.fill(nodeAt(mesh, X));
        return p;
    };
    Cable given, elastic;
    given.m_points = {point({0.1, 0, 0}), point({0, 0.1, 0}), point({0, 0, 0.1})};
    given.m_tension = 5;
    elastic.m_points = {point({-0.1, 0, 0}), point({0, 0, -0.1})};
    elastic.m_stiffness = 1e5;
    elastic.m_restLength = 0.14;
    body.m_actuators.m_cables = {given, elastic};
    RandomVectors random(7);
    for (Vec3& v : body.m_state.m_v) v = 0.2 * random.next();
    return body;
}

bool sameBits(const Body& a, const Body& b)
{
    return largestDistance(a.m_state.m_x, b.m_state.m_x) == 0 && largestDistance(a.m_state.m_v, b.m_state.m_v) == 0;
}

TEST(ActuatedSteps, AreTheSameOnAnyNumberOfThreads)
{
    for (const double damping : {1.0, 0.0})
    {
        StepSettings settings;
        settings.m_numericalDamping = damping;
        Body alone = actuatedBall();
        ASSERT_GT(alone.m_model->nodeCount(), 1000);  // smaller bodies are not divided among threads
        for (int k = 0; k < 5; ++k) step(alone, settings);
        for (const int count : {1, 2, 3, 8})
        {
            const Threads threads(count);
            settings.m_threads = &threads;
            Body shared = actuatedBall();
            for (int k = 0; k < 5; ++k) step(shared, settings);
            settings.m_threads = nullptr;
            EXPECT_TRUE(sameBits(alone, shared)) << count;
        }
    }
}

TEST(ActuatedSteps, AllocateNothingAfterTheFirst)
{
    Body body = actuatedBall();
    StepSettings settings;
    step(body, settings);
    const AllocationCounter counter;
    for (int k = 0; k < 10; ++k) step(body, settings);
    settings.m_numericalDamping = 0;
    for (int k = 0; k < 10; ++k) step(body, settings);
    EXPECT_EQ(counter.count(), 0);
}

// Copies with actuators beside bodies without any, which are solved in a batch.
TEST(ActuatedSteps, AreTheSameBesideABatch)
{
    Body alone = actuatedBall();
    BatchMemory memory;
    StepSettings settings;
    settings.m_batchMemory = &memory;
    std::vector<Body> bodies;
    for (int k = 0; k < 10; ++k)
    {
        bodies.push_back(actuatedBall(alone.m_model));
        if (k % 3 != 0) bodies.back().m_actuators = {};
    }
    for (int s = 0; s < 5; ++s)
    {
        std::vector<FreeMotion> motions(bodies.size());
        std::vector<StepEnd> ends(bodies.size());
        for (std::size_t k = 0; k < bodies.size(); ++k)
        {
            motions[k].m_body = ends[k].m_body = &bodies[k];
            motions[k].m_settings = ends[k].m_settings = settings;
        }
        solveFreeMotions(motions.data(), static_cast<int>(bodies.size()));
        finishSteps(ends.data(), static_cast<int>(bodies.size()));
        step(alone, StepSettings());
    }
    for (const int k : {0, 3, 6, 9}) EXPECT_TRUE(sameBits(alone, bodies[k])) << k;
}

// After its actuators are removed the body is batched again, with the bits of a body that never had any.
TEST(ActuatedSteps, LeaveNothingWhenTheActuatorsAreGone)
{
    BatchMemory memory;
    StepSettings settings;
    settings.m_batchMemory = &memory;
    std::vector<Body> bodies;
    bodies.push_back(actuatedBall());
    for (int k = 1; k < 12; ++k)
    {
        bodies.push_back(actuatedBall(bodies[0].m_model));
        bodies.back().m_actuators = {};
    }
    for (int s = 0; s < 3; ++s) step(bodies[0], settings);
    bodies[0].m_actuators = {};
    restore(snapshotOf(bodies[0]), bodies[1]);  // a body that never had any
    std::vector<FreeMotion> motions(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k)
    {
        motions[k].m_body = &bodies[k];
        motions[k].m_settings = settings;
    }
    solveFreeMotions(motions.data(), static_cast<int>(bodies.size()));
    const std::vector<Vec3> impulses(bodies[0].m_state.m_x.size(), Vec3{0, 0, 1e-4});
    for (int k : {0, 1})
    {
        applyImpulses(bodies[k], impulses, settings);
        finishStep(bodies[k], settings);
    }
    EXPECT_TRUE(sameBits(bodies[0], bodies[1]));
}

TEST(ActuatedSteps, KeepTheMomentum)
{
    for (const double damping : {1.0, 0.0})
    {
        StepSettings settings;
        settings.m_numericalDamping = damping;
        Body body = actuatedBall();
        const Vec3 P = linearMomentum(body.m_state), L = angularMomentum(body.m_state);
        for (int k = 0; k < 60; ++k) step(body, settings);
        const double mass = 3.28;
        EXPECT_LE(norm(linearMomentum(body.m_state) - P), 1e-12 * mass);
        EXPECT_LE(norm(angularMomentum(body.m_state) - L), 1e-12 * mass);
    }
}

}  // namespace
}  // namespace bullet_fem
