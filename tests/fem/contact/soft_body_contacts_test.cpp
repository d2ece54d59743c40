// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/soft_body_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

void addNode(SoftBodyContacts& ends, const Body& body, int node)
{
    const int point = ends.addPoint();
    ends.makeRoom();
    ends.setPoint(point, {0, {node, node, node}, {1, 0, 0}}, body.m_state.m_x[node]);
}

// An impulse on a corner of a rotated and strained cube; a second correction has nothing to do.
TEST(SoftBodyContacts, ApplyAnImpulseOnce)
{
    const auto makeCube = []
    {
        Body body = makeBody(makeBox({1, 1, 1}, {3, 3, 3}), elasticMaterial(1e6, 0.3));
        for (Vec3& x : body.m_state.m_x) x = {1.3 * x.y, -x.x, x.z + 0.2 * x.x};
        return body;
    };
    StepSettings settings;
    settings.m_tolerance = 1e-9;
    const Vec3 impulse = {0, 30, 50};

    Body expected = makeCube();
    solveFreeMotion(expected, settings);
    std::vector<Vec3> impulses(expected.m_state.m_x.size());
    impulses[0] = impulse;
    applyImpulses(expected, impulses, settings);

    Body body = makeCube();
    solveFreeMotion(body, settings);
    const auto largestDifference = [&]
    {
        double largest = 0;
        for (std::size_t i = 0; i < impulses.size(); ++i)
            largest = std::max(largest, norm(velocity(body)[i] - velocity(expected)[i]));
        return largest;
    };
    const auto cache = makeComplianceCache(body.m_model);
    SoftBodyContacts ends;
    ends.clear({&body, cache.get()}, StepSettings());
    addNode(ends, body, 0);
    ends.assemble(400, settings.m_step);
    ends.request();
    ends.form();
    ends.measure();
    const double whole = largestDifference();
    ends.push(0, impulse);
    const auto correct = [&]
    {
        ImpulseResponse response = ends.beginCorrection(settings, 0);
        if (!response.m_body) return false;
        applyImpulses(&response, 1);
        ends.endCorrection();
        ends.measure();
        return true;
    };

    EXPECT_TRUE(correct());
    EXPECT_LT(largestDifference(), 1e-7 * whole);
    EXPECT_FALSE(correct());
}

// Impulses of rounding size change velocities of 1 m/s by zero or by rounding.
TEST(SoftBodyContacts, LearnNothingFromTheRoundingOfVelocities)
{
    Body body = makeBody(makeBox({1, 1, 1}, {3, 3, 3}), elasticMaterial(1e6, 0.3));
    std::fill(body.m_state.m_v.begin(), body.m_state.m_v.end(), Vec3{0.3, -0.2, 1});
    const StepSettings settings;
    solveFreeMotion(body, settings);
    const auto cache = makeComplianceCache(body.m_model);
    SoftBodyContacts ends;
    ends.clear({&body, cache.get()}, StepSettings());
    for (int node : {0, 1, 2}) addNode(ends, body, node);
    ends.assemble(400, settings.m_step);
    ends.request();
    ends.form();
    ends.measure();
    const Mat3 before = ends.compliance(1, 1);
    for (double impulse = 1e-30; impulse < 1e-8; impulse *= 3)
    {
        ends.push(1, {impulse, 0.1 * impulse, -impulse});
        ImpulseResponse response = ends.beginCorrection(settings, 0);
        applyImpulses(&response, 1);
        ends.endCorrection();
        ends.measure();
        ASSERT_FALSE(ends.hasLearnt()) << impulse << " N s";
        ASSERT_FALSE(ends.isTooSoft()) << impulse << " N s";
    }
    for (int k = 0; k < 9; ++k) EXPECT_EQ(ends.compliance(1, 1)(k / 3, k % 3), before(k / 3, k % 3));
}

// The correction that reverts wrong predicted impulses changes velocities by more than its own impulses do.
TEST(SoftBodyContacts, LearnNothingFromWrongPredictedImpulses)
{
    Body body = makeBody(makeBox({1, 1, 1}, {3, 3, 3}), elasticMaterial(1e6, 0.3));
    std::vector<Vec3> expected(body.m_state.m_x.size());
    expected[0] = {0, 0, -100};
    FreeMotion motion;
    motion.m_body = &body;
    motion.m_predicted = &expected;
    solveFreeMotions(&motion, 1);
    const auto cache = makeComplianceCache(body.m_model);
    SoftBodyContacts ends;
    ends.clear({&body, cache.get(), &expected}, StepSettings());
    for (int node : {0, 1, 2}) addNode(ends, body, node);
    ends.assemble(400, motion.m_settings.m_step);
    ends.request();
    ends.form();
    ends.takeExpected(motion.m_settings, 0);
    ends.measure();
    const auto correct = [&](const Vec3& impulse)
    {
        ends.push(0, impulse);
        ImpulseResponse response = ends.beginCorrection(motion.m_settings, 0);
        applyImpulses(&response, 1);
        ends.endCorrection();
        ends.measure();
    };
    correct({0, 0, 10});
    EXPECT_FALSE(ends.hasLearnt());
    EXPECT_FALSE(ends.isTooSoft());
    correct({0, 0, 10});
    EXPECT_FALSE(ends.hasLearnt());  // W is exact
    EXPECT_FALSE(ends.isTooSoft());
}

