// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Copies of a body solved in batches are bitwise equal to copies solved one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "support/thread_sanitizer.h"

namespace bullet_fem
{
namespace
{

btFemSolverInfo batchInfo(bool batches, int threads)
{
    btFemSolverInfo info;
    info.m_batchBodies = batches;
    info.m_threads = threads;
    return info;
}

/// Ten copies of a box, with two other bodies among them, fall on a floor and on each other, each with its own state.
class FallingCopies
{
public:
    FallingCopies(bool batches, int threads, Coupling coupling)
        : m_fem(batchInfo(batches, threads)), m_world(m_fem, coupling)
    {
        m_world.addFloorBox();
        for (int k = 0; k < 12; ++k)
        {
            SoftBox box;
            box.m_size = {0.3, 0.3, 0.3};
            box.m_cells = {3, 3, k % 6 == 5 ? 2 : 3};
            box.m_center = {0.35 * (k % 4), 0.05 * k, 0.16 + 0.33 * (k / 4)};
            box.m_youngModulus = 2e5;
            m_soft.push_back(&addSoftBox(m_world, m_fem, box));
        }
        m_world.step();
        for (int k = 0; k < 12; ++k)
            for (int i = 0; i < m_soft[k]->m_nodes.size(); ++i)
                m_soft[k]->m_nodes[i].m_v.setX(btScalar(0.3 * k * (i % 3)));
        m_soft[3]->setMass(4, 0);  // after the factor was made, so that it is shared with the others
        m_fem.setDetail(m_soft[6], btFemDetail::globalWarp);
        m_fem.setDetail(m_soft[7], btFemDetail::direct);
    }

    std::vector<btScalar> run(int steps)
    {
        std::vector<btScalar> bits;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (const btSoftBody* soft : m_soft)
            {
                const std::vector<btScalar> own = bitsOf(*soft);
                bits.insert(bits.end(), own.begin(), own.end());
                const btFemStepReport& report = m_fem.stepReport(soft);
                for (const btScalar value :
                     {btScalar(report.m_iterations), report.m_residual, btScalar(report.m_flags)})
                    bits.push_back(value);
                m_iterations.insert(report.m_iterations);
                m_mostContacts = std::max(m_mostContacts, report.m_contacts);
            }
        }
        return bits;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    std::vector<btSoftBody*> m_soft;
    std::set<int> m_iterations;
    int m_mostContacts = 0;
};

class BatchedWorld : public testing::TestWithParam<Coupling>
{
};

TEST_P(BatchedWorld, GivesTheBitsOfBodiesOneByOneForEveryNumberOfThreads)
{
    FallingCopies alone(false, 1, GetParam());
    const std::vector<btScalar> bits = alone.run(stepsOnThreads(60));
    EXPECT_GT(alone.m_mostContacts, 10);
    EXPECT_GE(alone.m_iterations.size(), 3u);
    for (const int threads : {1, 2, 3, 8})
        EXPECT_TRUE(FallingCopies(true, threads, GetParam()).run(stepsOnThreads(60)) == bits) << threads;
}

INSTANTIATE_TEST_SUITE_P(Solvers, BatchedWorld, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

TEST(BatchReports, TellEveryBodyItsOwn)
{
    FallingCopies world(true, 1, Coupling::swap);
    world.run(2);
    std::set<int> iterations;
    for (const btSoftBody* soft : world.m_soft)
    {
        const btFemStepReport& report = world.m_fem.stepReport(soft);
        iterations.insert(report.m_iterations);
        EXPECT_GT(report.m_freeMotionMs, 0);
        EXPECT_EQ(report.m_nodes, soft->m_nodes.size());
    }
    EXPECT_GE(iterations.size(), 3u);
    EXPECT_EQ(world.m_fem.stepReport(world.m_soft[7]).m_detail, btFemDetail::direct);
    EXPECT_EQ(world.m_fem.stepReport(world.m_soft[6]).m_detail, btFemDetail::globalWarp);
    EXPECT_TRUE(world.m_fem.stepReport(world.m_soft[3]).m_flags & BT_FEM_STALE_FACTOR);
    EXPECT_FALSE(world.m_fem.stepReport(world.m_soft[4]).m_flags & BT_FEM_STALE_FACTOR);
}

}  // namespace
}  // namespace bullet_fem
