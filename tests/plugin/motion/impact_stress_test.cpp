// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kSeconds = 1.5;  // the block falls, tips over and settles [s]

/// Maximum von Mises stress of a tilted block of 30 kg dropped from half a metre, in motion and at rest [Pa].
struct LandingStress
{
    double m_largest = 0, m_last = 0;
};

LandingStress land(double youngModulus, double numericalDamping, double rate)
{
    btFemSolverInfo info;
    info.m_numericalDamping = info.m_contactDamping = btScalar(numericalDamping);
    FemWorld world(WorldClass::softRigid, Coupling::swap, {0, 0, btScalar(-kGravity)}, info);
    world.addFloorBox();
    btSoftBody& block = world.addSoft(btFemHelpers::createBox(world.info(), {0, 0, 0}, {.25f, .15f, .1f}, .05f));
    btFemMaterial material;
    material.m_youngModulus = btScalar(youngModulus);
    material.m_density = 1000;
    material.m_stiffnessDamping = btScalar(0.001);
    world.fem().setMaterial(&block, material);
    block.rotate(btQuaternion(btVector3(btScalar(0.3), 1, 0).normalized(), btScalar(0.5)));
    block.translate({0, 0, btScalar(0.7)});
    block.setActivationState(DISABLE_DEACTIVATION);
    LandingStress stress;
    btAlignedObjectArray<btScalar> elements;
    for (int k = 0; k < kSeconds * rate; ++k)
    {
        world.step(1, btScalar(1 / rate));
        world.fem().getVonMises(&block, elements);
        stress.m_last = 0;
        for (int e = 0; e < elements.size(); ++e) stress.m_last = std::max(stress.m_last, double(elements[e]));
        stress.m_largest = std::max(stress.m_largest, stress.m_last);
    }
    return stress;
}

// Rotation within a step is no strain: impacts in steps of 1/1920 s have at least equal stress. (Steps of 1/60 s,
// longer than the contact, give .2 to .9 of their stress.)
TEST(LandingBlock, IsStressedNoMoreThanInSmallSteps)
{
    for (const double young : {1e7, 1e8, 1e9})
        for (const double damping : {0.0, 1.0})
        {
            const LandingStress reference = land(young, damping, 1920);
            EXPECT_LT(reference.m_last, 1e-2 * reference.m_largest) << young << ' ' << damping;
            for (const double rate : {60.0, 240.0})
            {
                const LandingStress stress = land(young, damping, rate);
                EXPECT_LT(stress.m_largest, 1.2 * reference.m_largest) << young << ' ' << damping << ' ' << rate;
                EXPECT_LT(stress.m_last, 0.02 * reference.m_largest) << young << ' ' << damping << ' ' << rate;
            }
        }
}

}  // namespace
}  // namespace bullet_fem
