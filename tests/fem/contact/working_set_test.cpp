// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/working_set.h"

#include <gtest/gtest.h>

#include "fem/common/vector_targets.h"

#include <hwy/highway.h>
#include <functional>
#include <random>
#include <set>

#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

class Numbers
{
public:
    double operator()() { return m_uniform(m_engine); }
    Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }

private:
    std::mt19937 m_engine{7};
    std::uniform_real_distribution<double> m_uniform{-1, 1};
};

// Fewer rows than a kernel's block, as many and more; orders with and without a remainder at the end of its loop.
TEST(ResponseKernel, MatchesItsReferenceOnEveryInstructionSet)
{
    Numbers random;
    int compared = 0;
    for (const std::size_t order : {kResponsePadding, 3 * kResponsePadding})
        for (const std::size_t count : {0, 1, 2, 4, 7, 11})
        {
            const std::size_t stride = order + 5;
            std::vector<float> columns(3 * stride * count + 1);
            for (float& w : columns) w = static_cast<float>(random());
            std::vector<Response> responses;
            for (std::size_t k = 0; k < count; ++k)
                responses.push_back({&columns[3 * stride * k], stride, random.vector()});
            std::vector<double> before(order + 1);
            for (double& v : before) v = random();
            std::vector<double> expected = before;
            scalar::addResponses(responses.data(), count, order, expected.data());
            for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
            {
                hwy::SetSupportedTargetsForTest(target);
                std::vector<double> v = before;
                addResponses(responses.data(), count, order, v.data());
                for (std::size_t i = 0; i <= order; ++i, ++compared)
                    EXPECT_NEAR(v[i], expected[i], 1e-14) << hwy::TargetName(target) << " " << order << " " << i;
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    EXPECT_GE(compared, 160);
}

/// Points with slots of their own and weighted means of some nodes, in turn, with a random compliance between the slots
/// and random shares in the rigid motion.
class RandomPoints
{
public:
    RandomPoints(int points, Numbers& random)
    {
        const ContactBody body = {&m_scene.m_body, m_scene.m_cache.get()};
        m_points.clear(m_scene.m_body.m_state.m_x.size());
        for (int k = 0; k < points; ++k)
            if (k % 2 == 0)
                m_points.addOwn();
            else
                m_points.add(meanOf({k % 3, 1 + k % 4, 5}, random));
        m_points.numberSlots();
        solveFreeMotion(m_scene.m_body, StepSettings());
        std::vector<RigidMomentum::Share> shares(m_points.slots());
        for (RigidMomentum::Share& share : shares)
        {
            share.m_component = 0;
            for (Mat3* part : {&share.m_linear, &share.m_angular})
                for (auto& row : part->m) std::generate_n(row, 3, std::ref(random));
        }
        m_points.request(body);
        m_points.form(body, 1, shares);
        for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(m_points.slots()); ++i)
            for (std::size_t j = 0; j <= i; ++j) m_points.set(i, j, random());
    }

    static SurfacePoint meanOf(const std::vector<int>& nodes, Numbers& random)
    {
        SurfacePoint point;
        point.m_body = 0;
        point.m_count = static_cast<int>(nodes.size());
        std::copy(nodes.begin(), nodes.end(), point.m_nodes.begin());
        std::generate_n(point.m_weights.begin(), point.m_count, std::ref(random));
        return point;
    }

    ContactScene m_scene;
    PointCompliance m_points;
};

// A set of points, another one, smaller ones until absent points are dropped, and finally all points.
TEST(WorkingSet, MovesAsTheWholeWouldUnderImpulsesOnIt)
{
    constexpr int kEnds = 11;
    Numbers random;
    RandomPoints all(kEnds, random);
    PointCompliance& W = all.m_points;
    std::vector<double> velocity(W.order());
    for (double& v : velocity) v = random();
    const auto respond = [&](int e, const Vec3& impulse)
    {
        W.forEachSlot(e,
                      [&](int slot, double weight)
                      {
                          const Response response = W.response(slot, weight * impulse);
                          addResponses(&response, 1, W.order(), velocity.data());
                      });
        W.addRigid({W.rigid(e).response(impulse)}, velocity);
    };
    ASSERT_EQ(W.rigid(0).component(), 0);
    WorkingSet set;
    set.reset(W, 1);
    const std::vector<std::vector<int>> choices = {{7, 2, 9, 2, 1, 0, 8},
                                                   {2, 7, 10, 9, 8, 1, 4},
                                                   {10, 4},
                                                   {10, 4},
                                                   {10, 3, 4, 5},
                                                   {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}};
    std::size_t largest = 0;
    for (const std::vector<int>& chosen : choices)
    {
        set.choose();
        for (int e : chosen) set.add(e);
        set.pack(velocity);
        for (int e : chosen) EXPECT_TRUE(set.has(e)) << e;
        EXPECT_EQ(std::count_if(velocity.begin(), velocity.end(), [](double v) { return !std::isfinite(v); }), 0);
        largest = std::max(largest, set.ends().size() - std::set<int>(chosen.begin(), chosen.end()).size());
        // A mix of two sweeps has the equally mixed velocities of their impulses.
        std::vector<Vec3> now(kEnds), last(kEnds);
        std::array<std::vector<Vec3>, 2> delta;
        delta.fill(std::vector<Vec3>(kEnds));
        for (int sweep = 0; sweep < 4; ++sweep)
        {
            const int slot = sweep % 2;
            for (int e : set.ends())
            {
                const Vec3 impulse = random.vector();
                set.push(e, impulse);
                respond(e, impulse);
                now[e] += impulse;
                if (sweep > 0) delta[slot][e] = now[e] - last[e];
                last[e] = now[e];
            }
            set.noteSweep(slot, sweep == 0);
            const std::array<double, 2> shares = {random(), random()};
            set.mixSweeps(shares);
            for (int e : set.ends())
                for (int j = 0; j < 2; ++j)
                {
                    now[e] -= shares[j] * delta[j][e];
                    respond(e, -shares[j] * delta[j][e]);
                }
        }
        for (int e : set.ends()) EXPECT_LE(norm(set.velocity(e) - W.read(e, velocity)), 1e-12) << e;
    }
    EXPECT_EQ(largest, 1u);  // one absent point is kept, five are dropped
}

/// A cube falls on the floor between two walls at a distance of `gap` [m]: its sides come into contact only because it
/// is compressed.
class Shaft
{
public:
    explicit Shaft(double gap)
    {
        m_scene.m_rigidProxies.resize(3);
        m_scene.m_settings.m_tolerance = 1e-9;
        m_scene.m_settings.m_maxRounds = 30;
        m_scene.setVelocity({0, 0, -2});
        m_scene.touchLowerFace(0, 0.3);
        const std::vector<Vec3>& x = m_scene.m_body.m_state.m_x;
        for (int i = 0; i < static_cast<int>(x.size()); ++i)
            if (x[i].x == 0 || x[i].x == 1) touchWall(i, gap, x[i].x == 0 ? 1 : -1);
    }

    ContactScene m_scene;

private:
    void touchWall(int node, double gap, double side)
    {
        m_scene.touchNode(node, gap, 0.3);
        m_scene.m_contacts.back().m_normal = {side, 0, 0};
        m_scene.m_contacts.back().m_rigidProxy = side > 0 ? 1 : 2;
    }
};

TEST(ContactsAtRest, JoinWhenOthersPressOnThem)
{
    constexpr double kGap = 1e-4;
    Shaft shaft(kGap);
    ContactScene& scene = shaft.m_scene;
    scene.solve();
    const double allowed = kGap / scene.m_settings.m_step.m_step;
    double largest = 0;
    for (const ContactPoint& c : scene.m_contacts) largest = std::max(largest, norm(c.m_impulse));
    int pressed = 0;
    for (std::size_t k = 9; k < scene.m_contacts.size(); ++k)
    {
        const ContactPoint& c = scene.m_contacts[k];
        const double closing = -dot(c.m_normal, scene.relativeVelocity(c)), impulse = dot(c.m_normal, c.m_impulse);
        EXPECT_LE(closing, allowed + 1e-6) << k;
        EXPECT_GE(impulse, 0) << k;
        EXPECT_LE(impulse * std::fabs(closing - allowed), 1e-6 * largest) << k;
        pressed += impulse > 0 ? 1 : 0;
    }
    EXPECT_GE(pressed, 6);
}

TEST(ContactsAtRest, ChangeNothing)
{
    Shaft shaft(1);
    shaft.m_scene.solve();
    ContactScene alone;
    alone.m_settings = shaft.m_scene.m_settings;
    alone.setVelocity({0, 0, -2});
    alone.touchLowerFace(0, 0.3);
    alone.solve();
    for (std::size_t k = 0; k < alone.m_contacts.size(); ++k)
    {
        const Vec3 expected = alone.m_contacts[k].m_impulse;
        EXPECT_LE(norm(shaft.m_scene.m_contacts[k].m_impulse - expected), 1e-6 * norm(expected)) << k;
    }
    for (std::size_t k = 9; k < shaft.m_scene.m_contacts.size(); ++k)
        EXPECT_EQ(norm(shaft.m_scene.m_contacts[k].m_impulse), 0) << k;
}

}  // namespace
}  // namespace bullet_fem
