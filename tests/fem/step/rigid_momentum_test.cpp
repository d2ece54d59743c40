// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/rigid_momentum.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fem/scenes/elasticity_scenes.h"
#include "fem/solve/drift.h"

namespace bullet_fem
{
namespace
{

constexpr double kStep = 1.0 / 50;

// Prescribes the momenta of an implicit Euler step: levers are measured from the present positions.
void prescribe(RigidMomentum& momentum, Body& body)
{
    beginDrift(body, StepSettings());
    momentum.prescribe(body, kStep);
}

// Linear and angular momentum about a point, with the magnitudes that rounding is measured against.
struct Momentum
{
    Vec3 m_linear, m_angular;
    double m_linearSize = 0, m_angularSize = 0;

    void add(const Vec3& arm, const Vec3& p)
    {
        m_linear += p;
        m_angular += cross(arm, p);
        m_linearSize += norm(p);
        m_angularSize += norm(arm) * norm(p);
    }
};

void expectSame(const Momentum& got, const Momentum& expected, double tolerance)
{
    EXPECT_LE(norm(got.m_linear - expected.m_linear), tolerance * (got.m_linearSize + expected.m_linearSize));
    EXPECT_LE(norm(got.m_angular - expected.m_angular), tolerance * (got.m_angularSize + expected.m_angularSize));
}

TetMesh twoBoxes()
{
    const TetMesh a = makeBox({1, 1, 1}, {2, 2, 2}), b = makeBox({1, 0.5, 0.5}, {2, 1, 1}, {5, 0, 0});
    std::vector<Vec3> X = a.restPositions();
    X.insert(X.end(), b.restPositions().begin(), b.restPositions().end());
    std::vector<Tet> tets = a.tets();
    for (Tet tet : b.tets())
    {
        for (int& node : tet) node += a.nodeCount();
        tets.push_back(tet);
    }
    return TetMesh(X, tets);
}

// Two components far from the origin, damped, with random velocities and loads.
class RigidMomentumTest : public testing::Test
{
protected:
    RigidMomentumTest()
    {
        RandomVectors random(6);
        for (std::size_t i = 0; i < m_velocity.size(); ++i)
        {
            m_body.m_state.m_x[i] += Vec3{10, -20, 30} + 0.1 * random.next();
            m_body.m_state.m_v[i] = random.next();
            m_body.m_state.m_mass[i] *= 1.5 + random.next().x;
            m_body.m_loads.m_force[i] = 100 * random.next();
            m_velocity[i] = random.next();
            m_impulses[i] = random.next();
        }
        m_body.m_loads.m_massDamping = 0.3;
    }

    static Body makeDampedBody()
    {
        Material material;
        material.m_massDamping = 0.5;
        return makeBody(twoBoxes(), material);
    }

    Vec3 center(int piece) const
    {
        Vec3 sum;
        double mass = 0;
        for (std::size_t i = 0; i < m_velocity.size(); ++i)
            if (m_component[i] == piece)
            {
                sum += m_body.m_state.m_mass[i] * m_body.m_state.m_x[i];
                mass += m_body.m_state.m_mass[i];
            }
        return (1 / mass) * sum;
    }

    // Momenta of a component with node momenta p(i).
    template <typename NodeMomentum>
    Momentum momentum(int piece, NodeMomentum p) const
    {
        Momentum result;
        for (std::size_t i = 0; i < m_velocity.size(); ++i)
            if (m_component[i] == piece) result.add(m_body.m_state.m_x[i] - center(piece), p(i));
        return result;
    }

    Momentum restored(int piece) const
    {
        return momentum(piece, [&](std::size_t i) { return m_body.m_state.m_mass[i] * m_velocity[i]; });
    }

    // (1 + h alpha) p' = p + h F + `impulses` J, alpha = 0.5 + 0.3.
    Momentum prescribed(int piece, double impulses) const
    {
        return momentum(piece,
                        [&](std::size_t i)
                        {
                            const Vec3 p = m_body.m_state.m_mass[i] * m_body.m_state.m_v[i];
                            return (1 / (1 + kStep * 0.8)) *
                                   (p + kStep * m_body.m_loads.m_force[i] + impulses * m_impulses[i]);
                        });
    }

