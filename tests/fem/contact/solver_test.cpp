// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact/contact_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"
#include "fem/scenes/dense_system.h"

namespace bullet_fem
{
namespace
{

constexpr double kGravity = 9.81;

// Outer iterations correct W with the true system, from 1e-6 in single precision: velocities are far more accurate than
// that.
constexpr double kSolved = 1e-6;

// --- Normal impulses ---

// Signorini's law: no approach beyond the gap, no tensile impulse, and an impulse only if the gap closes.
TEST(Contact, HoldsADroppingBody)
{
    ContactScene scene;
    scene.setVelocity({0, 0, -2});
    setGravity(scene.m_body, {0, 0, -kGravity});
    scene.touchLowerFace(0, 0);
    const ContactReport report = scene.solve();
    EXPECT_TRUE(report.m_converged);
    EXPECT_EQ(report.m_contacts, 9);
    EXPECT_GT(report.m_iterations, 0);
    for (const ContactPoint& contact : scene.m_contacts)
    {
        EXPECT_GT(contact.m_impulse.z, 0);
        EXPECT_NEAR(scene.relativeVelocity(contact).z, 0, kSolved);
    }
    const double m = scene.softMass(), h = scene.m_settings.m_step.m_step;
    finishStep(scene.m_body, scene.m_settings.m_step);
    const Vec3 expected = scene.totalImpulse() + Vec3{0, 0, -m * (2 + h * kGravity)};
    EXPECT_LE(norm(linearMomentum(scene.m_body.m_state) - expected), 1e-12 * m * 2);
}

// A stiff body stops within one step: J = m (v + g h), with an error of rho L^2 / (E h^2) = 4e-4.
TEST(Contact, TakesTheWholeMomentumOfAStiffBody)
{
    ContactScene scene(1e10);
    scene.setVelocity({0, 0, -2});
    setGravity(scene.m_body, {0, 0, -kGravity});
    scene.touchLowerFace(0, 0);
    scene.solve();
    const double expected = scene.softMass() * (2 + kGravity / 60);
    EXPECT_NEAR(scene.totalImpulse().z, expected, 1e-3 * expected);
}

// The oracle: lambda = -(n . v) / (n . A^-1 n), where A = A0 at rest.
TEST(Contact, NodeImpulseMatchesHandCalculation)
{
    ContactScene scene;
    scene.setVelocity({0, 0, -2});
    scene.touchNode(4, 0, 0);  // the face's centre
    scene.solve();
    const BodyModel& model = *scene.m_body.m_model;
    const Eigen::MatrixXd A0 = denseRestSystem(model.shape(), model.factorInput());
    const double compliance = A0.llt().solve(Eigen::VectorXd::Unit(A0.rows(), 3 * 4 + 2))(3 * 4 + 2);
    EXPECT_NEAR(scene.m_contacts[0].m_impulse.z, 2 / compliance, kSolved * 2 / compliance);
    EXPECT_EQ(scene.m_contacts[0].m_impulse.x, 0);
    EXPECT_EQ(scene.m_contacts[0].m_impulse.y, 0);
}

TEST(Contact, StopsThePointOfAFace)
{
    ContactScene scene;
    scene.setVelocity({0, 0, -2});
    ContactPoint contact;
    contact.m_rigidProxy = 0;
    contact.m_soft = {0, {0, 1, 4}, {0.2, 0.3, 0.5}};
    for (int a = 0; a < 3; ++a)
        contact.m_point += contact.m_soft.m_weights[a] * scene.m_body.m_state.m_x[contact.m_soft.m_nodes[a]];
    contact.m_normal = {0, 0, 1};
    scene.m_contacts = {contact};
    scene.solve();
    EXPECT_GT(scene.m_contacts[0].m_impulse.z, 0);
    EXPECT_NEAR(scene.relativeVelocity(scene.m_contacts[0]).z, 0, kSolved);
}

// A point inside the body, if the cache has its nodes: the solver uses the point's own compliance, and there is no
// moment about it.
TEST(Contact, ActsAtAPointOfThreeElements)
{
    ContactScene scene;
    const Body& body = scene.m_body;
    std::vector<int> all(body.m_model->nodeCount());
    std::iota(all.begin(), all.end(), 0);
    scene.m_cache = makeComplianceCache(body.m_model, all);
    scene.setVelocity({0.5, 0, -2});
    ContactPoint contact;
    contact.m_rigidProxy = 0;
    contact.m_soft.m_body = 0;
    contact.m_soft.m_count = SurfacePoint::kMaxNodes;
    for (int a = 0; a < SurfacePoint::kMaxNodes; ++a)
    {
        contact.m_soft.m_nodes[a] = 2 * a;  // node 13, the middle of the cube, is excluded
        contact.m_soft.m_weights[a] = (a + 1) / 78.0;
    }
    contact.m_point = contact.m_soft.of(body.m_state.m_x);
    contact.m_normal = {0, 0, 1};
    contact.m_friction = 0.3;
    scene.m_contacts = {contact};
    const Vec3 linear = linearMomentum(body.m_state), angular = angularMomentum(body.m_state);
    scene.solve();
    const Vec3 impulse = scene.m_contacts[0].m_impulse;
    EXPECT_GT(impulse.z, 0);
    EXPECT_LT(impulse.x, 0);
    EXPECT_NEAR(scene.m_contacts[0].m_soft.of(velocity(body)).z, 0, kSolved);
    finishStep(scene.m_body, scene.m_settings.m_step);
    EXPECT_LT(norm(linearMomentum(body.m_state) - linear - impulse), 1e-8 * norm(impulse));
    EXPECT_LT(norm(angularMomentum(body.m_state) - angular - cross(contact.m_point, impulse)), 1e-8 * norm(impulse));
}

TEST(Contact, NeverPulls)
{
    ContactScene scene;
    scene.setVelocity({0, 0, 2});
    scene.touchLowerFace(0, 0.5);
    scene.solve();
    for (const ContactPoint& contact : scene.m_contacts) EXPECT_EQ(norm(contact.m_impulse), 0);
    for (const Vec3& v : velocity(scene.m_body)) EXPECT_LE(norm(v - Vec3{0, 0, 2}), 1e-14);
}

// Rows of other solvers, such as those between rigid bodies, are swept alternately with these until both converge or
// stagnate.
TEST(Contact, IsSweptAsLongAsOthersMove)
{
    constexpr int kMany = 1000;
    ContactScene scene;
    scene.setVelocity({0, 0, -2});
    scene.touchLowerFace(0, 0.5);
    scene.m_problem.m_bodies = {{&scene.m_body, scene.m_cache.get()}};
    solveFreeMotion(scene.m_body, scene.m_settings.m_step);
    scene.m_solver.begin(scene.m_problem, scene.m_settings);
    const auto sweepsUntilDone = [&](auto others)
    {
        int sweeps = 1;
        while (scene.m_solver.sweep(others(sweeps)) && sweeps < kMany) ++sweeps;
        scene.m_solver.correct();
        return sweeps;
    };
    const int alone = sweepsUntilDone([](int) { return 0.0; });
    EXPECT_LT(alone, kMany);
    EXPECT_EQ(sweepsUntilDone([](int) { return 1e-7; }), 1) << "other rows change by less than rounding";
    const auto slowing = [](int sweep) { return std::pow(0.7, sweep); };  // [m/s]
    const int last = sweepsUntilDone(slowing);
    EXPECT_LE(slowing(last), 2 * scene.m_settings.m_tolerance) << "of a velocity change of 2 m/s";
    EXPECT_GT(slowing(last - 1), 2 * scene.m_settings.m_tolerance);
    EXPECT_EQ(sweepsUntilDone([](int) { return 1.0; }), 20) << "ten more sweeps are no improvement";
}

TEST(Contact, HasNoEffectOutOfReach)
{
    ContactScene scene, alone;
    for (ContactScene* each : {&scene, &alone}) each->setVelocity({1, 0, -2});
    scene.touchLowerFace(2.0 / 60 + 1e-6, 0.5);  // the gap stays open by a little in this step
    const ContactReport report = scene.solve();
    alone.solve();
    for (const ContactPoint& contact : scene.m_contacts) EXPECT_EQ(norm(contact.m_impulse), 0);
    EXPECT_EQ(largestDistance(velocity(scene.m_body), velocity(alone.m_body)), 0);
    EXPECT_EQ(report.m_iterations, 0);
}

// The body reaches the surface exactly at the end of the step.
TEST(Contact, LetsTheGapCloseWithinTheStep)
{
    ContactScene scene;
    scene.setVelocity({0, 0, -2});
    scene.touchLowerFace(0.02, 0);
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);
    for (int node = 0; node < 9; ++node) EXPECT_NEAR(scene.m_body.m_state.m_x[node].z, -0.02, kSolved / 60);
}

TEST(Contact, ReportsNothingWithoutContacts)
{
    ContactScene scene;
    scene.m_rigidProxies[0].m_pushLinear = {1, 2, 3};
    const ContactReport report = scene.solve();
    EXPECT_EQ(report.m_contacts, 0);
    EXPECT_EQ(report.m_sweeps, 0);
    EXPECT_EQ(report.m_iterations, 0);
    EXPECT_TRUE(report.m_converged);
    EXPECT_EQ(norm(scene.m_rigidProxies[0].m_pushLinear), 0);
}

// --- Moving obstacles ---

TEST(Contact, FollowsAnObstacleThatRisesDuringTheStep)
{
    ContactScene scene;
    scene.m_rigidProxies[0].m_linearVelocity = {0, 0, 1};
    scene.touchLowerFace(0, 0);
    scene.solve();
    for (int node = 0; node < 9; ++node) EXPECT_NEAR(velocity(scene.m_body)[node].z, 1, kSolved);
}

TEST(Contact, SticksToAConveyorAndToATurntable)
{
    ContactScene scene;
    scene.m_rigidProxies[0].m_linearVelocity = {1, 0, 0};
    scene.m_rigidProxies[0].m_angularVelocity = {0, 0, 2};
    scene.setVelocity({0, 0, -1});
    scene.touchLowerFace(0, 100);
    scene.solve();
    const Vec3 spin = scene.m_rigidProxies[0].m_angularVelocity;
    const double h = scene.m_settings.m_step.m_step;
    for (const ContactPoint& contact : scene.m_contacts)
    {
        const Vec3 arc = 0.5 * h * cross(spin, cross(spin, contact.m_point - scene.m_rigidProxies[0].m_center));
        EXPECT_LE(norm(scene.relativeVelocity(contact) - arc), 1e-5);
    }
    EXPECT_NEAR(velocity(scene.m_body)[0].x, 1, 1e-5);
    EXPECT_NEAR(velocity(scene.m_body)[2].y, 2, 1e-5);  // at (1, 0, 0): 1 + 2 x (1, 0, 0), minus the arc
}

// --- Several bodies, warm starts, limits ---

TEST(Contacts, SeveralBodiesAreIndependent)
{
    ContactScene a, quiet, b;
    a.setVelocity({0, 0, -2});
    b.setVelocity({3, 0, -1});
    a.touchLowerFace(0, 0.2);
    b.touchLowerFace(0, 0.4);
    ContactProblem problem;
    problem.m_bodies = {
        {&a.m_body, a.m_cache.get()}, {&quiet.m_body, quiet.m_cache.get()}, {&b.m_body, b.m_cache.get()}};
    problem.m_rigidProxies.resize(2);
    std::vector<ContactPoint>& contacts = problem.m_contacts;
    contacts = a.m_contacts;
    for (ContactPoint contact : b.m_contacts)
    {
        contact.m_soft.m_body = 2;
        contact.m_rigidProxy = 1;
        contacts.push_back(contact);
    }
    for (ContactScene* scene : {&a, &quiet, &b}) solveFreeMotion(scene->m_body, scene->m_settings.m_step);
    const std::vector<Vec3> untouched = velocity(quiet.m_body);
    ContactSolver solver;
    solver.solve(problem, a.m_settings);
    EXPECT_EQ(largestDistance(velocity(quiet.m_body), untouched), 0);
    a.solve();
    b.solve();
    for (int k = 0; k < 9; ++k)
    {
        EXPECT_LE(norm(contacts[k].m_impulse - a.m_contacts[k].m_impulse), kSolved * norm(a.totalImpulse())) << k;
        EXPECT_LE(norm(contacts[9 + k].m_impulse - b.m_contacts[k].m_impulse), kSolved * norm(b.totalImpulse())) << k;
    }
}

TEST(Contacts, StartFromTheImpulsesGiven)
{
    ContactScene cold;
    cold.setVelocity({1, 0, -2});
    cold.touchLowerFace(0, 0.3);
    cold.m_settings.m_tolerance = 1e-6;
    const int sweeps = cold.solve().m_sweeps;
    ContactScene warm;
    warm.setVelocity({1, 0, -2});
    warm.m_contacts = cold.m_contacts;
    warm.m_settings.m_tolerance = 1e-2;  // relative to the small remainder after the warm start
    EXPECT_LT(warm.solve().m_sweeps, sweeps);
    for (int k = 0; k < 9; ++k)
        EXPECT_LE(norm(warm.m_contacts[k].m_impulse - cold.m_contacts[k].m_impulse),
                  kSolved * norm(cold.totalImpulse()))
            << k;
}

TEST(Contacts, GiveTheSameBitsEveryTime)
{
    std::vector<Vec3> last;
    for (int run = 0; run < 2; ++run)
    {
        ContactScene scene;
        scene.setVelocity({1, 0.5, -2});
        scene.touchLowerFace(-0.01, 0.3);
        scene.solve();
        finishStep(scene.m_body, scene.m_settings.m_step);
        if (run == 0) last = scene.m_body.m_state.m_x;
        EXPECT_EQ(largestDistance(scene.m_body.m_state.m_x, last), 0);
    }
}

TEST(Contacts, SayWhenASolveDidNotConverge)
{
    ContactScene scene;
    scene.setVelocity({1, 0, -2});
    scene.touchLowerFace(0, 0.3);
    scene.m_settings.m_step.m_maxIterations = 1;
    scene.m_settings.m_rounds = scene.m_settings.m_maxRounds = 1;  // further outer iterations would continue from there
    EXPECT_FALSE(scene.solve().m_converged);
    for (const Vec3& v : velocity(scene.m_body)) EXPECT_LT(norm(v), 10);
}

TEST(Contacts, ObeyTheirSweepAndOuterIterationLimits)
{
    ContactScene scene;
    scene.setVelocity({1, 0, -2});
    scene.touchLowerFace(0, 0.3);
    scene.m_settings.m_sweeps = 3;
    scene.m_settings.m_rounds = 2;
    scene.m_settings.m_maxRounds = 5;
    scene.m_settings.m_tolerance = 0;
    const ContactReport report = scene.solve();
    EXPECT_EQ(report.m_rounds, 5);
    EXPECT_EQ(report.m_sweeps, 15);
    scene.m_settings.m_tolerance = 1e9;
    EXPECT_EQ(scene.solve().m_rounds, 2);
}

// One pair of a cube and the floor: seven extra sweeps over it belong to the first global sweep; the next one finds it
// converged.
TEST(Contact, StronglyChangedPairIsSweptAgainAtOnce)
{
    ContactScene scene;
    scene.touchLowerFace(0, 0.5);
    scene.setVelocity({0.3, 0.1, -2});
    scene.m_settings.m_tolerance = 5e-3;
    scene.m_settings.m_rounds = scene.m_settings.m_maxRounds = 1;
    EXPECT_LE(scene.solve().m_sweeps, 2);
}

}  // namespace
}  // namespace bullet_fem