/// A stiff cube in a step of a quarter of its factor's, with a contact and, if held, a joint at two corners.
class StaleCorners : public testing::Test
{
protected:
    void begin(bool isHeld)
    {
        solveFreeMotion(m_body, m_settings);
        m_ends.clear({&m_body, m_cache.get()}, m_settings);
        addNode(m_ends, m_body, 0);
        if (isHeld) m_ends.beginJoints();
        addNode(m_ends, m_body, 26);
        m_ends.assemble(400, m_settings.m_step);
        m_ends.request();
        m_ends.form();
        m_ends.measure();
    }

    /// Pushes the corners together, which neither accelerates nor turns the body; returns the error of the velocity
    /// that the compliance predicts for the first [-].
    double push()
    {
        const Vec3 before = m_ends.velocity(0);
        const Vec3 impulse = {20, 20, 20};
        m_ends.push(0, impulse);
        m_ends.push(1, -impulse);
        m_ends.refresh();
        const Vec3 predicted = m_ends.velocity(0) - before;
        ImpulseResponse response = m_ends.beginCorrection(m_settings, 0);
        applyImpulses(&response, 1);
        m_ends.endCorrection();
        m_ends.measure();
        const Vec3 change = m_ends.velocity(0) - before;
        return norm(predicted - change) / norm(change);
    }

    static StepSettings quarter()
    {
        StepSettings settings;
        settings.m_step *= 0.25;
        settings.m_tolerance = 1e-6;
        return settings;
    }

    StepSettings m_settings = quarter();
    Body m_body = makeBody(makeBox({1, 1, 1}, {2, 2, 2}), elasticMaterial(1e8, 0.3));
    std::shared_ptr<ComplianceCache> m_cache = makeComplianceCache(m_body.m_model);
    SoftBodyContacts m_ends;
};

TEST_F(StaleCorners, HaveThePresentComplianceFromTheFirstCorrectionOn)
{
    begin(true);
    EXPECT_GT(push(), 0.5);
    EXPECT_TRUE(m_ends.hasLearnt());
    EXPECT_LT(push(), 1e-3);
    EXPECT_FALSE(m_ends.hasLearnt());
    begin(true);
    EXPECT_LT(push(), 1e-3);
}

// Many bodies with stale factors would take long.
TEST_F(StaleCorners, HaveThePresentComplianceOnlyWithJoints)
{
    begin(false);
    push();
    EXPECT_TRUE(m_ends.hasLearnt());
    EXPECT_GT(push(), 0.01);
}

TEST_F(StaleCorners, KeepThePresentComplianceInASnapshot)
{
    begin(true);
    push();
    const BodySnapshot snapshot = snapshotOf(m_body);
    m_body = Body(m_body.m_model);
    restore(snapshot, m_body);
    begin(true);
    EXPECT_LT(push(), 1e-3);
    BodySnapshot bad = snapshot;
    bad.m_presentSteps = -1;
    EXPECT_THROW(check(bad, *m_body.m_model), std::invalid_argument);
}

// A body on one pin rotates about it by the impulse's moment, for any shape; the lever arms of the rest shape, along
// which the impulse here nearly points, would give a thirtieth of the response.
TEST(SoftBodyContacts, KnowTheRigidResponseOfAStrainedBody)
{
    const auto isPinned = [](const Vec3& X) { return norm(X) < 1e-6; };
    Body body = makeBody(makeBox({1, 1, 1}, {3, 3, 3}), elasticMaterial(1e9, 0.3), isPinned);
    for (Vec3& x : body.m_state.m_x)
        x = {1.6 * x.x + 0.3 * x.y * x.z, x.y + 0.5 * x.x * x.x, 0.7 * x.z - 0.5 * x.x * x.y};
    StepSettings settings;
    settings.m_tolerance = 1e-6;
    solveFreeMotion(body, settings);
    const auto cache = makeComplianceCache(body.m_model);
    SoftBodyContacts ends;
    ends.clear({&body, cache.get()}, StepSettings());
    ends.beginJoints();
    const int last = static_cast<int>(body.m_state.m_x.size()) - 1;
    for (int node : {last, last - 1}) addNode(ends, body, node);
    ends.assemble(400, settings.m_step);
    ends.request();
    ends.form();
    ends.measure();
    const Vec3 v = ends.trueVelocity(0);
    ends.push(0, ends.rotation(last) * Vec3{10, 10, 10});
    ends.refresh();
    const Vec3 predicted = ends.velocity(0) - v;
    ImpulseResponse response = ends.beginCorrection(settings, 0);
    applyImpulses(&response, 1);
    EXPECT_LE(norm(predicted - (ends.trueVelocity(0) - v)), 2e-2 * norm(predicted));
}

}  // namespace
}  // namespace bullet_fem
