// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The rigid motion of a free body is exact, and its elastic part is solved alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fem/body/step_scratch.h"
#include "fem/scenes/free_bodies.h"

namespace bullet_fem
{
namespace
{

constexpr double kDegree = 0.017453292519943295;  // [rad]

// A shape of the bar and the largest number of iterations that answers to impulses take, by a dense prototype plus one.
struct Strain
{
    const char* m_name;
    double m_bend, m_twist;  // [degrees]
    int m_iterations;
};

void PrintTo(const Strain& strain, std::ostream* out)
{
    *out << strain.m_name;
}

class ImpulseResponses : public testing::TestWithParam<std::tuple<Strain, double, bool>>  // E [Pa], self-equilibrated
{
protected:
    // Impulses on the nodes at both ends and on those in the middle of the upper side.
    static std::vector<Vec3> impulsesOn(const Body& body, unsigned seed)
    {
        RandomVectors random(seed);
        std::vector<Vec3> impulses;
        for (const Vec3& X : body.m_model->mesh().restPositions())
        {
            const bool isAtEnd = std::fabs(X.x) > 0.499 * kBarLength;
            const bool isOnTop = std::fabs(X.x) < kBarLength / 20 && X.y > 0.0149;
            impulses.push_back(isAtEnd || isOnTop ? 0.01 * random.next() : Vec3());
        }
        return impulses;
    }
};

// The stiffness of a strained body does not resist its rigid motion, so iterations do not depend on E.
TEST_P(ImpulseResponses, NeedFewIterationsWhateverTheStiffness)
{
    const auto& [strain, young, isBalanced] = GetParam();
    const std::shared_ptr<const BodyModel> model = makeBody(makeFreeBar(), barMaterial(young)).m_model;
    int most = 0;
    for (unsigned seed = 1; seed <= 5; ++seed)
    {
        Body body(model);
        if (strain.m_bend > 0) bend(body, strain.m_bend * kDegree);
        if (strain.m_twist > 0) twist(body, strain.m_twist * kDegree);
        rotate(body, rotationAbout({3, 2, -1}, 0.37));
        std::vector<Vec3> impulses = impulsesOn(body, seed);
        if (isBalanced) equilibrate(body, impulses);
        const StepSettings settings;
        ASSERT_EQ(settings.m_tolerance, 1e-3);
        solveFreeMotion(body, settings);
        const SolveReport report = applyImpulses(body, impulses, settings);
        EXPECT_EQ(report.m_stop, SolveStop::converged);
        most = std::max(most, report.m_iterations);
    }
    RecordProperty("iterations", most);
    EXPECT_LE(most, strain.m_iterations);
    EXPECT_GE(most, 1);
}

INSTANTIATE_TEST_SUITE_P(Bars, ImpulseResponses,
                         testing::Combine(testing::Values(Strain{"Bent5", 5, 0, 4}, Strain{"Bent30", 30, 0, 6},
                                                          Strain{"Bent90", 90, 0, 10}, Strain{"Twisted90", 0, 90, 11}),
                                          testing::Values(1e4, 1e6, 1e8, 1e9), testing::Bool()),
                         [](const auto& suite)
                         {
                             return std::string(std::get<0>(suite.param).m_name) + "_" +
                                    nameOfYoung(std::get<1>(suite.param)) +
                                    (std::get<2>(suite.param) ? "_Balanced" : "_Random");
                         });

// Bodies in steps with loads, impulses and damping.
struct Flight
{
    int m_components;
    double m_young, m_bend, m_twist;  // [Pa], [degrees]
    double m_numericalDamping, m_tolerance;
    double m_massDamping;
};

void PrintTo(const Flight& flight, std::ostream* out)
{
    *out << nameOfYoung(flight.m_young) << " bent " << flight.m_bend << " twisted " << flight.m_twist;
}

// A bar, with a box beside it as a second component.
TetMesh meshOf(int components)
{
    const TetMesh bar = makeFreeBar();
    if (components == 1) return bar;
    const TetMesh box = makeBox({0.1, 0.04, 0.03}, {3, 2, 1}, {0.2, 0.1, -0.05});
    std::vector<Vec3> X = bar.restPositions();
    X.insert(X.end(), box.restPositions().begin(), box.restPositions().end());
    std::vector<Tet> tets = bar.tets();
    for (Tet tet : box.tets())
    {
        for (int& node : tet) node += bar.nodeCount();
        tets.push_back(tet);
    }
    return TetMesh(X, tets);
}

class FlyingBodies : public testing::TestWithParam<std::tuple<Flight, bool>>  // whether impulses act
{
protected:
    static Body makeFlyingBody(const Flight& flight)
    {
        Material material = barMaterial(flight.m_young);
        material.m_massDamping = flight.m_massDamping;
        Body body = makeBody(meshOf(flight.m_components), material);
        if (flight.m_bend > 0) bend(body, flight.m_bend * kDegree);
        if (flight.m_twist > 0) twist(body, flight.m_twist * kDegree);
        rotate(body, rotationAbout({3, 2, -1}, 0.37));
        spin(body, {3, 8, -5});
        RandomVectors random(5);
        for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        {
            body.m_state.m_v[i] += Vec3{1, -2, 0.5} + 0.1 * random.next();
            body.m_loads.m_force[i] = 0.02 * random.next() + body.m_state.m_mass[i] * Vec3{0, 0, -9.81};
        }
        return body;
    }

