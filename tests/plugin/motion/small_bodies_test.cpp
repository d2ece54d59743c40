// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

// The dropped body and its ground.
enum class Drop
{
    softOnGround,
    rigidOnSoft,
    softOnSoft
};

const char* dropName(Drop drop)
{
    return drop == Drop::softOnGround ? "softOnGround" : drop == Drop::rigidOnSoft ? "rigidOnSoft" : "softOnSoft";
}

class EverySize : public testing::TestWithParam<std::tuple<Coupling, Drop, int, double>>
{
protected:
    // Rubber; a cube above a metre would be compressed by its weight.
    static btSoftBody& addCube(FemWorld& world, double size, double bottom)
    {
        SoftBox box;
        box.m_size = {size, size, size};
        box.m_center = {0, 0, bottom + size / 2};
        box.m_youngModulus = btScalar(2e6 * std::max(1.0, size));
        box.m_density = 1100;
        return addSoftBox(world, world.fem(), box);
    }
};

// In a step of 1/60 s gravity moves a free body by 2.7 mm, which is the size of these. Two cubes one above the other
// would both fall freely, although the ground holds the lower one.
TEST_P(EverySize, DroppedBodiesAreNeitherLostNorSinkIn)
{
    const auto& [coupling, drop, frequency, size] = GetParam();
    const btScalar step = btScalar(1) / btScalar(frequency);
    for (const double height : {0.0, 0.25, 0.75})  // in sizes
    {
        SCOPED_TRACE(testing::Message() << "from " << height);
        FemWorld world(WorldClass::softRigid, coupling);
        world.addFloorBox();
        const double ground = drop == Drop::softOnGround ? height * size : 0, upper = (1 + height) * size;
        btSoftBody& lower = addCube(world, size, ground);
        const double half = size / 4;
        btRigidBody* box = nullptr;
        btSoftBody* other = nullptr;
        if (drop == Drop::rigidOnSoft)
            box = &addRigidBox(world, {2 * half, 2 * half, 2 * half},
                               {btScalar(massOf(lower) / 8), at(0, 0, btScalar(upper + half))});
        else if (drop == Drop::softOnSoft)
            other = &addCube(world, size, upper);
        const auto bottom = [&]
        {
            if (box) return double(box->getWorldTransform().getOrigin().z()) - half;
            return lowestHeight(other ? *other : lower);
        };
        const double rest = drop == Drop::softOnGround ? 0 : size;  // plus the cube's compression
        const int steps = static_cast<int>(frequency * (2 + 3 * std::sqrt(size)));
        double before = 0;
        for (int k = 0; k < steps; ++k)
        {
            before = bottom();
            world.step(1, step);
            ASSERT_TRUE(allFinite(lower));
            ASSERT_GT(bottom(), rest - 0.15 * size) << "step " << k;
            ASSERT_GT(lowestHeight(lower), -0.02 * size) << "step " << k;
        }
        EXPECT_NEAR(bottom(), rest, 0.02 * size);
        EXPECT_LT(world.fem().stepReport(&lower).m_deepestPenetration, 0.01 * size);
        EXPECT_LT(std::fabs(bottom() - before), 1e-2 * std::sqrt(kGravity * size) * step) << "at rest";
        if (!box) continue;
        const btVector3& place = box->getWorldTransform().getOrigin();
        EXPECT_LT(std::hypot(place.x(), place.y()), 0.02 * size);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, EverySize,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(Drop::softOnGround, Drop::rigidOnSoft, Drop::softOnSoft),
                                          testing::Values(60, 240),
                                          testing::Values(0.001, 0.002, 0.004, 0.008, 0.012, 0.02, 0.1, 1., 10.)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) + "_" +
                                    dropName(std::get<1>(suite.param)) + "_" +
                                    std::to_string(std::get<2>(suite.param)) + "Hz_" +
                                    std::to_string(std::lround(1000 * std::get<3>(suite.param))) + "mm";
                         });

class Grain : public testing::TestWithParam<std::tuple<Coupling, double>>
{
};

// A box smaller than the triangles below it: on a triangle, across an edge or at a node.
TEST_P(Grain, LiesOnACoarseSlab)
{
    const auto& [coupling, half] = GetParam();
    for (const double aside : {0.0, 0.007, 0.0125})  // from a node [m]
        for (const double height : {0.0, 1.5})       // in half edges
        {
            SCOPED_TRACE(testing::Message() << aside << " m aside from " << height);
            FemWorld world(WorldClass::softRigid, coupling);
            world.addFloorBox();
            SoftBox slab;
            slab.m_size = {0.2, 0.2, 0.1};
            slab.m_cells = {8, 8, 4};
            slab.m_center = {0, 0, 0.05};
            btSoftBody& soft = addSoftBox(world, world.fem(), slab);
            const double mass = 2000 * 8 * half * half * half;
            btRigidBody& grain = addRigidBox(
                world, {2 * half, 2 * half, 2 * half},
                {btScalar(mass), at(btScalar(aside), btScalar(aside / 2), btScalar(0.1 + (1 + height) * half))});
            world.step(180);
            const btVector3 place = grain.getWorldTransform().getOrigin();
            EXPECT_NEAR(place.z(), 0.1 + half, 0.05 * half + 1e-4);  // the slab is compressed by its weight
            EXPECT_NEAR(std::hypot(place.x() - aside, place.y() - aside / 2), 0, 0.1 * half);
            EXPECT_LT(world.fem().stepReport(&soft).m_deepestPenetration, 0.02 * half);
        }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Grain,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(0.001, 0.002, 0.004, 0.008)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) + "_" +
                                    std::to_string(std::lround(2000 * std::get<1>(suite.param))) + "mm";
                         });

}  // namespace
}  // namespace bullet_fem
