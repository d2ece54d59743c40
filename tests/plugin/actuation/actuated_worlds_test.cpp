// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies with actuators in each class of Bullet's worlds, and in saved states.
#include <gtest/gtest.h>

#include "plugin/scenes/each_world.h"
#include "plugin/scenes/hollow_cube.h"
#include "plugin/scenes/snapshot_scene.h"

namespace bullet_fem
{
namespace
{

// Runs in each class of Bullet's worlds.
TEST_P(EachWorld, InflatesABody)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& body = addHollowCube(world, world.fem(), {0, 0, 0});
    world.fem().prepare(&body, kStep);
    btFemChamber chamber = cavityOf(body);
    chamber.m_pressure = 20000;
    world.fem().addChamber(&body, chamber);
    world.step(120);
    btAlignedObjectArray<btFemActuatorReport> all;
    ASSERT_TRUE(world.fem().getActuators(&body, all));
    // Plain elements of 50, 25, 17 and 12.5 mm have .122, .171, .189 and .198, accurate ones .178, .198 and .207.
    EXPECT_NEAR(all[0].m_volume / 1e-3 - 1, 0.207, 0.15 * 0.207);
}
INSTANTIATE_TEST_SUITE_P(Actuators, EachWorld, eachWorld(), nameOfWorld);

class ActuatorSnapshot : public testing::TestWithParam<Coupling>
{
};

TEST_P(ActuatorSnapshot, ContinuesBitForBit)
{
    SnapshotScene scene(GetParam());
    scene.addTower();
    btSoftBody& hollow = addHollowCube(scene.m_world, scene.m_fem, {4, 0, btScalar(0.01)});
    scene.m_soft.push_back(&hollow);
    scene.m_fem.prepare(&hollow, kStep);
    btFemChamber chamber = cavityOf(hollow);
    chamber.m_sealed = true;
    chamber.m_gas = 130;
    const int gas = scene.m_fem.addChamber(&hollow, chamber);
    btFemCable cable = cableThrough({corner(0, 0), corner(1, 0)});
    cable.m_stiffness = 1000;
    cable.m_restLength = btScalar(0.28);
    const int tendon = scene.m_fem.addCable(&hollow, cable);
    btFemFibres fibres;
    fibres.m_directions = {{0, 0, 1}};
    fibres.m_activation = 3000;
    const int muscle = scene.m_fem.addFibres(&hollow, fibres);
    scene.m_world.step(40);
    const SnapshotScene::Saved saved = scene.saveAll();
    const std::vector<double> bits = scene.run(60);
    scene.m_fem.setChamberPressure(&hollow, gas, 9000);
    scene.m_fem.removeActuator(&hollow, tendon);
    scene.m_fem.setActivation(&hollow, muscle, 0);
    scene.m_world.step(10);
    scene.restore(saved);
    EXPECT_TRUE(scene.run(60) == bits);
    EXPECT_TRUE(scene.m_fem.setActivation(&hollow, muscle, 1));
}
INSTANTIATE_TEST_SUITE_P(Couplings, ActuatorSnapshot, testing::Values(Coupling::swap, Coupling::coupled));

}  // namespace
}  // namespace bullet_fem
