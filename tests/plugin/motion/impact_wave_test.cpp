// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The stress of the wave that an impact starts, as step reports and elements have it.
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemReports.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

// A bar that flies endwise against a wall, or against its twin at the same speed: stresses [Pa] over its flight.
struct EndwiseImpact
{
    double m_element = 0;  // largest pressure along the bar, of all elements
    double m_reported = 0;
    double m_last = 0;  // reported at the end
};

EndwiseImpact strikeEndwise(Coupling coupling, bool hitsTwin, double speed, double rate)
{
    FemWorld world(WorldClass::softRigid, coupling, {0, 0, 0});
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e7);
    material.m_poissonRatio = 0;
    material.m_density = 1000;
    material.m_stiffnessDamping = 0;
    material.m_bending = btFemBending::plain;
    const auto addBar = [&](double side) -> btSoftBody&
    {
        btSoftBody& bar = world.addSoft(
            btFemHelpers::createBox(world.info(), {0, 0, btScalar(.52 * side)}, {.05f, .05f, .5f}, btScalar(.025)));
        world.fem().setMaterial(&bar, material);
        bar.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        bar.setVelocity(btVector3(0, 0, btScalar(-speed * side)));
        return bar;
    };
    btSoftBody& bar = addBar(1);
    if (hitsTwin)
        addBar(-1);
    else
        world.addFloorBox();
    EndwiseImpact impact;
    btAlignedObjectArray<btFemStress> stresses;
    for (int k = 0; k < .04 * rate + 1; ++k)
    {
        world.step(1, btScalar(1 / rate));
        world.fem().getStress(&bar, stresses);
        for (int e = 0; e < stresses.size(); ++e)
            impact.m_element = std::max(impact.m_element, -double(stresses[e].m_zz));
        impact.m_last = world.fem().stepReport(&bar).m_impactStress;
        impact.m_reported = std::max(impact.m_reported, impact.m_last);
    }
    return impact;
}

// With nu = 0, c = sqrt(E / rho) = 100 m/s, and the stress is rho c v, also of twins that meet at 2 v. Elements have
// .42 of it in steps of 1/60 s, in which the wave crosses the bar almost twice.
TEST(ImpactWave, HasTheStressThatIsReported)
{
    constexpr double kSpeed = 1, kStress = 1000 * 100 * kSpeed;  // [m/s], [Pa]
    for (const Coupling coupling : {Coupling::swap, Coupling::coupled})
        for (const bool hitsTwin : {false, true})
        {
            for (const double rate : {60.0, 240.0, 3840.0})
            {
                const EndwiseImpact impact = strikeEndwise(coupling, hitsTwin, kSpeed, rate);
                EXPECT_NEAR(impact.m_reported, kStress, 0.02 * kStress) << hitsTwin << ' ' << rate;
                EXPECT_EQ(impact.m_last, 0) << hitsTwin << ' ' << rate;
                if (rate > 60)
                    EXPECT_NEAR(impact.m_element, kStress, 0.3 * kStress) << hitsTwin;
                else
                    EXPECT_LT(impact.m_element, 0.7 * kStress) << hitsTwin << ' ' << rate;
            }
        }
}

}  // namespace
}  // namespace bullet_fem
