// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// Neo-Hookean bodies in Bullet's worlds (docs/materials.md, Large strain).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kEdgeOfCrushed = 0.5, kTenth = 0.1 * kEdgeOfCrushed, kPlateHalf = 0.1;  // [m]

btFemMaterial gel()
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e4);
    material.m_poissonRatio = btScalar(0.3);
    material.m_density = 200;
    material.m_law = btFemElasticLaw::neoHooke;
    return material;
}

class NeoHookeInWorlds : public testing::TestWithParam<Coupling>
{
};

// A plate compresses the cube on the floor to a tenth of its height, stays, and moves up again.
TEST_P(NeoHookeInWorlds, ACrushedCubeComesBack)
{
    FemWorld world(WorldClass::softRigid, GetParam());
    world.addFloorBox();
    SoftBox box;
    box.m_size = {kEdgeOfCrushed, kEdgeOfCrushed, kEdgeOfCrushed};
    box.m_center = {0, 0, kEdgeOfCrushed / 2};
    btSoftBody& cube = addSoftBox(world, world.fem(), box);
    world.fem().setMaterial(&cube, gel());
    btRigidBody& plate =
        addRigidBox(world, {2, 2, 2 * kPlateHalf}, {0, at(0, 0, btScalar(kEdgeOfCrushed + kPlateHalf))});
    plate.setCollisionFlags(plate.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    plate.setActivationState(DISABLE_DEACTIVATION);
    const btScalar friction = cube.m_cfg.kDF;
    cube.m_cfg.kDF = 0;  // otherwise friction holds the base strained, now and at the end
    world.step(60);
    const std::vector<Vec3> rest = edgesOf(cube);
    double lowest = 1, most = 0;
    for (int k = 1; k <= 600; ++k)  // two seconds down, one at rest, two up, and five to settle
    {
        cube.m_cfg.kDF = k < 480 ? friction : 0;
        const double way = std::clamp(std::min(k / 120.0, (300 - k) / 120.0), 0.0, 1.0);
        const double height = kEdgeOfCrushed + (kTenth - kEdgeOfCrushed) * way;
        plate.getMotionState()->setWorldTransform(at(0, 0, btScalar(height + kPlateHalf)));
        world.step();
        ASSERT_TRUE(allFinite(cube)) << k;
        double top = 0;
        for (int i = 0; i < cube.m_nodes.size(); ++i) top = std::max(top, double(cube.m_nodes[i].m_x.z()));
        lowest = std::min(lowest, top);
        most = std::max(most, fastestNode(cube));
    }
    EXPECT_LT(lowest, 1.2 * kTenth);
    EXPECT_LT(most, 5);  // the plate moves at .23 m/s
    EXPECT_LT(fastestNode(cube), 0.01);
    const std::vector<Vec3> after = edgesOf(cube);
    for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_NEAR(norm(after[i]), norm(rest[i]), 0.001 * kEdgeOfCrushed);
}

// The cube's contact force on the floor is its weight, plus that of a rigid body on it.
TEST_P(NeoHookeInWorlds, RestsUnderALoadAndPressesWithIts)
{
    FemWorld world(WorldClass::softRigid, GetParam());
    btRigidBody& floor = world.addFloorBox();
    SoftBox box;
    box.m_size = {kEdgeOfCrushed, kEdgeOfCrushed, kEdgeOfCrushed};
    box.m_center = {0, 0, kEdgeOfCrushed / 2};
    btSoftBody& cube = addSoftBox(world, world.fem(), box);
    world.fem().setMaterial(&cube, gel());
    constexpr double kLoad = 100;  // [kg]: a fifth of E
    addRigidBox(world, {1, 1, 0.1}, {btScalar(kLoad), at(0, 0, btScalar(kEdgeOfCrushed + 0.05))});
    world.step(480);
    const double weight = (massOf(cube) + kLoad) * kGravity;
    EXPECT_NEAR(world.fem().contactForce(&cube, &floor).z(), weight, 0.01 * weight);
    EXPECT_LT(fastestNode(cube), 0.01);
}
INSTANTIATE_TEST_SUITE_P(Couplings, NeoHookeInWorlds, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

}  // namespace
}  // namespace bullet_fem
