// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies without a regular inertia, and motions that no step can follow, stay finite.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "fem/scenes/free_bodies.h"

namespace bullet_fem
{
namespace
{

class ExtremeMotion : public testing::TestWithParam<double>  // numerical damping
{
protected:
    ExtremeMotion() { m_settings.m_numericalDamping = GetParam(); }

    static TetMesh oneElement()
    {
        return TetMesh({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}}, {Tet{0, 1, 2, 3}});
    }

    // Makes steps with impulses on every node, as the plug-in does: a step that is not finite is abandoned.
    void run(Body& body, int steps, double impulse = 0)
    {
        RandomVectors random(4);
        std::vector<Vec3> impulses(body.m_state.m_x.size());
        for (int k = 0; k < steps; ++k)
        {
            solveFreeMotion(body, m_settings);
            for (std::size_t i = 0; i < impulses.size(); ++i)
                impulses[i] = impulse * body.m_state.m_mass[i] * random.next();
            if (impulse > 0) applyImpulses(body, impulses, m_settings);
            if (impulse > 0) applyPositionCorrection(body, impulses, m_settings);
            if (canFinishStep(body))
                finishStep(body, m_settings);
            else
            {
                abandonStep(body);
                ++m_abandoned;
            }
            ASSERT_TRUE(isFiniteBody(body)) << "step " << k;
        }
    }

    static bool isFiniteBody(const Body& body)
    {
        const BodyState& s = body.m_state;
        bool result = true;
        for (std::size_t i = 0; i < s.m_x.size(); ++i) result = result && isFinite(s.m_x[i]) && isFinite(s.m_v[i]);
        return result;
    }

    // Greatest node speed [m/s].
    static double fastest(const Body& body)
    {
        double speed = 0;
        for (const Vec3& v : body.m_state.m_v) speed = std::max(speed, norm(v));
        return speed;
    }

    StepSettings m_settings;
    int m_abandoned = 0;
};

TEST_P(ExtremeMotion, OneElementSpinsAndStaysFinite)
{
    for (const double young : {1e3, 1e6, 1e9})
    {
        Body body = makeBody(oneElement(), barMaterial(young));
        spin(body, {5, 20, -10});
        body.m_state.m_x[3] += Vec3{0.01, 0.01, 0.02};
        const double start = mechanicalEnergy(body);
        run(body, 600);
        EXPECT_EQ(m_abandoned, 0) << young;
        EXPECT_LT(mechanicalEnergy(body), 1.01 * start) << young;
    }
}

TEST_P(ExtremeMotion, OneElementBearsImpulses)
{
    Body body = makeBody(oneElement(), barMaterial(1e6));
    run(body, 200, 1);
    EXPECT_EQ(m_abandoned, 0);
    EXPECT_LT(fastest(body), 100);  // a random walk of 200 steps of some 1 m/s
}

// Positions in a plane, on a line or at a point have a singular inertia or none.
TEST_P(ExtremeMotion, CollapsedBodiesStayFinite)
{
    for (int rank = 0; rank < 3; ++rank)
        for (const Vec3& omega : {Vec3{}, Vec3{10, 0, 0}, Vec3{4, 7, -9}})
        {
            Body body = makeBody(makeFreeBar({6, 2, 2}), barMaterial(1e6));
            for (Vec3& x : body.m_state.m_x) x = {rank > 0 ? x.x : 0, rank > 1 ? x.y : 0, 0};
            rotate(body, rotationAbout({3, 2, -1}, 0.37));
            spin(body, omega);
            RandomVectors random(2);
            for (Vec3& v : body.m_state.m_v) v += 0.1 * random.next();
            run(body, 60, 0.1);
            EXPECT_EQ(m_abandoned, 0) << rank;
            EXPECT_LT(fastest(body), 1e3) << rank;  // sqrt(E / rho) is 32 m/s
        }
}

// Random velocities on the nodes of a body without extent have an angular momentum that no spin can have.
TEST_P(ExtremeMotion, AlmostCollapsedBodiesStayFinite)
{
    for (const double share : {1e-3, 1e-6, 1e-9, 1e-12})
        for (int rank = 0; rank < 3; ++rank)
        {
            Body body = makeBody(makeFreeBar({6, 2, 2}), barMaterial(1e6));
            for (Vec3& x : body.m_state.m_x)
                x = {rank > 0 ? x.x : share * x.x, rank > 1 ? x.y : share * x.y, share * x.z};
            RandomVectors random(2);
            for (Vec3& v : body.m_state.m_v) v += 0.1 * random.next();
            run(body, 60, 0.1);
        }
}

// Spins from a turn to 10^4 turns a step.
TEST_P(ExtremeMotion, SpinsOfMoreThanATurnStayFinite)
{
    for (const double angle : {3.0, 6.3, 7.0, 30.0, 600.0, 6e4})
        for (const double young : {1e4, 1e9})
            for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6, 0.8, 0.01}})
            {
                Body body = makeBody(makeFreeBar({6, 2, 2}), barMaterial(young));
                spin(body, angle / m_settings.m_step * axis);
                run(body, 60);
                run(body, 10, 1);
            }
}

// Masses of 1e-12 of the usual, of the body or of single nodes.
TEST_P(ExtremeMotion, TinyMassesStayFinite)
{
    for (const double density : {1e-9, 1e-6})
    {
        Material material = barMaterial(1e6);
        material.m_density = density;
        Body body = makeBody(makeFreeBar({6, 2, 2}), material);
        bend(body, 1);
        spin(body, {3, 5, 20});
        run(body, 60);
        run(body, 60, 1);
        EXPECT_EQ(m_abandoned, 0) << density;
        EXPECT_LT(fastest(body), 1e3) << density;
    }
    for (const double share : {1e-12, 1e12})
    {
        Body body = makeBody(makeFreeBar({6, 2, 2}), barMaterial(1e6));
        for (std::size_t i = 0; i < body.m_state.m_mass.size(); i += 9) body.m_state.m_mass[i] *= share;
        bend(body, 1);
        spin(body, {3, 5, 20});
        run(body, 60);
        EXPECT_LT(fastest(body), 1e3) << share;
    }
}

// Momenta that are not finite reach neither positions nor velocities.
TEST_P(ExtremeMotion, LoadsThatAreNotFiniteAreNotKept)
{
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300})
    {
        Body body = makeBody(makeFreeBar({6, 2, 2}), barMaterial(1e6));
        spin(body, {0, 0, 20});
        body.m_loads.m_force[3] = {0, bad, 0};
        m_abandoned = 0;
        run(body, 2);
        EXPECT_EQ(m_abandoned, 2) << bad;
    }
}

INSTANTIATE_TEST_SUITE_P(Steps, ExtremeMotion, testing::Values(0, 1),
                         [](const auto& suite) { return nameOfDamping(suite.param); });

}  // namespace
}  // namespace bullet_fem