    // Sums of loads and impulses on a component, at the positions of the step's forces about the centre of these.
    static std::pair<Vec3, Vec3> sumsOf(const Body& body, int component, const std::vector<Vec3>& given)
    {
        const std::vector<Vec3>& y = body.m_workspace.scratch().m_kickPosition;
        const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
        std::vector<double> weights = body.m_state.m_mass;
        for (std::size_t i = 0; i < weights.size(); ++i)
            if (componentOf[i] != component) weights[i] = 0;
        const Vec3 center = weightedMean(weights, y);
        std::pair<Vec3, Vec3> sums;
        for (std::size_t i = 0; i < y.size(); ++i)
        {
            if (componentOf[i] != component) continue;
            sums.first += given[i];
            sums.second += cross(y[i] - center, given[i]);
        }
        return sums;
    }

    // Compares the momenta of all components after a step with those before it plus what was given.
    void compare(const Body& body, const std::vector<RigidMotion>& before, const std::vector<Vec3>& given)
    {
        const double share = 1 / (1 + StepSettings().m_step * std::get<0>(GetParam()).m_massDamping);
        for (int c = 0; c < body.m_model->mesh().componentCount(); ++c)
        {
            const RigidMotion now = rigidMotionOf(body, c);
            const auto [impulse, torque] = sumsOf(body, c, given);
            const double linear = norm(now.m_linear - share * (before[c].m_linear + impulse)) / now.m_linearSize;
            const double angular = norm(now.m_angular - share * (before[c].m_angular + torque)) / now.m_angularSize;
            m_linearError = std::max(m_linearError, linear);
            m_angularError = std::max(m_angularError, angular);
        }
    }

    double m_linearError = 0, m_angularError = 0;  // maxima of a step, of sum m |v| and sum m |r| |v|
};

TEST_P(FlyingBodies, GetExactlyTheMomentumOfLoadsAndImpulses)
{
    const auto& [flight, isPushed] = GetParam();
    Body body = makeFlyingBody(flight);
    StepSettings settings;
    settings.m_numericalDamping = flight.m_numericalDamping;
    settings.m_tolerance = flight.m_tolerance;
    std::vector<Vec3> impulses(body.m_state.m_x.size());
    RandomVectors random(9);
    for (int k = 0; k < 60; ++k)
    {
        std::vector<RigidMotion> before;
        for (int c = 0; c < flight.m_components; ++c) before.push_back(rigidMotionOf(body, c));
        std::vector<Vec3> given = body.m_loads.m_force;
        for (Vec3& f : given) f *= settings.m_step;
        solveFreeMotion(body, settings);
        for (int round = 0; round < 2 && isPushed; ++round)
        {
            for (std::size_t i = 0; i < impulses.size(); ++i)
            {
                impulses[i] = i % 5 == 0 ? 1e-3 * random.next() : Vec3();
                given[i] += impulses[i];
            }
            applyImpulses(body, impulses, settings);
        }
        finishStep(body, settings);
        compare(body, before, given);
    }
    RecordProperty("linear", std::to_string(1e12 * m_linearError) + "e-12");
    RecordProperty("angular", std::to_string(1e12 * m_angularError) + "e-12");
    EXPECT_LE(m_linearError, 1e-12);
    EXPECT_LE(m_angularError, 1e-12);
    EXPECT_GT(kineticEnergy(body.m_state), 1e-2);
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, FlyingBodies,
    testing::Combine(testing::Values(Flight{1, 1e5, 0, 0, 1, 1e-3, 0}, Flight{1, 1e6, 30, 0, 1, 1e-3, 0},
                                     Flight{1, 1e8, 90, 0, 1, 1e-3, 0}, Flight{1, 1e6, 0, 90, 1, 1e-3, 0},
                                     Flight{1, 1e6, 30, 0, 1, 1e-10, 0}, Flight{1, 1e6, 30, 0, 1, 1e-3, 0.5},
                                     Flight{2, 1e6, 0, 0, 1, 1e-3, 0}, Flight{2, 1e8, 0, 0, 1, 1e-10, 0.5},
                                     Flight{1, 1e5, 0, 0, 0, 1e-3, 0}, Flight{1, 1e6, 30, 0, 0, 1e-3, 0},
                                     Flight{1, 1e8, 90, 0, 0, 1e-3, 0}, Flight{1, 1e6, 0, 90, 0, 1e-3, 0},
                                     Flight{1, 1e6, 30, 0, 0, 1e-10, 0}, Flight{2, 1e6, 0, 0, 0, 1e-3, 0},
                                     Flight{2, 1e8, 0, 0, 0, 1e-10, 0.5}, Flight{2, 1e6, 0, 0, 0.3, 1e-3, 0}),
                     testing::Bool()),
    [](const auto& suite)
    {
        const Flight& flight = std::get<0>(suite.param);
        return std::to_string(suite.index) + "_" + nameOfDamping(flight.m_numericalDamping) + "_" +
               nameOfYoung(flight.m_young) + (flight.m_tolerance < 1e-6 ? "_Double" : "_Single") +
               (flight.m_components == 2 ? "_TwoComponents" : "") + (std::get<1>(suite.param) ? "_Pushed" : "");
    });

}  // namespace
}  // namespace bullet_fem
