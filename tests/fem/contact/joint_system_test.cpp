// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// All joints of a contact problem are solved as one linear system.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/contact/compliance/compliance_cache.h"
#include "fem/contact/solver/rotated_anchor_factor.h"
#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

/// Joints of single nodes of the cube to the scene's rigid proxy, or to the world.
class JointSystemTest : public testing::Test
{
protected:
    static constexpr int kWorld = -1;

    Joint& hold(int node, int rigidProxy = kWorld) { return hold(m_scene, node, rigidProxy); }

    static Joint& hold(ContactScene& scene, int node, int rigidProxy = kWorld)
    {
        ContactProblem& problem = scene.m_problem;
        Joint joint;
        joint.m_a.m_body = 0;
        joint.m_a.m_first = static_cast<int>(problem.m_handleNodes.size());
        joint.m_a.m_count = 1;
        joint.m_b.m_rigidProxy = rigidProxy;
        joint.m_b.m_point = scene.m_body.m_state.m_x[node];
        problem.m_handleNodes.push_back(node);
        problem.m_handleBlocks.push_back(Mat3::identity());
        problem.m_joints.push_back(joint);
        return problem.m_joints.back();
    }

    /// Error of the joint's node velocity against its target [m/s].
    double miss(const Joint& joint) const
    {
        const Vec3 v = velocity(m_scene.m_body)[m_scene.m_problem.m_handleNodes[joint.m_a.m_first]];
        const Vec3 other = joint.m_b.m_rigidProxy >= 0
                               ? m_scene.m_rigidProxies[joint.m_b.m_rigidProxy].velocityAt(joint.m_b.m_point)
                               : Vec3();
        return norm(v - other - joint.m_wanted);
    }

    ContactReport solve()
    {
        m_scene.setVelocity({0.3, -0.5, -1});
        m_scene.m_settings.m_sweeps = 50;
        return m_scene.solve();
    }

    ContactScene m_scene;
    std::vector<Joint>& m_joints = m_scene.m_problem.m_joints;
};

TEST_F(JointSystemTest, TakesOneSweepPerOuterIteration)
{
    for (int node = 0; node < 9; ++node) hold(node);
    const ContactReport report = solve();
    EXPECT_LE(report.m_sweeps, report.m_rounds);
    for (const Joint& joint : m_joints) EXPECT_LT(miss(joint), 1e-6);
}

// Both a ball of a gram and one of a thousand tons are held.
TEST_F(JointSystemTest, HoldsRigidBodiesOfAnyMass)
{
    for (const double mass : {1e-3, 1e3, 1e6})
    {
        m_joints.clear();
        m_scene.m_problem.m_handleNodes.clear();
        m_scene.m_problem.m_handleBlocks.clear();
        makeBall(m_scene.m_rigidProxies[0], mass, 0.5);
        m_scene.m_rigidProxies[0].m_linearVelocity = {};
        m_scene.m_rigidProxies[0].m_angularVelocity = {};
        for (int node = 0; node < 9; ++node) hold(node, 0);
        solve();
        for (const Joint& joint : m_joints) EXPECT_LT(miss(joint), 1e-5) << mass;
    }
}

TEST_F(JointSystemTest, ToleratesDuplicateJoints)
{
    for (int node : {0, 4, 8, 4, 0}) hold(node);
    solve();
    for (const Joint& joint : m_joints)
    {
        EXPECT_LT(miss(joint), 1e-6);
        EXPECT_LT(norm(joint.m_impulse), 2e3);  // the cube has 1000 kg and 1.2 m/s
    }
}

TEST_F(JointSystemTest, BearsJointsThatContradictEachOther)
{
    hold(4).m_wanted = {1, 0, 0};
    hold(4).m_wanted = {-1, 0, 0};
    hold(0);
    solve();
    EXPECT_LT(std::min(miss(m_joints[0]), miss(m_joints[1])), 1e-6);
    EXPECT_LT(miss(m_joints[2]), 1e-6);
    for (const Joint& joint : m_joints) EXPECT_LT(norm(joint.m_impulse), 3e3);
}

