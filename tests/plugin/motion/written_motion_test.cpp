// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Programs set whole bodies going by their nodes' velocities, put them back, turn them and take them out: the motion is
// their new state, and no strain comes of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/kinematic_bodies.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

enum class Holder
{
    none,
    targets,  // node targets
    pins,     // pinned nodes, whose positions the program writes
    anchors   // to a kinematic box
};

std::string nameOfHolder(Holder holder)
{
    const char* names[] = {"Free", "Targets", "Pins", "Anchors"};
    return names[static_cast<int>(holder)];
}

/// A bar of .2 x .2 x 1 m that hangs on the nodes of its top.
class HeldBar
{
public:
    HeldBar(Holder holder, Coupling coupling, double step, double young)
        : m_world(WorldClass::softRigid, coupling, {0, 0, 0}, secondOrder()), m_holder(holder), m_step(step)
    {
        m_body = btFemHelpers::createFromTetMesh(m_world.info(), makeBox({0.2, 0.2, 1}, {2, 2, 10}, {-0.1, -0.1, -1}));
        btFemMaterial material;
        material.m_youngModulus = btScalar(young);
        material.m_density = 1000;
        m_world.fem().setMaterial(m_body, material);
        m_world.addSoft(m_body);
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
        {
            m_rest.push_back(m_body->m_nodes[i].m_x);
            if (m_rest[i].z() > btScalar(-1e-4) && holder != Holder::none) m_held.push_back(i);
        }
        for (int i : m_held)
            if (holder == Holder::pins) m_body->setMass(i, 0);
    }

    void prepare()
    {
        m_world.fem().prepare(m_body, btScalar(m_step));
        if (m_holder != Holder::anchors) return;
        m_box = &addKinematicBox(m_world, {0.4, 0.4, 0.2}, at(0, 0, btScalar(0.1)));
        for (int i : m_held) m_body->appendAnchor(i, m_box, true, 1);
    }

    // Leads the held nodes to their places after this displacement.
    void lead(const btVector3& displacement)
    {
        for (int i : m_held)
        {
            if (m_holder == Holder::targets) m_world.fem().setNodeTarget(m_body, i, m_rest[i] + displacement);
            if (m_holder == Holder::pins) m_body->m_nodes[i].m_x = m_rest[i] + displacement;
        }
        if (m_box)
            m_box->getMotionState()->setWorldTransform(btTransform(btQuaternion::getIdentity(), displacement) *
                                                       at(0, 0, btScalar(0.1)));
    }

    void setVelocity(const btVector3& v)
    {
        for (int i = 0; i < m_body->m_nodes.size(); ++i) m_body->m_nodes[i].m_v = v;
    }

    // Bends the bar that is held at its top by a velocity that grows towards its end.
    void bend(const btVector3& tip)
    {
        for (int i = 0; i < m_body->m_nodes.size(); ++i) m_body->m_nodes[i].m_v = tip * m_rest[i].z() * m_rest[i].z();
    }

    void step(int count = 1) { m_world.step(count, btScalar(m_step)); }

    std::vector<btVector3> positions() const
    {
        std::vector<btVector3> x;
        for (int i = 0; i < m_body->m_nodes.size(); ++i) x.push_back(m_body->m_nodes[i].m_x);
        return x;
    }

    // Largest distance of a node from `expected` after `displacement` [m].
    double distanceFrom(const std::vector<btVector3>& expected, const btVector3& displacement = {0, 0, 0}) const
    {
        btScalar largest = 0;
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
            largest = std::max(largest, (m_body->m_nodes[i].m_x - displacement - expected[i]).length());
        return largest;
    }

    static btFemSolverInfo secondOrder()
    {
        btFemSolverInfo info;
        info.m_numericalDamping = 0;
        info.m_tolerance = btScalar(1e-6);
        return info;
    }

    FemWorld m_world;
    const Holder m_holder;
    const double m_step;  // [s]
    btSoftBody* m_body = nullptr;
    btRigidBody* m_box = nullptr;
    std::vector<btVector3> m_rest;
    std::vector<int> m_held;
};

