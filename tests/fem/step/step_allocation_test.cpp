// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Changing conditions cause no allocation in a step.
#include <gtest/gtest.h>

#include <tuple>

#include "bullet_fem/fem/batch/batch_memory.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

using AllocationCase = std::tuple<Warp, bool, bool>;  // warp, direct, clamped

class StepAllocations : public testing::TestWithParam<AllocationCase>
{
protected:
    StepAllocations()
    {
        m_settings.m_warp = std::get<0>(GetParam());
        m_settings.m_direct = std::get<1>(GetParam());
        const bool clamped = std::get<2>(GetParam());
        m_body = std::make_unique<Body>(makeBody(makeBox({1, 1, 1}, {3, 3, 3}), Material(),
                                                 [clamped](const Vec3& X) { return clamped && X.x == 0; }));
        setGravity(*m_body, {0, 0, -9.81});
        RandomVectors random(3);
        for (Vec3& v : m_body->m_state.m_v) v = random.next();
        for (Vec3& v : m_body->m_loads.m_targetVelocity) v = {0, 0.1, 0};
        m_impulses.assign(m_body->m_state.m_x.size(), {0.1, 0, 0.3});
    }

    void takeAStep()
    {
        solveFreeMotion(*m_body, m_settings);
        applyImpulses(*m_body, m_impulses, m_settings);
        applyPositionCorrection(*m_body, m_impulses, m_settings);
        finishStep(*m_body, m_settings);
    }

    StepSettings m_settings;
    std::unique_ptr<Body> m_body;
    std::vector<Vec3> m_impulses;
};

TEST_P(StepAllocations, ThereAreNoneInAnyStep)
{
    const AllocationCounter counter;
    for (int k = 0; k < 10; ++k) takeAStep();
    EXPECT_EQ(counter.count(), 0);
}

// Flat, inverted and collapsed elements use the singular value path.
TEST_P(StepAllocations, ThereAreNoneForDegenerateElements)
{
    for (std::size_t i = 0; i < m_body->m_state.m_x.size(); ++i) m_body->m_state.m_x[i].z *= i % 3 == 0 ? 0 : -1;
    const AllocationCounter counter;
    for (int k = 0; k < 10; ++k) takeAStep();
    EXPECT_EQ(counter.count(), 0);
}

INSTANTIATE_TEST_SUITE_P(Settings, StepAllocations,
                         testing::Combine(testing::Values(Warp::nodal, Warp::global), testing::Bool(), testing::Bool()),
                         [](const auto& suite)
                         {
                             return std::string(std::get<0>(suite.param) == Warp::nodal ? "Nodal" : "Global") +
                                    (std::get<1>(suite.param) ? "Direct" : "Converged") +
                                    (std::get<2>(suite.param) ? "Clamped" : "Free");
                         });

// Eight bodies with different numbers of iterations, in scratch memory sized by one step.
TEST(BatchAllocations, ThereAreNoneInAnyStep)
{
    std::vector<Body> bodies;
    std::vector<FreeMotion> motions;
    std::vector<ImpulseResponse> responses;
    const auto model = makeBody(makeBox({1, 1, 1}, {3, 3, 3}), Material()).m_model;
    for (unsigned k = 0; k < 8; ++k)
    {
        bodies.emplace_back(model);
        RandomVectors random(k);
        for (Vec3& v : bodies.back().m_state.m_v) v = 0.3 * k * random.next();
    }
    const std::vector<Vec3> impulses(model->nodeCount(), {0.1, 0, 0.3});
    BatchMemory memory;
    StepSettings settings;
    settings.m_batchMemory = &memory;
    for (Body& body : bodies)
    {
        motions.push_back({&body, settings, {}});
        responses.push_back({&body, &impulses, settings, 0, false, {}});
    }
    const auto takeAStep = [&]
    {
        solveFreeMotions(motions.data(), static_cast<int>(motions.size()));
        applyImpulses(responses.data(), static_cast<int>(responses.size()));
        for (Body& body : bodies) finishStep(body, {});
    };
    takeAStep();
    const AllocationCounter counter;
    for (int k = 0; k < 10; ++k) takeAStep();
    EXPECT_EQ(counter.count(), 0);
}

// The contact solver's scratch grows with the number of contacts, and never after a step with as many.
TEST(ContactAllocations, ThereAreNoneAfterAStepWithAsManyContacts)
{
    ContactScene scene;
    scene.setVelocity({1, 0, -2});
    scene.touchLowerFace(-0.01, 0.5);
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);

    ContactProblem fewer = scene.m_problem;
    fewer.m_contacts.erase(fewer.m_contacts.begin(), fewer.m_contacts.begin() + 4);
    const AllocationCounter counter;
    for (int k = 0; k < 10; ++k)
    {
        solveFreeMotion(scene.m_body, scene.m_settings.m_step);
        scene.m_solver.solve(k % 2 ? fewer : scene.m_problem, scene.m_settings);
        finishStep(scene.m_body, scene.m_settings.m_step);
    }
    EXPECT_EQ(counter.count(), 0);
}

// Contacts at other nodes, so that columns of the compliance are evicted and solved again.
TEST(ContactAllocations, ThereAreNoneWhenContactsWander)
{
    ContactScene scene;
    const std::vector<int> surface = scene.m_body.m_model->mesh().surfaceNodes();
    for (int k = 0; k < 3; ++k) scene.touchNode(surface[k], 0, 0.5);
    scene.solve();
    const AllocationCounter counter;
    for (std::size_t k = 0; k < surface.size(); ++k)
    {
        for (ContactPoint& contact : scene.m_contacts)
        {
            const int node = surface[(contact.m_soft.m_nodes[0] + 5 * k) % surface.size()];
            contact.m_soft.m_nodes = {node, node, node};
        }
        scene.m_solver.solve(scene.m_problem, scene.m_settings);
    }
    EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace bullet_fem
