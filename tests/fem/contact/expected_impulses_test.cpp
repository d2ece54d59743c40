// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies whose free motion was solved with predicted contact impulses: the prediction changes the work of a step, never
// its result.
#include <gtest/gtest.h>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

// A soft cube under gravity, deformed, falls on a ball; contacts start with an initial guess.
class PredictedImpulses : public testing::Test
{
protected:
    static constexpr double kBallMass = 300;

    struct Scene : ContactScene
    {
        Scene()
        {
            makeBall(m_rigidProxies[0], kBallMass, 0.5);
            m_rigidProxies[0].m_center = {0.6, 0.3, -0.5};
            m_rigidProxies[0].m_linearVelocity = {-0.1, 0.05, 0.2};
            setVelocity({0.1, 0, -0.2});
            BodyState& state = m_body.m_state;
            for (Vec3& x : state.m_x) x.x *= 1 + 0.05 * x.z;
            for (std::size_t i = 0; i < state.m_mass.size(); ++i)
                m_body.m_loads.m_force[i] = {0, 0, -9.81 * state.m_mass[i]};
            touchLowerFace(0, 0.5);
            for (ContactPoint& contact : m_contacts) contact.m_impulse = {2, -1, 15};
            for (ContactPoint& contact : m_contacts) contact.m_point.z -= 0.01;  // a lever arm
        }
    };

    static std::vector<Vec3> nodeImpulses(const Scene& scene)
    {
        std::vector<Vec3> sum(scene.m_body.m_state.m_x.size());
        for (const ContactPoint& contact : scene.m_contacts) sum[contact.m_soft.m_nodes[0]] += contact.m_impulse;
        return sum;
    }

    static SolveReport solveExpecting(Scene& scene, const std::vector<Vec3>& expected, double floor)
    {
        FreeMotion motion;
        motion.m_body = &scene.m_body;
        motion.m_settings = scene.m_settings.m_step;
        motion.m_predicted = &expected;
        motion.m_predictedFloor = floor;
        solveFreeMotions(&motion, 1);
        return motion.m_report;
    }

    // `loosely`: factor of the free motion's tolerance over that of contact.
    static void solveContactExpecting(Scene& scene, const std::vector<Vec3>& expected, double loosely = 1)
    {
        const StepSettings step = scene.m_settings.m_step;
        scene.m_settings.m_step.m_tolerance *= loosely;
        solveExpecting(scene, expected, residualFloor(scene.m_settings.m_tolerance, step.m_tolerance));
        scene.m_settings.m_step = step;
        scene.m_problem.m_bodies = {{&scene.m_body, scene.m_cache.get(), &expected}};
        scene.m_solver.solve(scene.m_problem, scene.m_settings);
    }

    static void expectSameAnswer(const Scene& scene, const Scene& reference)
    {
        for (std::size_t i = 0; i < velocity(scene.m_body).size(); ++i)
            EXPECT_LT(norm(velocity(scene.m_body)[i] - velocity(reference.m_body)[i]), 1e-5) << i;
        const double impulse = norm(reference.totalImpulse());
        EXPECT_LT(norm(scene.totalImpulse() - reference.totalImpulse()), 1e-5 * impulse);
        EXPECT_LT(norm(scene.m_rigidProxies[0].m_linearVelocity - reference.m_rigidProxies[0].m_linearVelocity), 1e-5);
    }

    // Momenta of cube and ball about the origin, minus the impulse of gravity on the cube.
    static std::pair<Vec3, Vec3> momentum(const Scene& scene, const std::vector<Vec3>& v, double step)
    {
        const BodyState& s = scene.m_body.m_state;
        Vec3 linear, angular;
        for (std::size_t i = 0; i < v.size(); ++i)
        {
            const Vec3 p = s.m_mass[i] * v[i] - step * scene.m_body.m_loads.m_force[i];
            linear += p;
            angular += cross(s.m_x[i], p);
        }
        const RigidProxy& ball = scene.m_rigidProxies[0];
        linear += kBallMass * ball.m_linearVelocity;
        angular += cross(ball.m_center, kBallMass * ball.m_linearVelocity) + 0.1 * kBallMass * ball.m_angularVelocity;
        return {linear, angular};
    }