// Holder, coupling, step [s].
class WrittenMotion : public testing::TestWithParam<std::tuple<Holder, Coupling, double>>
{
protected:
    static Holder holder() { return std::get<0>(GetParam()); }
    static HeldBar makeBar(double young = 1e6)
    {
        return HeldBar(holder(), std::get<1>(GetParam()), std::get<2>(GetParam()), young);
    }

    // Distances of bars whose motion should be one [m]: .3 % of the amplitude of their swings, .1 m.
    static constexpr double kSame = 3e-4;
};

// Carries a bar on for a second with 5 m/s, written before its set-up, after it or in a step.
void expectCarried(HeldBar& bar, int stepsBefore)
{
    const btVector3 v(5, 0, 0);
    for (int k = 0; k < stepsBefore; ++k)
    {
        bar.lead({0, 0, 0});
        bar.step();
    }
    bar.setVelocity(v);
    double largest = 0;
    for (int k = 1; k * bar.m_step <= 1; ++k)
    {
        const btVector3 way = v * btScalar(k * bar.m_step);
        bar.lead(way);
        bar.step();
        largest = std::max(largest, bar.distanceFrom(bar.m_rest, way));
    }
    EXPECT_LT(largest, 1e-4);  // single precision leaves 5e-7 of 5 m in every step
}

TEST_P(WrittenMotion, OfAPreparedBodyStrainsNothing)
{
    HeldBar bar = makeBar();
    bar.prepare();
    expectCarried(bar, 0);
}

TEST_P(WrittenMotion, OfABodyAtRestStrainsNothing)
{
    HeldBar bar = makeBar();
    bar.prepare();
    expectCarried(bar, 3);
}

TEST_P(WrittenMotion, OfABodyThatIsNotPreparedStrainsNothing)
{
    HeldBar bar = makeBar();
    if (holder() == Holder::targets || holder() == Holder::anchors) return;  // these need a prepared body
    expectCarried(bar, 0);
}

TEST_P(WrittenMotion, IsTheStateToWhichABodyIsPutBack)
{
    HeldBar bar = makeBar();
    bar.prepare();
    bar.bend({1, 0, 0});
    const int steps = static_cast<int>(0.2 / bar.m_step);
    bar.lead({0, 0, 0});
    bar.step(steps);
    const std::vector<btVector3> x = bar.positions();
    std::vector<btVector3> v;
    for (int i = 0; i < bar.m_body->m_nodes.size(); ++i) v.push_back(bar.m_body->m_nodes[i].m_v);
    bar.step(steps);
    const std::vector<btVector3> later = bar.positions();
    EXPECT_GT(bar.distanceFrom(x), 0.04);
    for (int i = 0; i < bar.m_body->m_nodes.size(); ++i)
    {
        bar.m_body->m_nodes[i].m_x = x[i];
        bar.m_body->m_nodes[i].m_v = v[i];
    }
    bar.step(steps);
    EXPECT_LT(bar.distanceFrom(later), kSame);
}

TEST_P(WrittenMotion, TurnsWithATurnedBody)
{
    if (holder() == Holder::anchors) return;  // the box does not turn
    HeldBar bar = makeBar(), twin = makeBar();
    for (HeldBar* each : {&bar, &twin})
    {
        each->prepare();
        each->bend({1, 0, 0});
        each->lead({0, 0, 0});
        each->step(static_cast<int>(0.2 / each->m_step));
    }
    const btTransform turn(btQuaternion(btVector3(0, 1, 0), btScalar(0.9)), btVector3(1, 2, 3));
    bar.m_body->transform(turn);
    for (int i = 0; i < bar.m_body->m_nodes.size(); ++i)
        bar.m_body->m_nodes[i].m_v = turn.getBasis() * bar.m_body->m_nodes[i].m_v;
    for (int i : bar.m_held)
        if (holder() == Holder::targets) bar.m_world.fem().setNodeTarget(bar.m_body, i, turn * bar.m_rest[i]);
    for (HeldBar* each : {&bar, &twin}) each->step(static_cast<int>(0.2 / each->m_step));
    std::vector<btVector3> expected = twin.positions();
    for (btVector3& x : expected) x = turn * x;
    EXPECT_LT(bar.distanceFrom(expected), kSame);
}

