// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kCubeFriction = 0.5, kInclineOwnFriction = 0.8;
constexpr double kInclineFriction = kCubeFriction * kInclineOwnFriction;  // Coulomb's mu [-]

/// A cube on a ground inclined downwards to +x, with tan(slope) = steepness * mu.
class Incline
{
public:
    Incline(bool plane, double steepness) : m_slope(std::atan(steepness * kInclineFriction)), m_world(m_fem)
    {
        const btQuaternion tilt(btVector3(0, 1, 0), btScalar(m_slope));
        m_normal = vec3(quatRotate(tilt, btVector3(0, 0, 1)));
        m_downhill = vec3(quatRotate(tilt, btVector3(1, 0, 0)));
        RigidSettings settings;
        settings.m_friction = btScalar(kInclineOwnFriction);
        if (plane)
            m_world.addRigid(new btStaticPlaneShape(quatRotate(tilt, btVector3(0, 0, 1)), 0), settings);
        else
        {
            settings.m_transform = btTransform(tilt, quatRotate(tilt, btVector3(0, 0, -1)));
            m_world.addRigid(new btBoxShape(btVector3(30, 30, 1)), settings);
        }
        btSoftBody* cube = btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(0.5)),
                                                   btVector3(0.5, 0.5, 0.5), btScalar(0.25));
        cube->rotate(tilt);
        cube->m_cfg.kDF = btScalar(kCubeFriction);
        m_fem.setMaterial(cube, btFemMaterial());
        m_cube = &m_world.addSoft(cube);
    }

    void step(int count) { m_world.step(count); }
    double downhillSpeed() const { return dot(velocityOf(*m_cube), m_downhill); }
    double frictionOverNormal() const
    {
        const Vec3 J = impulseOn(m_fem, *m_cube);
        return norm(J - dot(J, m_normal) * m_normal) / dot(J, m_normal);
    }
    double lowestGap() const
    {
        double lowest = HUGE_VAL;
        for (int i = 0; i < m_cube->m_nodes.size(); ++i)
            lowest = std::min(lowest, dot(m_normal, vec3(m_cube->m_nodes[i].m_x)));
        return lowest;
    }
    double slope() const { return m_slope; }

private:
    double m_slope;
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    Vec3 m_normal, m_downhill;
    btSoftBody* m_cube;
};

class InclineTest : public testing::TestWithParam<bool>
{
};

TEST_P(InclineTest, SticksJustBelowTheFrictionAngle)
{
    Incline incline(GetParam(), 0.95);
    incline.step(240);
    for (int frame = 0; frame < 60; ++frame)
    {
        incline.step(1);
        EXPECT_LT(std::fabs(incline.downhillSpeed()), 1e-4) << "frame " << frame;
        EXPECT_NEAR(incline.frictionOverNormal(), std::tan(incline.slope()), 1e-3 * kInclineFriction)
            << "frame " << frame;
        EXPECT_GT(incline.lowestGap(), -1e-4);
    }
}

TEST_P(InclineTest, SlidesAboveItWithCoulombsForceAndNetAcceleration)
{
    for (const double steepness : {1.05, 1.3})
    {
        SCOPED_TRACE(steepness);
        Incline incline(GetParam(), steepness);
        incline.step(120);
        const double before = incline.downhillSpeed();
        for (int frame = 0; frame < 60; ++frame)
        {
            incline.step(1);
            EXPECT_NEAR(incline.frictionOverNormal(), kInclineFriction, 5e-4 * kInclineFriction) << "frame " << frame;
            EXPECT_GT(incline.lowestGap(), -1e-4);
        }
        const double slope = incline.slope();
        EXPECT_NEAR((incline.downhillSpeed() - before) / (60 * kStep),
                    kGravity * (std::sin(slope) - kInclineFriction * std::cos(slope)),
                    0.01 * kGravity * std::sin(slope));
    }
}

INSTANTIATE_TEST_SUITE_P(Grounds, InclineTest, testing::Values(true, false),
                         [](const auto& scene) { return scene.param ? "plane" : "box"; });

TEST(Friction, IsAbsentOnIce)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addPlane().setFriction(0);
    btSoftBody& cube = world.addSoft(
        btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.5)), btVector3(0.5, 0.5, 0.5), btScalar(0.5)));
    world.step(60);
    cube.addVelocity(btVector3(2, 0, 0));
    world.step(120);
    EXPECT_NEAR(velocityOf(cube).x, 2, 2e-3);  // 1e-3 of its speed: the solver's tolerance
}

TEST(Friction, SlidingBodyComesToRestAfterCoulombsTime)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addFloorBox().setFriction(btScalar(kInclineOwnFriction));
    btSoftBody* made =
        btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.5)), btVector3(0.5, 0.5, 0.5), btScalar(0.25));
    made->m_cfg.kDF = btScalar(kCubeFriction);
    btSoftBody& cube = world.addSoft(made);
    world.step(120);
    cube.addVelocity(btVector3(2, 0, 0));
    world.step(15);
    const double stopTime = 2 / (kInclineFriction * kGravity);
    EXPECT_NEAR(velocityOf(cube).x, 2 * (1 - 15 * kStep / stopTime), 0.05 * 2);
    world.step(180);
    EXPECT_LT(fastestNode(cube), 1e-3);
}

}  // namespace
}  // namespace bullet_fem