    Body m_body = makeDampedBody();
    const std::vector<int> m_component = m_body.m_model->mesh().nodeComponent();
    std::vector<Vec3> m_velocity = std::vector<Vec3>(m_component.size());
    std::vector<Vec3> m_impulses = m_velocity;
    RigidMomentum m_momentum{m_body.m_model->mesh()};
};

TEST_F(RigidMomentumTest, RestoresThePrescribedMomentumOfEveryComponent)
{
    ASSERT_EQ(m_body.m_model->mesh().componentCount(), 2);
    prescribe(m_momentum, m_body);
    m_momentum.restore(m_body, m_velocity);
    expectSame(restored(0), prescribed(0, 0), 1e-14);
    expectSame(restored(1), prescribed(1, 0), 1e-14);
}

TEST_F(RigidMomentumTest, AddsImpulses)
{
    prescribe(m_momentum, m_body);
    m_momentum.addImpulses(m_body, m_impulses, kStep);
    m_momentum.addImpulses(m_body, m_impulses, kStep);
    m_momentum.restore(m_body, m_velocity);
    expectSame(restored(0), prescribed(0, 2), 1e-14);
    expectSame(restored(1), prescribed(1, 2), 1e-14);
}

// The correction is the six rigid motions alone: v' - v = a + w x (x - c).
TEST_F(RigidMomentumTest, AddsARigidMotionAlone)
{
    const std::vector<Vec3> before = m_velocity;
    prescribe(m_momentum, m_body);
    m_momentum.restore(m_body, m_velocity);
    const std::vector<Vec3>& x = m_body.m_state.m_x;
    for (const Tet& tet : m_body.m_model->mesh().tets())
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b)
            {
                const Vec3 edge = x[tet[a]] - x[tet[b]];
                const Vec3 change = (m_velocity[tet[a]] - before[tet[a]]) - (m_velocity[tet[b]] - before[tet[b]]);
                EXPECT_NEAR(dot(edge, change), 0, 1e-13);  // no edge changes its length
            }
    EXPECT_GT(largestDistance(before, m_velocity), 0.01);
}

TEST_F(RigidMomentumTest, HasNothingToAddTheSecondTime)
{
    prescribe(m_momentum, m_body);
    m_momentum.restore(m_body, m_velocity);
    const std::vector<Vec3> once = m_velocity;
    m_momentum.restore(m_body, m_velocity);
    EXPECT_LE(largestDistance(once, m_velocity), 1e-13);
}

TEST_F(RigidMomentumTest, LeavesAClampedComponentAlone)
{
    const int fixedPiece = m_component[0];
    for (const int node : {0, 1, 3}) m_body.m_state.m_fixed[static_cast<std::size_t>(node)] = 1;
    const std::vector<Vec3> before = m_velocity;
    prescribe(m_momentum, m_body);
    m_momentum.addImpulses(m_body, m_impulses, kStep);
    m_momentum.restore(m_body, m_velocity);
    std::vector<int> changed(2);
    for (std::size_t i = 0; i < before.size(); ++i) changed[m_component[i]] += norm(before[i] - m_velocity[i]) > 0;
    EXPECT_EQ(changed[fixedPiece], 0);
    EXPECT_GT(changed[1 - fixedPiece], 0);
    expectSame(restored(1 - fixedPiece), prescribed(1 - fixedPiece, 1), 1e-14);
}

// A component with fixed nodes, those of one edge of its box or a single node, which move with a velocity.
class HungComponent : public RigidMomentumTest
{
protected:
    // Box 0's nodes on the edge along x, before positions are randomised.
    void hang(int nodes)
    {
        const std::vector<Vec3>& X = m_body.m_model->mesh().restPositions();
        for (std::size_t i = 0; i < X.size() && nodes > 0; ++i)
        {
            if (X[i].y != 0 || X[i].z != 0 || m_component[i] != 0) continue;
            m_body.m_state.m_x[i] = X[i] + kPin;
            m_body.m_state.m_fixed[i] = 1;
            m_body.m_loads.m_targetVelocity[i] = kCarried;
            m_velocity[i] = kCarried;
            m_impulses[i] = {};
            --nodes;
        }
        ASSERT_EQ(nodes, 0);
    }

