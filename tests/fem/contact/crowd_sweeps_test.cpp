// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "fem/contact/solver/sweep_parts.h"
#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

/// A block of soft cubes of 1 m, in contact side by side and one above another, compressed by their velocities, without
/// gravity; it falls on a floor, and a column of balls in contact falls on each cube of the top layer.
class CubeBlock
{
public:
    static constexpr int kSide = 5, kColumn = 3, kBalls = kColumn * kSide * kSide;

    CubeBlock() : m_model(model()), m_cache(makeComplianceCache(m_model))
    {
        const Vec3 middle = 0.5 * kSide * Vec3{1, 1, 1};
        for (int k = 0; k < kSide * kSide * kSide; ++k)
        {
            m_bodies.push_back(std::make_unique<Body>(m_model));
            const Vec3 corner = {double(k % kSide), double(k / kSide % kSide), double(k / (kSide * kSide))};
            for (Vec3& x : m_bodies.back()->m_state.m_x) x += corner;
            for (Vec3& v : m_bodies.back()->m_state.m_v) v = middle - corner + Vec3{0.1 * (k % 7), 0, -4};
        }
        m_problem.m_rigidProxies.resize(1 + kBalls);
        for (int k = 0; k < kBalls; ++k)
        {
            const int column = k / kColumn, level = k % kColumn;
            RigidProxy& ball = m_problem.m_rigidProxies[1 + k];
            ball.m_center = {column % kSide + 0.5, column / kSide + 0.5, kSide + 0.5 + level};
            ball.m_linearVelocity = {0, 0, -6};
            makeBall(ball, kBallMass, 0.5);
            if (level > 0) addTouch(1 + k, k);
        }
        addContacts();
    }

    ContactReport solve(const Threads* threads)
    {
        ContactSettings settings;
        settings.m_tolerance = 1e-3;
        settings.m_step.m_tolerance = 1e-6;
        settings.m_step.m_threads = threads;
        for (const auto& body : m_bodies)
        {
            solveFreeMotion(*body, settings.m_step);
            m_problem.m_bodies.push_back({body.get(), m_cache.get()});
        }
        return m_solver.solve(m_problem, settings);
    }

    Vec3 momentum() const
    {
        Vec3 sum = momentumOfBalls();
        for (const auto& body : m_bodies)
            for (std::size_t i = 0; i < body->m_state.m_mass.size(); ++i)
                sum += body->m_state.m_mass[i] * velocity(*body)[i];
        return sum;
    }
    Vec3 momentumBefore() const
    {
        Vec3 sum = momentumOfBalls();
        for (const auto& body : m_bodies)
            for (std::size_t i = 0; i < body->m_state.m_mass.size(); ++i)
                sum += body->m_state.m_mass[i] * body->m_state.m_v[i];
        return sum;
    }
    Vec3 impulseOfFloor() const
    {
        Vec3 sum;
        for (const ContactPoint& contact : m_problem.m_contacts)
            if (contact.m_rigidProxy == 0) sum += contact.m_impulse;
        return sum;
    }
    std::vector<Vec3> velocities() const
    {
        std::vector<Vec3> all;
        for (const RigidProxy& rigidProxy : m_problem.m_rigidProxies)
            all.insert(all.end(), {rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity});
        for (const auto& body : m_bodies) all.insert(all.end(), velocity(*body).begin(), velocity(*body).end());
        return all;
    }
    std::size_t contacts() const { return m_problem.m_contacts.size(); }

    /// Maximum approach speed of a ball and the one below [m/s].
    double closingOfBalls() const
    {
        double largest = 0;
        for (const RigidContact& touch : m_problem.m_rigidContacts)
            largest = std::max(largest, m_problem.m_rigidProxies[touch.m_other].m_linearVelocity.z -
                                            m_problem.m_rigidProxies[touch.m_rigidProxy].m_linearVelocity.z);
        return largest;
    }

    /// Maximum difference between a body's velocities and the response of its free motion to its impulses [m/s].
    double largestLoss()
    {
        StepSettings settings;
        settings.m_tolerance = 1e-9;
        double largest = 0;
        for (int b = 0; b < static_cast<int>(m_bodies.size()); ++b)
        {
            Body& body = *m_bodies[b];
            const std::vector<Vec3> found = velocity(body);
            std::vector<Vec3> impulses(found.size());
            for (const ContactPoint& contact : m_problem.m_contacts)
            {
                if (contact.m_soft.m_body == b) impulses[contact.m_soft.m_nodes[0]] += contact.m_impulse;
                if (contact.m_other.m_body == b) impulses[contact.m_other.m_nodes[0]] -= contact.m_impulse;
            }
            solveFreeMotion(body, settings);
            applyImpulses(body, impulses, settings);
            for (std::size_t i = 0; i < found.size(); ++i)
                largest = std::max(largest, norm(velocity(body)[i] - found[i]));
        }
        return largest;
    }

private:
    static constexpr double kBallMass = 100;  // [kg]