// A stiff beam on joints at both ends that a rigid proxy bends: sweeps would pass the load on between contacts and
// joints, and ten outer iterations with 246 of them would not converge.
TEST(HeldBeam, IsBentWithinFewSweeps)
{
    constexpr int kCells = 20;
    Body beam = makeBody(makeBox({1, 0.05, 0.05}, {kCells, 1, 1}), elasticMaterial(1e9, 0.3));
    const std::vector<Vec3>& x = beam.m_state.m_x;
    const std::shared_ptr<ComplianceCache> cache = makeComplianceCache(beam.m_model);
    ContactProblem problem;
    problem.m_bodies = {{&beam, cache.get()}};
    problem.m_rigidProxies.resize(1);
    problem.m_rigidProxies[0].m_linearVelocity = {0, 0, 0.01};
    for (int i = 0; i < static_cast<int>(x.size()); ++i)
    {
        if (std::fabs(x[i].x - 0.5) > 0.499) problem.m_handleNodes.push_back(i);
        if (std::fabs(x[i].x - 0.5) > 0.06 || x[i].z > 0.01) continue;
        ContactPoint contact;
        contact.m_soft = {0, {i, i, i}, {1, 0, 0}};
        contact.m_rigidProxy = 0;
        contact.m_point = x[i];
        contact.m_normal = {0, 0, 1};
        problem.m_contacts.push_back(contact);
    }
    problem.m_handleBlocks.assign(problem.m_handleNodes.size(), Mat3::identity());
    for (std::size_t k = 0; k < problem.m_handleNodes.size(); ++k)
    {
        Joint joint;
        joint.m_a.m_body = 0;
        joint.m_a.m_first = static_cast<int>(k);
        joint.m_a.m_count = 1;
        joint.m_b.m_point = x[problem.m_handleNodes[k]];
        problem.m_joints.push_back(joint);
    }
    ContactSettings settings;
    ContactSolver solver;
    solveFreeMotion(beam, settings.m_step);
    const ContactReport report = solver.solve(problem, settings);
    RecordProperty("sweeps", report.m_sweeps);
    EXPECT_TRUE(report.m_converged);
    EXPECT_LT(report.m_violation, 1e-5);
    EXPECT_LT(report.m_sweeps, 40);
}

// A joint beyond its impulse limit stays at the limit, and the other joints carry the rest.
TEST_F(JointSystemTest, HoldsImpulsesAtTheirLimits)
{
    for (int node : {0, 2, 6, 8}) hold(node);
    m_joints[0].m_limit = {Joint::kUnlimited, Joint::kUnlimited, 50};
    m_joints[1].m_maxImpulse = 20;
    m_joints[2].m_limit = {0, Joint::kUnlimited, Joint::kUnlimited};
    m_joints[2].m_impulse = {10, 0, 0};  // as if left from a step in which it had none
    solve();
    EXPECT_NEAR(m_joints[0].m_impulse.z, 50, 1e-6);
    EXPECT_NEAR(norm(m_joints[1].m_impulse), 20, 1e-6);
    EXPECT_EQ(m_joints[2].m_impulse.x, 0);
    EXPECT_GT(miss(m_joints[0]), 1e-3);
    EXPECT_LT(miss(m_joints[3]), 1e-4);
    const Vec3 v = velocity(m_scene.m_body)[6];
    EXPECT_LT(std::hypot(v.y, v.z), 1e-4);
}

// A joint that starts at its limit, from the last step, is released from it.
TEST_F(JointSystemTest, ReleasesLimitsNoLongerReached)
{
    hold(4).m_maxImpulse = 1e6;
    m_joints[0].m_impulse = {0, 0, -1e6};
    solve();
    EXPECT_LT(miss(m_joints[0]), 1e-3);  // its initial impulse alone would make a thousand m/s
    EXPECT_LT(norm(m_joints[0].m_impulse), 1e4);
}

TEST_F(JointSystemTest, AddsCompliance)
{
    Joint& joint = hold(4);
    joint.m_compliance = 0.02;
    solve();
    const Vec3 v = velocity(m_scene.m_body)[4];
    EXPECT_LT(norm(v + 0.02 * m_joints[0].m_impulse), 1e-5);
    EXPECT_GT(norm(v), 0.01);
}