TEST_P(WrittenMotion, GoesOnWhenTheBodyIsAddedAgain)
{
    if (holder() == Holder::anchors) return;  // Bullet's anchors go with their bodies
    HeldBar bar = makeBar(), twin = makeBar();
    for (HeldBar* each : {&bar, &twin})
    {
        each->prepare();
        each->bend({1, 0, 0});
        each->lead({0, 0, 0});
        each->step(static_cast<int>(0.2 / each->m_step));
    }
    bar.m_world.take(*bar.m_body);
    bar.step(10);
    bar.m_world.put(*bar.m_body);
    if (holder() == Holder::targets)  // dropped with the body
    {
        bar.prepare();
        bar.lead({0, 0, 0});
    }
    for (HeldBar* each : {&bar, &twin}) each->step(static_cast<int>(0.2 / each->m_step));
    EXPECT_LT(bar.distanceFrom(twin.positions()), kSame);
}

// The node on the axis keeps its velocity, zero.
TEST_P(WrittenMotion, OfABodyThatTurnsAboutItsNodesStrainsNothing)
{
    if (holder() == Holder::anchors) return;  // the box does not turn
    HeldBar before = makeBar(), after = makeBar();
    const btVector3 spin(btScalar(0.3), btScalar(0.9), btScalar(0.2));
    const auto turn = [&](HeldBar& bar)
    {
        for (int i = 0; i < bar.m_body->m_nodes.size(); ++i) bar.m_body->m_nodes[i].m_v = spin.cross(bar.m_rest[i]);
    };
    turn(before);
    before.prepare();
    after.prepare();
    turn(after);
    for (HeldBar* each : {&before, &after})
        for (int k = 1; k * each->m_step < 0.5; ++k)
        {
            const btQuaternion turned(spin, spin.length() * btScalar(k * each->m_step));
            for (int i : each->m_held)
            {
                const btVector3 x = quatRotate(turned, each->m_rest[i]);
                if (holder() == Holder::targets) each->m_world.fem().setNodeTarget(each->m_body, i, x);
                if (holder() == Holder::pins) each->m_body->m_nodes[i].m_x = x;
            }
            each->step();
        }
    EXPECT_LT(after.distanceFrom(before.positions()), 1e-5);
}

// Stress waves run through the bar several times in a step: its lower half drives the upper one, and goes half the way.
// As a state it would go .75 of the way within the step.
TEST_P(WrittenMotion, OfSomeNodesIsABlow)
{
    HeldBar bar = makeBar(1e8);
    bar.prepare();
    bar.lead({0, 0, 0});
    bar.step(3);
    const btScalar speed = 20;
    for (int i = 0; i < bar.m_body->m_nodes.size(); ++i)
        if (bar.m_rest[i].z() < btScalar(-0.45)) bar.m_body->m_nodes[i].m_v = {0, 0, speed};
    bar.step();
    EXPECT_LT(bar.distanceFrom(bar.m_rest), 0.6 * speed * bar.m_step);
}

INSTANTIATE_TEST_SUITE_P(Bars, WrittenMotion,
                         testing::Combine(testing::Values(Holder::none, Holder::targets, Holder::pins, Holder::anchors),
                                          testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(1.0 / 60, 1.0 / 240)),
                         [](const auto& suite)
                         {
                             return nameOfHolder(std::get<0>(suite.param)) + "_" +
                                    couplingName(std::get<1>(suite.param)) + "_" + nameOfStep(std::get<2>(suite.param));
                         });

}  // namespace
}  // namespace bullet_fem
