// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies between two kinematic jaws that compress them by 2 %.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "plugin/scenes/kinematic_bodies.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

struct Clamped
{
    const char* m_name;
    double m_size;       // height between the jaws [m]
    double m_length;     // over the height [-]
    double m_stick;      // force with friction over that without: converged in steps of 1/240 s at 1e5 Pa [-]
    double m_frequency;  // [1/s]
};

void PrintTo(const Clamped& clamped, std::ostream* out)
{
    *out << clamped.m_name;
}

constexpr double kClosing = 0.02, kGap = 0.01;  // of the height [-]

// Coupling, body, E [Pa], whether there is friction.
class Jaws : public testing::TestWithParam<std::tuple<Coupling, Clamped, double, bool>>
{
protected:
    struct Result
    {
        double m_force = 0, m_fastest = 0, m_deepest = 0;  // means and maxima at rest [N], [m/s], [m]
        double m_thrown = 0;                               // maximum speed since the start [m/s]
        int m_iterations = 0, m_sweeps = 0;
    };

    static SoftBox boxOf(const Clamped& body, double young, bool hasFriction)
    {
        SoftBox box;
        box.m_size = body.m_size * Vec3{body.m_length, 1, 1};
        box.m_cells = {int(4 * body.m_length), 4, 4};
        box.m_youngModulus = btScalar(young);
        box.m_friction = btScalar(hasFriction ? 0.5 : 0);
        return box;
    }

    // The jaws close in a second; the mean is that over the last half second of 2.5.
    static Result press()
    {
        const auto& [coupling, clamped, young, hasFriction] = GetParam();
        FemWorld world(WorldClass::softRigid, coupling, btVector3(0, 0, 0));
        btSoftBody& body = addSoftBox(world, world.fem(), boxOf(clamped, young, hasFriction));
        const double size = clamped.m_size, h = 1 / clamped.m_frequency;
        btRigidBody* jaws[2];
        const auto pose = [size](int side, double time)
        {
            const double closed = (kGap + 0.5 * kClosing) * std::clamp(time - 0.2, 0.0, 1.0);
            return at(0, 0, btScalar((side == 0 ? -1 : 1) * size * (1.5 + kGap - closed)));
        };
        for (int side = 0; side < 2; ++side)
            jaws[side] =
                &addKinematicBox(world, size * Vec3{2 * clamped.m_length, 2, 2}, pose(side, 0), hasFriction ? 1 : 0);
        Result result;
        int count = 0;
        for (int k = 1; k * h <= 2.5; ++k)
        {
            for (int side = 0; side < 2; ++side) jaws[side]->getMotionState()->setWorldTransform(pose(side, k * h));
            world.step(1, btScalar(h));
            const btFemStepReport report = world.fem().stepReport(&body);
            result.m_iterations = std::max(result.m_iterations, report.m_contactIterations);
            result.m_sweeps = std::max(result.m_sweeps, report.m_contactSweeps);
            result.m_thrown = std::max(result.m_thrown, fastestNode(body));
            if (k * h < 2) continue;
            result.m_force -= double(world.fem().contactForce(&body, jaws[1]).z());
            result.m_fastest = std::max(result.m_fastest, fastestNode(body));
            result.m_deepest = std::max(result.m_deepest, double(report.m_deepestPenetration));
            ++count;
        }
        result.m_force /= count;
        return result;
    }
};

// Without friction the stress is uniaxial; ends that stick bear more.
TEST_P(Jaws, PressWithTheForceOfTheStrain)
{
    const auto& [coupling, clamped, young, hasFriction] = GetParam();
    const double area = clamped.m_length * clamped.m_size * clamped.m_size;
    const double expected = young * area * kClosing * (hasFriction ? clamped.m_stick : 1);
    const Result result = press();
    RecordProperty("force", std::to_string(result.m_force / expected));
    RecordProperty("speed", std::to_string(result.m_fastest) + " thrown " + std::to_string(result.m_thrown));
    RecordProperty("iterations", std::to_string(result.m_iterations) + " sweeps " + std::to_string(result.m_sweeps));
    EXPECT_NEAR(result.m_force, expected, 0.03 * expected);
    EXPECT_LT(result.m_fastest, 0.01);
    EXPECT_LT(result.m_thrown, 0.3);
    EXPECT_LT(result.m_deepest, 0.001 * clamped.m_size);
}

std::string nameOfJaws(const testing::TestParamInfo<Jaws::ParamType>& suite)
{
    const Clamped& clamped = std::get<1>(suite.param);
    return std::string(couplingName(std::get<0>(suite.param))) + "_" + clamped.m_name + "_" +
           nameOfYoung(std::get<2>(suite.param)) + "_" + nameOfStep(1 / clamped.m_frequency) +
           (std::get<3>(suite.param) ? "_Friction" : "");
}

INSTANTIATE_TEST_SUITE_P(Small, Jaws,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(Clamped{"SmallCube", 0.04, 1, 1.100, 60},
                                                          Clamped{"SmallCube", 0.04, 1, 1.100, 240},
                                                          Clamped{"SmallBar", 0.04, 3, 1.145, 60}),
                                          testing::Values(1e5, 1e6, 1e7, 1e8), testing::Bool()),
                         nameOfJaws);
// With friction they may slip (docs/reliability.md).
INSTANTIATE_TEST_SUITE_P(Stiffest, Jaws,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(Clamped{"SmallCube", 0.04, 1, 1.100, 60},
                                                          Clamped{"SmallBar", 0.04, 3, 1.145, 60}),
                                          testing::Values(1e9), testing::Values(false)),
                         nameOfJaws);
INSTANTIATE_TEST_SUITE_P(Large, Jaws,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(Clamped{"LargeCube", 0.4, 1, 1.100, 60},
                                                          Clamped{"LargeBar", 0.4, 3, 1.145, 60}),
                                          testing::Values(1e5, 1e6, 1e7, 1e8, 1e9), testing::Bool()),
                         nameOfJaws);

}  // namespace
}  // namespace bullet_fem
