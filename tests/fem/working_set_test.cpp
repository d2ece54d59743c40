// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/working_set.h"

#include <gtest/gtest.h>

#include "fem/vector_targets.h"

#include <hwy/highway.h>
#include <random>

#include "fem/contact_scene.h"

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

DenseCompliance randomCompliance(int ends, Numbers& random)
{
    DenseCompliance W;
    W.resize(ends);
    for (std::size_t i = 0; i < W.order(); ++i)
        for (std::size_t j = 0; j < W.order(); ++j) W(i, j) = static_cast<float>(random());
    return W;
}

// Orders with and without a rest at the end of every vector width.
TEST(ResponseKernel, AgreesWithItsTwinOnEveryInstructionSet)
{
    Numbers random;
    int compared = 0;
    for (const int ends : {1, 2, 3, 5, 8, 21})
    {
        const std::size_t order = 3 * static_cast<std::size_t>(ends);
        std::vector<float> columns(3 * order);
        for (float& w : columns) w = static_cast<float>(random());
        const Vec3 impulse = random.vector();
        std::vector<double> before(order);
        for (double& v : before) v = random();
        std::vector<double> expected = before;
        scalar::addResponse(columns.data(), order, impulse, expected.data());
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
        {
            hwy::SetSupportedTargetsForTest(target);
            std::vector<double> v = before;
            addResponse(columns.data(), order, impulse, v.data());
            for (std::size_t i = 0; i < order; ++i, ++compared)
                EXPECT_NEAR(v[i], expected[i], 1e-15 * 4) << hwy::TargetName(target) << " " << order << " " << i;
        }
        hwy::SetSupportedTargetsForTest(0);
    }
    EXPECT_GE(compared, 120);
}

TEST(WorkingSet, MovesAsTheWholeWouldUnderImpulsesOnIt)
{
    constexpr int kEnds = 11;
    Numbers random;
    const DenseCompliance W = randomCompliance(kEnds, random);
    std::vector<Vec3> velocity(kEnds);
    for (Vec3& v : velocity) v = random.vector();
    WorkingSet set;
    set.reset(kEnds);
    const std::vector<std::vector<int>> choices = {{7, 2, 9, 2}, {0}, {10, 3, 4, 5}, {10, 3, 4, 5}};
    for (const std::vector<int>& chosen : choices)
    {
        set.clear();
        for (int e : chosen) set.add(e);
        set.pack(W, velocity);
        for (int e = 0; e < kEnds; ++e)
            EXPECT_EQ(set.has(e), std::find(chosen.begin(), chosen.end(), e) != chosen.end()) << e;
        set.beginProbe();
        for (int e : set.ends())
        {
            const Vec3 impulse = random.vector(), direction = random.vector();
            set.push(e, impulse);
            W.respond(e, impulse, velocity);
            set.addToProbe(e, direction);
            W.respond(e, 0.5 * direction, velocity);
        }
        set.respondToProbe();
        set.followProbe(0.5);
        for (int e : set.ends()) EXPECT_LE(norm(set.velocity(e) - velocity[e]), 1e-14) << e;
    }
}

/// A cube that falls on the floor between two walls that stand `gap` [m] beside it: its sides touch them only because
/// it is pressed flat.
class Shaft
{
public:
    explicit Shaft(double gap)
    {
        m_scene.m_obstacles.resize(3);
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
        m_scene.m_contacts.back().m_obstacle = side > 0 ? 1 : 2;
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