    static void expectMomentumKept(Scene& scene, const std::vector<Vec3>& expected)
    {
        scene.m_settings.m_step.m_tolerance = 1e-3;
        scene.m_settings.m_tolerance = 1e-2;
        scene.m_settings.m_rounds = 1;
        const auto before = momentum(scene, scene.m_body.m_state.m_v, 0);
        solveContactExpecting(scene, expected);
        const auto after = momentum(scene, velocity(scene.m_body), scene.m_settings.m_step.m_step);
        const double size = scene.softMass() * 0.2 + 9 * 15;
        EXPECT_LE(norm(after.first - before.first), 1e-12 * size);
        EXPECT_LE(norm(after.second - before.second), 1e-12 * size);
    }
};

TEST_F(PredictedImpulses, ChangeNothingIfCorrect)
{
    Scene scene, reference;
    reference.solve();
    solveContactExpecting(scene, nodeImpulses(scene));
    expectSameAnswer(scene, reference);
}

TEST_F(PredictedImpulses, LeaveTheirResidualToContact)
{
    Scene scene, reference;
    reference.solve();
    solveContactExpecting(scene, nodeImpulses(scene), 1e7);
    expectSameAnswer(scene, reference);
}

TEST_F(PredictedImpulses, ChangeNothingIfWrong)
{
    Scene scene, reference;
    reference.solve();
    std::vector<Vec3> expected(scene.m_body.m_state.m_x.size());
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = {3, double(i % 5), 10};
    solveContactExpecting(scene, expected);
    expectSameAnswer(scene, reference);
}

TEST_F(PredictedImpulses, PreserveTheMomentumOfTheActualImpulses)
{
    Scene right, wrong;
    expectMomentumKept(right, nodeImpulses(right));
    std::vector<Vec3> expected = nodeImpulses(wrong);
    for (Vec3& impulse : expected) impulse = 1.01 * impulse + Vec3{1e-3, 0, 0};
    expectMomentumKept(wrong, expected);
}

// Also if no further solve is needed.
TEST_F(PredictedImpulses, PreserveMomentumIfTheGuessIsTheSolution)
{
    Scene scene;
    scene.m_settings.m_maxRounds = 1;
    std::vector<Vec3> expected = nodeImpulses(scene);
    for (Vec3& impulse : expected) impulse *= 1.0001;
    expectMomentumKept(scene, expected);
    EXPECT_EQ(scene.m_contacts[0].m_impulse.z, 15);
}

TEST_F(PredictedImpulses, AreTakenBackWithoutContact)
{
    Scene scene, reference;
    const std::vector<Vec3> expected = nodeImpulses(scene);
    scene.m_contacts.clear();
    solveFreeMotion(reference.m_body, reference.m_settings.m_step);
    const auto before = momentum(scene, scene.m_body.m_state.m_v, 0);
    solveContactExpecting(scene, expected);
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT(norm(velocity(scene.m_body)[i] - velocity(reference.m_body)[i]), 1e-6) << i;
    const auto after = momentum(scene, velocity(scene.m_body), scene.m_settings.m_step.m_step);
    EXPECT_LE(norm(after.first - before.first), 1e-12 * scene.softMass());
}

// The residual is measured against the impulses: almost nothing remains to be solved.
TEST_F(PredictedImpulses, LeaveNothingToSolveIfTheyBalanceTheLoads)
{
    Scene scene;
    scene.m_body.m_state.m_x = scene.m_body.m_model->mesh().restPositions();
    scene.setVelocity({});
    std::vector<Vec3> expected;
    for (const Vec3& force : scene.m_body.m_loads.m_force)
        expected.push_back((expected.size() % 2 == 0 ? -1 - 1e-5 : -1 + 1e-5) * scene.m_settings.m_step.m_step * force);
    scene.m_settings.m_step.m_tolerance = 1e-3;
    const SolveReport report = solveExpecting(scene, expected, 1);
    EXPECT_EQ(report.m_iterations, 0);
    EXPECT_LE(report.m_residual, 2e-5);
    for (const Vec3& v : velocity(scene.m_body)) EXPECT_LT(norm(v), 1e-5);
    // With a tolerance far below them the remainder counts.
    EXPECT_GT(solveExpecting(scene, expected, 1e-3).m_iterations, 0);
}

}  // namespace
}  // namespace bullet_fem
