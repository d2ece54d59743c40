// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Soft blocks that slide over soft slabs side by side.
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

constexpr double kSlabFriction = 0.3;  // of all surfaces [-]

// Coupling, gap between the slabs [m], steps a second.
class SoftSeams : public testing::TestWithParam<std::tuple<Coupling, double, int>>
{
protected:
    // A slab from x = `from` on with fixed lower face, whose upper face is z = 0.
    static btSoftBody& addSlab(FemWorld& world, double from, double length)
    {
        constexpr double cell = 0.1;  // [m]
        SoftBox box;
        box.m_size = {length, 0.6, 2 * cell};
        box.m_cells = {static_cast<int>(std::lround(length / cell)), 6, 2};
        box.m_center = {from + length / 2, 0, -cell};
        box.m_friction = btScalar(kSlabFriction);
        btSoftBody& slab = addSoftBox(world, world.fem(), box);
        clampBelow(slab, -1.99 * cell);
        slab.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        return slab;
    }
};

TEST_P(SoftSeams, DoNotStopSlidingSoftBlocks)
{
    const auto [coupling, gap, frequency] = GetParam();
    const double step = 1.0 / frequency;
    for (const double speed : {1.0, 2.5, 6.0})
    {
        const double seconds = 0.5 * speed / kSlabFriction / kGravity, way = 0.75 * speed * seconds;
        FemWorld world(WorldClass::softRigid, coupling);
        addSlab(world, -1, 1);
        addSlab(world, gap, std::ceil(10 * way) / 10);
        SoftBox box;
        box.m_size = {0.3, 0.3, 0.2};
        box.m_cells = {3, 3, 2};
        box.m_center = {-0.2, 0, 0.1};
        box.m_friction = btScalar(kSlabFriction);
        btSoftBody& block = addSoftBox(world, world.fem(), box);
        block.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        world.step(frequency / 2, btScalar(step));
        for (int i = 0; i < block.m_nodes.size(); ++i) block.m_nodes[i].m_v = btVector3(btScalar(speed), 0, 0);
        const double height = centerOf(block).z;
        double lifted = 0;
        const int steps = static_cast<int>(std::ceil(seconds / step));
        for (int k = 0; k < steps; ++k)
        {
            world.step(1, btScalar(step));
            lifted = std::max(lifted, centerOf(block).z - height);
        }
        const double brake = (speed - velocityOf(block).x) / (steps * step * kSlabFriction * kGravity);
        EXPECT_NEAR(brake, 1, 0.02) << speed << " m/s";
        EXPECT_LT(lifted, 2e-3) << speed << " m/s";
    }
}

INSTANTIATE_TEST_SUITE_P(Gaps, SoftSeams,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(0.0, 0.01, 0.05), testing::Values(60, 240)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) + "_" +
                                    std::to_string(std::lround(1000 * std::get<1>(suite.param))) + "mm_" +
                                    std::to_string(std::get<2>(suite.param)) + "Hz";
                         });

}  // namespace
}  // namespace bullet_fem
