// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kOverlapSize = 0.5;  // edge of the soft cubes [m]

struct OverlapCase
{
    const char* m_name;
    double m_share;  // of the cube's size inside the other body [-]
    Coupling m_coupling;
};

/// Soft cubes that start partly inside another body; the correction must be gentle.
class Overlap : public testing::TestWithParam<OverlapCase>
{
protected:
    // Adds a cube with its lowest face at this height.
    btSoftBody& addCube(double lowest)
    {
        btSoftBody* cube =
            btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(lowest + kOverlapSize / 2)),
                                    btVector3(1, 1, 1) * btScalar(kOverlapSize / 2), btScalar(kOverlapSize / 4));
        m_fem.setMaterial(cube, btFemMaterial());
        m_cubes.push_back(&m_world.addSoft(cube));
        return *m_cubes.back();
    }

    btRigidBody& addBox(const btVector3& half, double center, double mass)
    {
        m_movable = &m_world.addRigid(new btBoxShape(half), {btScalar(mass), at(0, 0, btScalar(center))});
        return *m_movable;
    }

    // Runs 3 s; records the maximum node speed, the maximum kinetic energy, and whether all numbers stay finite.
    void watch()
    {
        for (int k = 0; k < 180; ++k)
        {
            m_world.step();
            double energy = 0;
            for (const btSoftBody* cube : m_cubes)
            {
                m_finite = m_finite && allFinite(*cube);
                m_fastest = std::max(m_fastest, fastestNode(*cube));
                energy += motionOf(*cube).m_energy;
            }
            m_largestEnergy = std::max(m_largestEnergy, energy);
            if (m_movable) m_fastestRigid = std::max(m_fastestRigid, norm(vec3(m_movable->getLinearVelocity())));
        }
    }

    double depth() const { return GetParam().m_share * kOverlapSize; }

    // Position correction (m_maxPushVelocity, 1 m/s) adds no velocity: motion comes only from the strain that it
    // causes.
    void expectCalm(double mass) const
    {
        EXPECT_TRUE(m_finite);
        EXPECT_LT(m_fastest, 2);
        EXPECT_LT(m_fastestRigid, 2);
        EXPECT_LT(m_largestEnergy, 0.5 * mass);  // of 1 m/s
    }

    // The ground is at z = 0.
    void expectOverlapWithTheGroundToBeResolved()
    {
        btSoftBody& cube = addCube(-depth());
        watch();
        expectCalm(massOf(cube));
        EXPECT_GT(lowestHeight(cube), -kGone);
        EXPECT_LT(lowestHeight(cube), kGone);
    }

    static constexpr double kGone = 1e-3 * kOverlapSize;  // overlap accepted with movable bodies
    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem, GetParam().m_coupling};
    std::vector<btSoftBody*> m_cubes;
    btRigidBody* m_movable = nullptr;
    double m_fastest = 0, m_fastestRigid = 0, m_largestEnergy = 0;
    bool m_finite = true;
};

TEST_P(Overlap, IsResolvedWithTheGround)
{
    m_world.addPlane();
    expectOverlapWithTheGroundToBeResolved();
}

TEST_P(Overlap, IsResolvedWithAStaticBox)
{
    m_world.addFloorBox();
    expectOverlapWithTheGroundToBeResolved();
}

// The separating direction is upwards for each node, for those of the upper corners only slightly.
TEST_P(Overlap, IsResolvedWithADynamicBoxOnTop)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(0);
    constexpr double kThin = 0.2;
    btRigidBody& box = addBox({0.5, 0.5, btScalar(kThin)}, kOverlapSize + kThin - depth(), 0.5 * massOf(cube));
    watch();
    expectCalm(massOf(cube));
    const btVector3& center = box.getCenterOfMassPosition();
    EXPECT_GT(lowestHeight(cube), -kGone);
    EXPECT_GT(center.z() - kThin, kOverlapSize - 0.02);  // its weight compresses the top by some mm
    EXPECT_LT(std::hypot(center.x(), center.y()), 0.02);
    EXPECT_LT(m_fem.stepReport(&cube).m_deepestPenetration, 2 * kGone);
}

// Nodes under a small box may be nearer to its sides than to its lower face: its final place is open, its speed is
// bounded.
TEST_P(Overlap, ThrowsNothingWithASmallDynamicBox)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(0);
    constexpr double kHalf = 0.2;
    btRigidBody& box =
        addBox({btScalar(kHalf), btScalar(kHalf), btScalar(kHalf)}, kOverlapSize + kHalf - depth(), 0.5 * massOf(cube));
    watch();
    EXPECT_TRUE(m_finite);
    EXPECT_LT(m_fastestRigid, std::sqrt(2 * kGravity * kOverlapSize) + 1);  // it may fall off
    // Nodes may spring back at the strain times the speed of sound, sqrt(E / rho).
    EXPECT_LT(m_fastest, std::sqrt(2 * kGravity * kOverlapSize) + GetParam().m_share * std::sqrt(1e6 / 1000));
    EXPECT_LT(m_largestEnergy, massOf(cube) * 2);  // of 2 m/s
    EXPECT_LT(std::hypot(box.getCenterOfMassPosition().x(), box.getCenterOfMassPosition().y()), 2);
    EXPECT_GT(lowestHeight(cube), -kGone);
}

TEST_P(Overlap, IsResolvedBetweenTwoSoftCubes)
{
    m_world.addFloorBox();
    addCube(0);
    btSoftBody& upper = addCube(kOverlapSize - depth());
    watch();
    expectCalm(2 * massOf(upper));
    EXPECT_NEAR(lowestHeight(upper), kOverlapSize, 0.02);
    EXPECT_NEAR(lowestHeight(*m_cubes[0]), 0, kGone);
    EXPECT_LT(m_fem.stepReport(&upper).m_deepestPenetration, 2 * kGone);
    EXPECT_LT(std::hypot(centerOf(upper).x, centerOf(upper).y), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Contact, Overlap,
                         testing::Values(OverlapCase{"tenPercent", 0.1, Coupling::swap},
                                         OverlapCase{"thirtyPercent", 0.3, Coupling::swap},
                                         OverlapCase{"tenPercentCoupled", 0.1, Coupling::coupled},
                                         OverlapCase{"thirtyPercentCoupled", 0.3, Coupling::coupled}),
                         [](const auto& scene) { return scene.param.m_name; });

}  // namespace
}  // namespace bullet_fem