    // Momentum about the pin minus that of the pin's own motion, after impulses.
    Vec3 momentumAfterImpulses()
    {
        prescribe(m_momentum, m_body);
        m_momentum.addImpulses(m_body, m_impulses, kStep);
        const std::vector<Vec3> before = m_velocity;
        m_momentum.restore(m_body, m_velocity);
        for (std::size_t i = 0; i < before.size(); ++i)
        {
            if (m_component[i] != 0) continue;
            const bool isMoved = norm(m_velocity[i] - before[i]) > 0;
            m_pinsMoved = m_pinsMoved || (m_body.m_state.m_fixed[i] && isMoved);
            m_anyMoved = m_anyMoved || isMoved;
        }
        return aboutPin([this](std::size_t i) { return m_velocity[i]; });
    }
    Vec3 expected() const
    {
        return aboutPin(
            [this](std::size_t i)
            {
                const Vec3 impulse = kStep * m_body.m_loads.m_force[i] + m_impulses[i];
                return (1 / (1 + kStep * 0.8)) * (m_body.m_state.m_v[i] + (1 / m_body.m_state.m_mass[i]) * impulse);
            });
    }

    static constexpr Vec3 kPin{10, -20, 30}, kCarried{3, 1, -2};
    bool m_pinsMoved = false, m_anyMoved = false;

private:
    template <class Velocity>
    Vec3 aboutPin(const Velocity& v) const
    {
        Vec3 sum;
        for (std::size_t i = 0; i < m_velocity.size(); ++i)
            if (m_component[i] == 0)
                sum += cross(m_body.m_state.m_x[i] - kPin, m_body.m_state.m_mass[i] * (v(i) - kCarried));
        return sum;
    }
};

TEST_F(HungComponent, GetsTheAngularMomentumAboutItsPin)
{
    hang(1);
    const Vec3 got = momentumAfterImpulses();
    EXPECT_FALSE(m_pinsMoved);
    EXPECT_LE(norm(got - expected()), 1e-11 * norm(expected()));
}

TEST_F(HungComponent, GetsTheAngularMomentumAboutItsHinge)
{
    hang(3);
    const Vec3 got = momentumAfterImpulses();
    EXPECT_FALSE(m_pinsMoved);
    EXPECT_NEAR(got.x, expected().x, 1e-11 * norm(expected()));
    EXPECT_GT(norm(got - expected()), 0.1 * norm(expected()));  // the hinge bears the rest
}

TEST_F(HungComponent, IsClampedByANodeBesideItsHinge)
{
    hang(3);
    const std::vector<Vec3>& X = m_body.m_model->mesh().restPositions();
    const auto beside = std::find_if(X.begin(), X.end(), [](const Vec3& x) { return x.x == 0 && x.z == 1; });
    const std::size_t node = static_cast<std::size_t>(beside - X.begin());
    m_body.m_state.m_fixed[node] = 1;
    m_body.m_loads.m_targetVelocity[node] = kCarried;
    momentumAfterImpulses();
    EXPECT_FALSE(m_anyMoved);
}

TEST_F(HungComponent, IsClampedByATurningHinge)
{
    hang(3);
    m_body.m_loads.m_targetVelocity[0] += Vec3{0, 0.1, 0};
    momentumAfterImpulses();
    EXPECT_FALSE(m_anyMoved);
}

// Random velocities and loads are of order one, and so is the result, for any rounding of the inertia.
TEST_F(RigidMomentumTest, StaysBoundedForABodyCollapsedToAPoint)
{
    m_body.m_state.m_x.assign(m_velocity.size(), {1, 2, 3});
    prescribe(m_momentum, m_body);
    m_momentum.restore(m_body, m_velocity);
    for (const Vec3& v : m_velocity) EXPECT_LT(norm(v), 10);
}

// There is no inertia about the line; across it momentum is restored to the accuracy of inverting a tensor of condition
// 1e14.
TEST_F(RigidMomentumTest, RestoresTheMomentumOfABodyCollapsedToALine)
{
    const Vec3 axis = {0.6, 0, 0.8};
    for (Vec3& x : m_body.m_state.m_x) x = dot(x, axis) * axis;
    prescribe(m_momentum, m_body);
    m_momentum.restore(m_body, m_velocity);
    for (const Vec3& v : m_velocity) EXPECT_LT(norm(v), 10);
    expectSame(restored(0), prescribed(0, 0), 1e-2);
}

TEST_F(RigidMomentumTest, RestoresABodyCollapsedToAPlane)
{
    for (Vec3& x : m_body.m_state.m_x) x.y = 7;
    prescribe(m_momentum, m_body);
    m_momentum.restore(m_body, m_velocity);
    expectSame(restored(0), prescribed(0, 0), 1e-14);
}

}  // namespace
}  // namespace bullet_fem