/// Each node of the cube's surface is held by a joint. The cube is rotated and strained.
class ManyHeldNodesTest : public JointSystemTest
{
protected:
    static constexpr int kNodes = 27, kInside = 13;

    ManyHeldNodesTest() { holdSurface(m_scene); }

    void holdSurface(ContactScene& scene) const
    {
        for (int node = 0; node < kNodes; ++node)
        {
            Vec3& x = scene.m_body.m_state.m_x[node];
            const Vec3 X = x;
            x = m_turn * Vec3{X.x * (1 + 0.2 * X.z), X.y - 0.1 * X.x * X.x, 1.1 * X.z};
            if (node == kInside) continue;
            Joint& joint = hold(scene, node);
            joint.m_wanted = 0.1 * X;
            for (int i = 0; i < 3; ++i) joint.m_axes[i] = {m_axes(0, i), m_axes(1, i), m_axes(2, i)};
        }
        scene.setVelocity({0.3, -0.5, -1});
        scene.m_settings.m_sweeps = 50;
        scene.m_settings.m_rounds = 10;  // W is that of the rest shape, and the cube is strained by a fifth
    }

    /// Error of the joint's node velocity along the joint's axes [m/s].
    double missAlongAxes(const Joint& joint) const
    {
        const Vec3 v = velocity(m_scene.m_body)[m_scene.m_problem.m_handleNodes[joint.m_a.m_first]];
        return norm(v - m_axes * joint.m_wanted);
    }

    /// Assembles the scene's rows after the free motion.
    void assemble(ContactRows& rows)
    {
        m_scene.m_problem.m_bodies = {{&m_scene.m_body, m_scene.m_cache.get()}};
        rows.assemble(m_scene.m_problem, m_scene.m_settings, 0);
    }

    const Mat3 m_turn = rotationAbout({0.3, -0.5, 0.8}, 0.7), m_axes = rotationAbout({1, 2, 0}, 1.1);
};

// The factor of A0^-1 between the nodes, a constant, inverts W of a body that is rotated without strain.
TEST_F(ManyHeldNodesTest, RotatedFactorInvertsTheirCompliance)
{
    const Mat3 turn = rotationAbout({1, 2, -1}, 0.8);
    for (std::size_t i = 0; i < m_scene.m_body.m_state.m_x.size(); ++i)
        m_scene.m_body.m_state.m_x[i] = turn * m_scene.m_body.m_model->mesh().restPositions()[i];
    solveFreeMotion(m_scene.m_body, m_scene.m_settings.m_step);
    ContactRows rows;
    assemble(rows);
    RotatedAnchorFactor turned(rows);
    const std::size_t unknowns = 3 * m_joints.size();
    turned.find(0, std::vector<unsigned char>(unknowns, 0));
    ASSERT_TRUE(turned.hasAll());

    std::mt19937 random(3);
    std::vector<double> right(unknowns);
    for (double& value : right) value = static_cast<double>(random()) / 4294967296.0 - 0.5;
    std::vector<double> x = right;
    turned.solve(x);
    for (std::size_t k = 0; k < m_joints.size(); ++k)
    {
        const ContactRow& row = rows.rows()[k];
        Vec3 v;
        for (std::size_t j = 0; j < m_joints.size(); ++j)
            for (int i = 0; i < 3; ++i)
                v += rows.compliance(row.m_a, rows.rows()[j].m_a) * (x[3 * j + i] * rows.rows()[j].m_axes[i]);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(dot(row.m_axes[i], v), right[3 * k + i], 1e-4);
    }
}

TEST_F(ManyHeldNodesTest, UseTheRotatedFactorOnlyWithoutOtherConstraints)
{
    solveFreeMotion(m_scene.m_body, m_scene.m_settings.m_step);
    makeBall(m_scene.m_rigidProxies[0], 10, 0.5);
    ContactRows rows;
    RotatedAnchorFactor turned(rows);
    const auto isTurned = [&](const std::vector<unsigned char>& held)
    {
        assemble(rows);
        turned.find(0, held);
        return turned.hasAny();
    };
    std::vector<unsigned char> none(3 * m_joints.size(), 0), one = none;
    one[7] = 1;
    EXPECT_TRUE(isTurned(none));
    EXPECT_FALSE(isTurned(one));
    m_joints[5].m_compliance = 1e-3;
    EXPECT_FALSE(isTurned(none));
    m_joints[5].m_compliance = 0;
    m_joints[20].m_b.m_rigidProxy = 0;
    EXPECT_FALSE(isTurned(none));
    m_joints[20].m_b.m_rigidProxy = kWorld;
    EXPECT_TRUE(isTurned(none));
}

