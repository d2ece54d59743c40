// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The variation of a body's recent steps. Its effect with tension: elasticity/tension_test.cpp.
#include "fem/solve/step_variation.h"

#include <gtest/gtest.h>

#include "bullet_fem/fem/body/body_snapshot.h"
#include "fem/body/step_scratch.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

class StepVariation : public testing::Test
{
protected:
    double after(double step)
    {
        noteStep(m_body, step);
        return m_body.m_workspace.scratch().m_stepVariation;
    }

    void take(Body& body, double step) const
    {
        StepSettings settings;
        settings.m_numericalDamping = 0;
        settings.m_step = step;
        bullet_fem::step(body, settings);
    }

    Body m_body = clampedBeam();
};

TEST_F(StepVariation, IsZeroForEqualSteps)
{
    for (const double step : {1.0 / 60, 1e-6, 1.0})
    {
        m_body.m_state.m_leastStep = m_body.m_state.m_mostStep = 0;
        for (int k = 0; k < 100; ++k) ASSERT_EQ(after(step), 0) << step;
    }
}

TEST_F(StepVariation, IsThatOfTheSquaresOfTheLongestAndTheShortest)
{
    EXPECT_EQ(after(1.0 / 60), 0);
    EXPECT_NEAR(after(1.0 / 240), 1 - 1.1 * 1.1 / 16, 1e-14);  // the one before has decayed by a tenth
    EXPECT_NEAR(after(1.0 / 60), 1 - 1.1 * 1.1 / 16, 1e-14);
    EXPECT_NEAR(after(1.0 / 15), 1 - 1.21 * 1.21 / 256, 1e-14);
}

// 1.1^15 is 4.2. After a change of the step the extra damping decays as if the new step had always been used.
TEST_F(StepVariation, IsForgottenWithinFifteenStepsOfAQuarter)
{
    for (const double others : {1.0 / 240, 1.0 / 15})
    {
        m_body.m_state.m_leastStep = m_body.m_state.m_mostStep = 0;
        after(1.0 / 60);
        for (int k = 0; k < 14; ++k) EXPECT_GT(after(others), 0) << k;
        after(others);
        EXPECT_EQ(after(others), 0);
    }
}

TEST_F(StepVariation, IsSavedInSnapshots)
{
    disturb(m_body);
    for (const double step : {1.0 / 60, 1.0 / 60, 1.0 / 240}) take(m_body, step);
    Body other(m_body.m_model);
    const BodySnapshot snapshot = snapshotOf(m_body);
    check(snapshot, *other.m_model);
    restore(snapshot, other);
    other.m_loads = m_body.m_loads;
    for (const double step : {1.0 / 60, 1.0 / 100, 1.0 / 60})
    {
        take(m_body, step);
        take(other, step);
        EXPECT_GT(other.m_workspace.scratch().m_stepVariation, 0);
        EXPECT_EQ(largestDistance(m_body.m_state.m_x, other.m_state.m_x), 0);
    }
    BodySnapshot bad = snapshot;
    bad.m_leastStep = 2 * bad.m_mostStep;
    expectRejected([&] { check(bad, *other.m_model); }, {"recent steps"});
    bad.m_leastStep = -1;
    expectRejected([&] { check(bad, *other.m_model); }, {"recent steps"});
}

}  // namespace
}  // namespace bullet_fem