    Vec3 momentumOfBalls() const
    {
        Vec3 sum;
        for (int k = 1; k <= kBalls; ++k) sum += kBallMass * m_problem.m_rigidProxies[k].m_linearVelocity;
        return sum;
    }

    void addTouch(int above, int below)
    {
        RigidContact touch;
        touch.m_rigidProxy = above;
        touch.m_other = below;
        touch.m_normal = {0, 0, 1};
        touch.m_arm = {0, 0, -0.5};
        touch.m_otherArm = {0, 0, 0.5};
        m_problem.m_rigidContacts.push_back(touch);
    }

    static std::shared_ptr<const BodyModel> model()
    {
        static const std::shared_ptr<const BodyModel> made =
            makeBody(makeBox({1, 1, 1}, {2, 2, 2}), elasticMaterial(1e6, 0.3)).m_model;
        return made;
    }

    // Contacts of coincident nodes of neighbouring cubes.
    void addContacts()
    {
        const int step[3] = {1, kSide, kSide * kSide};
        for (int b = 0; b < static_cast<int>(m_bodies.size()); ++b)
            for (int axis = 0; axis < 3; ++axis)
            {
                const bool first = b / step[axis] % kSide == 0, last = b / step[axis] % kSide == kSide - 1;
                if (!first) addFace(b, b - step[axis], -1, axis, 0);
                if (axis == 2 && first) addFace(b, -1, 0, axis, 0);
                if (axis == 2 && last) addFace(b, -1, 1 + kColumn * (b % step[2]), axis, 1);
            }
    }
    void addFace(int body, int other, int rigidProxy, int axis, double side)
    {
        const std::vector<Vec3>& rest = m_bodies[0]->m_state.m_x;  // its corner is the origin
        for (int i = 0; i < static_cast<int>(rest.size()); ++i)
        {
            if (rest[i][axis] != side) continue;
            ContactPoint contact;
            contact.m_soft = {body, {i, i, i}, {1, 0, 0}};
            contact.m_rigidProxy = rigidProxy;
            contact.m_point = m_bodies[body]->m_state.m_x[i];
            contact.m_normal[axis] = side == 0 ? 1 : -1;
            contact.m_friction = 0.3;
            for (int j = 0; j < static_cast<int>(rest.size()) && other >= 0; ++j)
            {
                const Vec3 apart = m_bodies[other]->m_state.m_x[j] - contact.m_point;
                if (dot(apart, apart) < 1e-6) contact.m_other = {other, {j, j, j}, {1, 0, 0}};
            }
            m_problem.m_contacts.push_back(contact);
        }
    }

    std::shared_ptr<const BodyModel> m_model;
    std::shared_ptr<ComplianceCache> m_cache;
    std::vector<std::unique_ptr<Body>> m_bodies;
    ContactProblem m_problem;
    ContactSolver m_solver;
};

TEST(CrowdSweeps, HaveTheSameBitsOnAllThreads)
{
    CubeBlock alone;
    ASSERT_GT(alone.contacts(), std::size_t(2 * SweepParts::kRowsOfPart));
    const ContactReport report = alone.solve(nullptr);
    const std::vector<Vec3> expected = alone.velocities();
    for (const int count : {1, 2, 3})
    {
        const Threads threads(count);
        CubeBlock shared;
        EXPECT_EQ(shared.solve(&threads).m_sweeps, report.m_sweeps);
        const std::vector<Vec3> found = shared.velocities();
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t k = 0; k < found.size(); ++k)
            for (int i = 0; i < 3; ++i) ASSERT_EQ(found[k][i], expected[k][i]) << count << " threads, " << k;
    }
}

TEST(CrowdSweeps, ConserveMomentumAndLeaveNothingClosing)
{
    const Threads threads(2);
    CubeBlock block;
    const Vec3 before = block.momentumBefore();
    const ContactReport report = block.solve(&threads);
    EXPECT_LT(report.m_violation, 2e-2) << "of speeds up to 6 m/s";
    EXPECT_LT(block.closingOfBalls(), 2e-2);
    const Vec3 change = block.momentum() - before;
    EXPECT_GT(change.z, 1e4);
    EXPECT_LT(norm(change - block.impulseOfFloor()), 1e-6 * norm(change));
}

// Early outer iterations solve the bodies loosely; their residual is solved for in the last one.
TEST(CrowdSweeps, GiveBodiesAllTheirImpulses)
{
    CubeBlock block;
    block.solve(nullptr);
    EXPECT_LT(block.largestLoss(), 1e-3) << "of velocity changes of some m/s";
}

}  // namespace
}  // namespace bullet_fem