TEST_F(ManyHeldNodesTest, TakeOneSweepPerOuterIteration)
{
    const ContactReport report = m_scene.solve();
    EXPECT_TRUE(report.m_converged);
    EXPECT_LE(report.m_sweeps, report.m_rounds);
    for (const Joint& joint : m_joints) EXPECT_LT(missAlongAxes(joint), 1e-6);
}

// A joint compliance negligible beside W makes the solver use the factor of the step's own W.
TEST_F(ManyHeldNodesTest, MatchTheResponseOfTheStepsOwnFactor)
{
    ContactScene other;
    holdSurface(other);
    other.m_problem.m_joints[0].m_compliance = 1e-12;
    m_scene.solve();
    other.solve();
    for (std::size_t k = 0; k < m_joints.size(); ++k)
    {
        const Vec3& impulse = m_joints[k].m_impulse;
        EXPECT_LT(norm(other.m_problem.m_joints[k].m_impulse - impulse), 1e-5 * norm(impulse));
    }
}

// One joint at its limit: the others are solved by the step's own factor.
TEST_F(ManyHeldNodesTest, HoldAnImpulseAtItsLimit)
{
    m_joints[4].m_maxImpulse = 1;
    m_scene.solve();
    EXPECT_NEAR(norm(m_joints[4].m_impulse), 1, 1e-6);
    EXPECT_GT(missAlongAxes(m_joints[4]), 1e-3);
    m_joints.erase(m_joints.begin() + 4);
    for (const Joint& joint : m_joints) EXPECT_LT(missAlongAxes(joint), 1e-4);
}

// For any earlier requests to the cache, as after restoring a saved state.
TEST_F(ManyHeldNodesTest, HaveTheSameBitsWithAnyHistoryOfTheCache)
{
    ContactScene other;
    holdSurface(other);
    other.m_cache->factorOf({3, 1, 0});
    const std::vector<int>& nodes = other.m_problem.m_handleNodes;
    other.m_cache->factorOf({nodes.rbegin(), nodes.rend()});
    m_scene.solve();
    other.solve();
    for (int node = 0; node < kNodes; ++node)
        EXPECT_EQ(norm(velocity(m_scene.m_body)[node] - velocity(other.m_body)[node]), 0) << node;
}

// Inner nodes that were exposed once have columns in the cache, as after restoring an earlier state.
TEST_F(JointSystemTest, HoldsInnerNodesWithTheSameBitsWithAnyNodesOfTheCache)
{
    constexpr int kMiddle = 13, kNodes = 27;
    ContactScene other;
    std::vector<int> all(kNodes);
    std::iota(all.begin(), all.end(), 0);
    other.m_cache = makeComplianceCache(other.m_body.m_model, all);
    for (ContactScene* scene : {&m_scene, &other})
    {
        hold(*scene, kMiddle);
        scene->touchLowerFace(0, 0.5);
        scene->setVelocity({0.3, -0.5, -1});
        scene->solve();
    }
    for (int node = 0; node < kNodes; ++node)
        EXPECT_EQ(norm(velocity(m_scene.m_body)[node] - velocity(other.m_body)[node]), 0) << node;
}

// Joint and contacts are both fulfilled.
TEST_F(JointSystemTest, IsSolvedAmongContacts)
{
    hold(22);
    m_scene.touchLowerFace(0, 0.5);
    const ContactReport report = solve();
    EXPECT_TRUE(report.m_converged);
    EXPECT_LT(miss(m_joints[0]), 1e-4);
    for (const ContactPoint& contact : m_scene.m_contacts) EXPECT_GT(m_scene.relativeVelocity(contact).z, -1e-4);
}

}  // namespace
}  // namespace bullet_fem
