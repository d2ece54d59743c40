// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies with more points of contact than btFemSolverInfo::m_maxContacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

// Coupling, limit, on a soft slab or not.
class ContactLimitOfASlab : public testing::TestWithParam<std::tuple<Coupling, int, bool>>
{
};

TEST_P(ContactLimitOfASlab, LetsItRestWithItsWeight)
{
    const auto [coupling, limit, onSoft] = GetParam();
    constexpr double thickness = 0.1;  // [m]
    btFemSolverInfo info;
    info.m_maxContacts = limit;
    FemWorld world(WorldClass::softRigid, coupling, {0, 0, btScalar(-kGravity)}, info);
    btRigidBody& floor = world.addFloorBox();
    SoftBox box;
    box.m_size = {1, 1, thickness};
    box.m_cells = {20, 20, 1};  // 441 nodes on a side
    box.m_youngModulus = 1e6;
    box.m_center = {0, 0, thickness / 2};
    box.m_bending = limit > 32 ? btFemBending::accurate : btFemBending::plain;  // sags by 3 mm between 32 points
    btSoftBody* lower = nullptr;
    if (onSoft)
    {
        lower = &addSoftBox(world, world.fem(), box);
        box.m_center.z += thickness;
    }
    btSoftBody& slab = addSoftBox(world, world.fem(), box);
    for (btSoftBody* body : {&slab, lower})
    {
        if (!body) continue;
        body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        body->setActivationState(DISABLE_DEACTIVATION);
    }
    world.step(150);
    double fastest = 0, force = 0, lowest = thickness, lowestOfBoth = thickness;
    constexpr int kSteps = 30;
    for (int k = 0; k < kSteps; ++k)
    {
        world.step();
        fastest = std::max(fastest, fastestNode(slab));
        force +=
            (lower ? world.fem().contactForce(&slab, lower) : world.fem().contactForce(&slab, &floor)).z() / kSteps;
        lowest = std::min(lowest, lowestHeight(slab));
        lowestOfBoth = std::min({lowestOfBoth, lowest, lower ? lowestHeight(*lower) : lowest});
    }
    EXPECT_NEAR(force / (massOf(slab) * kGravity), 1, 1e-3);
    EXPECT_LT(fastest, 1e-3);
    EXPECT_GT(lowestOfBoth, -2e-3);  // it sags between the points
    EXPECT_GT(lowest, (lower ? thickness : 0) - 4e-3);
    const bool isLimited = (world.fem().stepReport(&slab).m_flags & BT_FEM_CONTACT_LIMIT) != 0;
    EXPECT_EQ(isLimited && !lower, limit < 441 && !lower);
}

std::string nameOfSlab(const testing::TestParamInfo<std::tuple<Coupling, int, bool>>& suite)
{
    return std::string(couplingName(std::get<0>(suite.param))) + "_" + std::to_string(std::get<1>(suite.param));
}

INSTANTIATE_TEST_SUITE_P(OnAFloor, ContactLimitOfASlab,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(32, 64, 128, 256, 400, 2000), testing::Values(false)),
                         nameOfSlab);

// Between 64 points slabs sag by 5 mm.
INSTANTIATE_TEST_SUITE_P(OnASoftSlab, ContactLimitOfASlab,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(128, 256, 400, 2000), testing::Values(true)),
                         nameOfSlab);

}  // namespace
}  // namespace bullet_fem
