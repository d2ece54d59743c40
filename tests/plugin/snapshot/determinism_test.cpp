// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "plugin/scenes/each_world.h"
#include "plugin/scenes/snapshot_scene.h"

namespace bullet_fem
{
namespace
{

/// Allocates blocks of all sizes and frees every other one, so that later allocations have arbitrary addresses.
class Junk
{
public:
    explicit Junk(unsigned start)
    {
        std::mt19937 random(start);
        for (int k = 0; k < 4000; ++k) m_pieces.push_back(std::make_unique<char[]>(16 + random() % 6000));
        std::shuffle(m_pieces.begin(), m_pieces.end(), random);
        m_pieces.resize(m_pieces.size() / 2);
    }

private:
    std::vector<std::unique_ptr<char[]>> m_pieces;
};

class Determinism : public EachWorldWith<Coupling>
{
protected:
    const int m_steps = worldClass() == WorldClass::softRigid ? 120 : 24;

    std::vector<double> reference() const
    {
        SnapshotScene scene(value(), {}, worldClass());
        scene.build();
        return scene.run(m_steps);
    }
};

TEST_P(Determinism, HoldsForAnotherLayoutOfAddresses)
{
    const std::vector<double> bits = reference();
    const Junk before(1);
    SnapshotScene scene(value(), {}, worldClass());
    scene.addTower();
    const Junk between(2);
    scene.addSlope();
    scene.addBeam();
    const Junk later(3);
    scene.addMesh();
    scene.addCouple();
    std::vector<double> other = scene.run(m_steps / 2);
    const Junk within(4);
    const std::vector<double> rest = scene.run(m_steps / 2);
    other.insert(other.end(), rest.begin(), rest.end());
    EXPECT_TRUE(other == bits);
}

TEST_P(Determinism, HoldsAfterOtherBodiesCameAndWent)
{
    const std::vector<double> bits = reference();
    SnapshotScene scene(value(), {}, worldClass());
    btRigidBody& ground = scene.m_world.addFloorBox();
    std::vector<btSoftBody*> guests;
    for (int k = 0; k < 3; ++k)
        guests.push_back(
            &addSoftBox(scene.m_world, scene.m_fem, {{1, 1, 0.5}, {3, 3, 2}, {0.1 * k, 0, 0.3 + 0.6 * k}}));
    // Copies of the scene's bodies at other places, which differ in rounding.
    guests.push_back(&addSoftBox(scene.m_world, scene.m_fem, {{1, 1, 0.5}, {4, 4, 2}, {17.3, -5.7, 1}}));
    guests.push_back(&addSoftBox(scene.m_world, scene.m_fem, {{1.6, 0.4, 0.4}, {8, 2, 2}, {33.3, 1.7, 1}}));
    btRigidBody& stone = addRigidBox(scene.m_world, {0.3, 0.3, 0.3}, {10, at(0, 0, btScalar(2.2))});
    scene.m_world.step(40);
    for (btSoftBody* guest : {guests[1], guests[4], guests[0], guests[3], guests[2]}) scene.m_world.deleteSoft(*guest);
    scene.m_world.deleteRigid(stone);
    scene.m_world.deleteRigid(ground);
    scene.m_world.step();  // preparing before a step would share the copies' factors
    scene.build();
    EXPECT_TRUE(scene.run(m_steps) == bits);
}

INSTANTIATE_TEST_SUITE_P(Swap, Determinism, testing::Combine(eachWorld(), testing::Values(Coupling::swap)),
                         nameOfWorldWith(couplingName));
INSTANTIATE_TEST_SUITE_P(Coupled, Determinism,
                         testing::Combine(testing::Values(WorldClass::softRigid), testing::Values(Coupling::coupled)),
                         nameOfWorldWith(couplingName));

}  // namespace
}  // namespace bullet_fem
