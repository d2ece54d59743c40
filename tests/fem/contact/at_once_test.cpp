// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"

// Bodies with more contacts than ContactSettings::m_denseLimit, whose rows are solved by accelerated projected
// gradient.
namespace bullet_fem
{
namespace
{

constexpr double kStandardGravity = 9.81;

/// A slab of 1 x 1 x 0.125 m with 289 nodes, at rest on a floor, with contacts at all lower nodes.
class SlabOnFloor
{
public:
    static constexpr int kCells = 16, kLower = (kCells + 1) * (kCells + 1);

    explicit SlabOnFloor(int denseLimit)
        : m_body(makeBody(makeBox({1, 1, 0.125}, {kCells, kCells, 2}), elasticMaterial(1e5, 0.3))),
          m_cache(makeComplianceCache(m_body.m_model))
    {
        setGravity(m_body, {0, 0, -kStandardGravity});
        m_settings.m_denseLimit = denseLimit;
        m_problem.m_rigidProxies.resize(1);
        for (int node = 0; node < kLower; ++node)  // the grid's first layer
        {
            ContactPoint contact;
            contact.m_soft = {0, {node, node, node}, {1, 0, 0}};
            contact.m_rigidProxy = 0;
            contact.m_point = m_body.m_state.m_x[node];
            contact.m_normal = {0, 0, 1};
            contact.m_friction = 0.5;
            m_problem.m_contacts.push_back(contact);
        }
    }

    ContactReport solve()
    {
        solveFreeMotion(m_body, m_settings.m_step);
        m_problem.m_bodies = {{&m_body, m_cache.get()}};
        return m_solver.solve(m_problem, m_settings);
    }

    double fallOfStep() const { return kStandardGravity * m_settings.m_step.m_step; }
    double mass() const
    {
        double sum = 0;
        for (double m : m_body.m_state.m_mass) sum += m;
        return sum;
    }
    double support() const
    {
        double sum = 0;
        for (const ContactPoint& contact : m_problem.m_contacts) sum += contact.m_impulse.z;
        return sum;
    }

    Body m_body;

private:
    std::shared_ptr<ComplianceCache> m_cache;
    ContactProblem m_problem;
    ContactSettings m_settings;
    ContactSolver m_solver;
};

// Gauss-Seidel sweeps and accelerated projected gradient solve one problem to equal impulses.
TEST(AcceleratedProjectedGradient, StopsASlabAsGaussSeidelSweepsDo)
{
    SlabOnFloor atOnce(0), inTurn(SlabOnFloor::kLower);
    const ContactReport report = atOnce.solve();
    inTurn.solve();
    EXPECT_LT(report.m_violation, 1e-4 * atOnce.fallOfStep());
    double apart = 0;
    for (std::size_t i = 0; i < atOnce.m_body.m_state.m_x.size(); ++i)
        apart = std::max(apart, norm(velocity(atOnce.m_body)[i] - velocity(inTurn.m_body)[i]));
    EXPECT_LT(apart, 1e-3 * atOnce.fallOfStep());
    EXPECT_NEAR(atOnce.support(), inTurn.support(), 1e-3 * inTurn.support());
}

// Iterations stop when no gap closes any more.
TEST(AcceleratedProjectedGradient, StopsEarlyIfNothingCloses)
{
    SlabOnFloor slab(0);
    int sweeps = 0;
    for (int k = 0; k < 60; ++k)
    {
        sweeps = slab.solve().m_sweeps;
        finishStep(slab.m_body, {});
    }
    EXPECT_NEAR(slab.support(), slab.mass() * slab.fallOfStep(), 1e-3 * slab.support());
    EXPECT_LT(sweeps, 10);
}

// The body's compliance norm is estimated at some points: fixed points among them do not count.
TEST(AcceleratedProjectedGradient, HoldsABodyWithFixedNodes)
{
    SlabOnFloor slab(0);
    for (int k = 0; k < 4; ++k) slab.m_body.m_state.m_fixed[k * (SlabOnFloor::kLower - 1) / 3] = 1;
    EXPECT_LT(slab.solve().m_violation, 1e-3 * slab.fallOfStep());
    EXPECT_GT(slab.support(), 0.3 * slab.mass() * slab.fallOfStep());
}

}  // namespace
}  // namespace bullet_fem
