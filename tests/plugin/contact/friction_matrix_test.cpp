// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kSoftFriction = 0.5, kRigidFriction = 0.8;
constexpr double kFriction = kSoftFriction * kRigidFriction;  // Coulomb's mu [-]

struct FrictionCase
{
    double m_steepness;  // tan(slope) / mu [-]
    double m_young;      // [Pa]
    int m_stepsPerSecond;
    bool m_plane;  // else on a box
};

std::string nameOf(const FrictionCase& c)
{
    return "steepness" + std::to_string(int(100 * c.m_steepness + 0.5)) + (c.m_young > 1e6 ? "stiff" : "soft") + "At" +
           std::to_string(c.m_stepsPerSecond) + "Hz" + (c.m_plane ? "OnAPlane" : "OnABox");
}

/// A cube of 1 m on a ground inclined downwards to +x. Staggered coupling only: the ground is static.
class FrictionMatrix : public EachWorldWith<FrictionCase>
{
protected:
    explicit FrictionMatrix(double massDamping = 0)
    {
        const btQuaternion tilt(btVector3(0, 1, 0), btScalar(m_slope));
        const btVector3 normal = quatRotate(tilt, btVector3(0, 0, 1));
        m_normal = vec3(normal);
        m_downhill = vec3(quatRotate(tilt, btVector3(1, 0, 0)));
        RigidSettings settings;
        settings.m_friction = btScalar(kRigidFriction);
        if (!value().m_plane) settings.m_transform = btTransform(tilt, -normal);
        m_world.addRigid(value().m_plane ? static_cast<btCollisionShape*>(new btStaticPlaneShape(normal, 0))
                                         : new btBoxShape(btVector3(40, 40, 1)),
                         settings);
        btSoftBody* cube = btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(0.5)),
                                                   btVector3(0.5, 0.5, 0.5), btScalar(0.25));
        cube->rotate(tilt);
        cube->m_cfg.kDF = btScalar(kSoftFriction);
        btFemMaterial material;
        material.m_youngModulus = btScalar(value().m_young);
        material.m_massDamping = btScalar(massDamping);
        m_fem.setMaterial(cube, material);
        m_cube = &m_world.addSoft(cube);
    }

    void step(int count) { m_world.step(count, btScalar(m_h)); }
    int steps(double seconds) const { return static_cast<int>(seconds / m_h + 0.5); }
    double downhillSpeed() const { return dot(velocityOf(*m_cube), m_downhill); }

    double frictionOverNormal() const
    {
        const Vec3 J = impulseOn(m_fem, *m_cube);
        return norm(J - dot(J, m_normal) * m_normal) / dot(J, m_normal);
    }

    // Acceleration by Coulomb's law [m/s2].
    double expectedAcceleration() const { return kGravity * (std::sin(m_slope) - kFriction * std::cos(m_slope)); }

    const double m_h = 1.0 / value().m_stepsPerSecond;                  // [s]
    const double m_slope = std::atan(value().m_steepness * kFriction);  // [rad]
    FemWorld m_world{worldClass()};
    btFemSoftBodySolver& m_fem = m_world.fem();
    Vec3 m_normal, m_downhill;
    btSoftBody* m_cube = nullptr;
};

using Sliding = FrictionMatrix;

/// With mass damping: stiffness damping alone would let the softer cube oscillate for half a minute.
class Sticking : public FrictionMatrix
{
protected:
    Sticking() : FrictionMatrix(5) {}
};

TEST_P(Sliding, FrictionIsMuTimesTheNormalForceAndTheRestAccelerates)
{
    step(steps(2));
    const double before = downhillSpeed();
    for (int frame = 0; frame < steps(1); ++frame)
    {
        step(1);
        ASSERT_NEAR(frictionOverNormal(), kFriction, 5e-4 * kFriction) << "frame " << frame;
        ASSERT_LT(m_fem.stepReport(m_cube).m_deepestPenetration, 1e-4) << "frame " << frame;
    }
    EXPECT_NEAR(downhillSpeed() - before, expectedAcceleration(), 0.01 * kGravity * std::sin(m_slope));
}

TEST_P(Sticking, DoesNotCreepAndFrictionBalancesTheSlope)
{
    step(steps(4));
    const Vec3 start = centerOf(*m_cube);
    for (int frame = 0; frame < steps(1); ++frame)
    {
        step(1);
        ASSERT_LT(norm(velocityOf(*m_cube)), 1e-4) << "frame " << frame;
        ASSERT_NEAR(frictionOverNormal(), std::tan(m_slope), 1e-3 * std::tan(m_slope)) << "frame " << frame;
    }
    EXPECT_LT(norm(centerOf(*m_cube) - start), 1e-4);  // after 1 s
}

std::vector<FrictionCase> cases(const std::vector<double>& steepness)
{
    std::vector<FrictionCase> all;
    for (const double s : steepness)
        for (const double young : {1e5, 1e7})
            for (const int rate : {60, 240})
                for (const bool plane : {true, false}) all.push_back({s, young, rate, plane});
    return all;
}

const auto softRigid = testing::Values(WorldClass::softRigid);
const auto otherWorlds = testing::Values(WorldClass::softMultiBody, WorldClass::deformable);

INSTANTIATE_TEST_SUITE_P(Contact, Sliding, testing::Combine(softRigid, testing::ValuesIn(cases({1.05, 1.3, 2}))),
                         nameOfWorldWith(nameOf));
INSTANTIATE_TEST_SUITE_P(Contact, Sticking, testing::Combine(softRigid, testing::ValuesIn(cases({0.95}))),
                         nameOfWorldWith(nameOf));
INSTANTIATE_TEST_SUITE_P(OtherWorlds, Sliding,
                         testing::Combine(otherWorlds, testing::Values(FrictionCase{1.3, 1e5, 60, false})),
                         nameOfWorldWith(nameOf));
INSTANTIATE_TEST_SUITE_P(OtherWorlds, Sticking,
                         testing::Combine(otherWorlds, testing::Values(FrictionCase{0.95, 1e5, 60, false})),
                         nameOfWorldWith(nameOf));

}  // namespace
}  // namespace bullet_fem
