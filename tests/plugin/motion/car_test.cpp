// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "plugin/motion/car_scene.h"

namespace bullet_fem
{
namespace
{

constexpr double kTorque = 60;  // on each wheel [N m]

btFemSolverInfo stepOf(double numericalDamping)
{
    btFemSolverInfo info;
    info.m_numericalDamping = info.m_contactDamping = btScalar(numericalDamping);
    return info;
}

double speedAfter(double seconds, double rate, double youngModulus, Coupling coupling = Coupling::coupled)
{
    FemWorld world(WorldClass::softRigid, coupling, {0, 0, btScalar(-kGravity)}, stepOf(1));
    world.addPlane();
    Car car(world, youngModulus);
    for (int k = 0; k < seconds * rate; ++k) car.step(kTorque, 1 / rate);
    return car.speed();
}

// The rims of its tyres must not count as round edges, which would brake the car by its load's lever v h / 2. In steps
// of 1/240 s its speed is 6.9 and 5.8 m/s after ten seconds.
TEST(CarOnSoftTyres, IsAsFastAsWithSmallSteps)
{
    for (const double young : {3e5, 1e6})
    {
        const double fine = speedAfter(10, 240, young), coarse = speedAfter(10, 60, young);
        EXPECT_GT(fine, 5) << young;
        EXPECT_NEAR(coarse, fine, 0.05 * fine) << young;
    }
}

TEST(CarOnSoftTyres, DrivesAlikeWithTheSwap)
{
    const double coupled = speedAfter(5, 60, 3e5), swap = speedAfter(5, 60, 3e5, Coupling::swap);
    EXPECT_NEAR(swap, coupled, 0.01 * coupled);
}

// The torque on a hub exceeds the tyre's resistance: its anchors move along the arc of its spin.
TEST(CarOnSoftTyres, HoldsItsAnchorsUnderTorque)
{
    for (const double damping : {0.0, 1.0})
    {
        FemWorld world(WorldClass::softRigid, Coupling::coupled, {0, 0, btScalar(-kGravity)}, stepOf(damping));
        world.addPlane();
        Car car(world, 1e6, 5);
        double farthest = 0;
        for (int k = 0; k < 60; ++k)
        {
            car.step(kTorque, double(kStep));
            for (const btSoftBody* tyre : car.tyres())
            {
                const btAlignedObjectArray<btFemAnchorReport>& anchors = world.fem().anchors(tyre);
                for (int i = 0; i < anchors.size(); ++i) farthest = std::max(farthest, double(anchors[i].m_error));
            }
        }
        EXPECT_LT(farthest, 0.01 * Car::kHub) << damping;
    }
}

}  // namespace
}  // namespace bullet_fem
