// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

/// A falling stack of rigid boxes and a chain, and far from them a soft cube with a stone on it.
class RigidBesideSoft
{
public:
    explicit RigidBesideSoft(Coupling coupling) : m_world(m_fem, coupling)
    {
        m_world.addFloorBox();
        RigidSettings settings;
        settings.m_mass = 2;
        for (int k = 0; k < 5; ++k)
        {
            settings.m_transform = at(btScalar(0.07 * k), btScalar(0.01 * k), btScalar(0.15 + 0.31 * k));
            m_bodies.push_back(&addRigidBox(m_world, {0.3, 0.3, 0.3}, settings));
        }
        for (int k = 0; k < 4; ++k)
        {
            settings.m_transform = at(btScalar(3 + 0.3 * k), 0, 2);
            m_bodies.push_back(&addRigidBox(m_world, {0.2, 0.1, 0.1}, settings));
            const btVector3 end(btScalar(0.15), 0, 0);
            m_joints.push_back(k == 0 ? std::make_unique<btPoint2PointConstraint>(*m_bodies.back(), -end)
                                      : std::make_unique<btPoint2PointConstraint>(*m_bodies[m_bodies.size() - 2],
                                                                                  *m_bodies.back(), end, -end));
            m_world.world().addConstraint(m_joints.back().get());
        }
        SoftBox cube;
        cube.m_center = {-10, 0, 0.501};
        m_soft = &addSoftBox(m_world, m_fem, cube);
        settings.m_transform = at(-10, 0, btScalar(1.3));
        addRigidBox(m_world, {0.4, 0.4, 0.4}, settings);
    }
    ~RigidBesideSoft()
    {
        for (auto& joint : m_joints) m_world.world().removeConstraint(joint.get());
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody* m_soft;
    std::vector<btRigidBody*> m_bodies;  // far from the soft one
    std::vector<std::unique_ptr<btTypedConstraint>> m_joints;
};

class IslandsWithoutFemBodies : public testing::TestWithParam<int>
{
};

TEST_P(IslandsWithoutFemBodies, AreSolvedBitForBitAsByBulletsOwnSolver)
{
    RigidBesideSoft plain(Coupling::swap), coupled(Coupling::coupled);
    for (RigidBesideSoft* scene : {&plain, &coupled})
        scene->m_world.world().getSolverInfo().m_minimumSolverBatchSize = GetParam();
    int touching = 0;
    for (int k = 0; k < 200; ++k)
    {
        plain.m_world.step();
        coupled.m_world.step();
        for (std::size_t b = 0; b < plain.m_bodies.size(); ++b)
            ASSERT_EQ(bitsOf(*coupled.m_bodies[b]), bitsOf(*plain.m_bodies[b])) << "body " << b << ", step " << k;
        touching += coupled.m_fem.contacts(coupled.m_soft).size() > 0;
    }
    EXPECT_GT(touching, 100);
}

// The maximum number of bodies that Bullet batches into one island solve; 128 is its default.
INSTANTIATE_TEST_SUITE_P(OneIsland, IslandsWithoutFemBodies, testing::Values(1));
INSTANTIATE_TEST_SUITE_P(SeveralIslands, IslandsWithoutFemBodies, testing::Values(128));

/// Makes equal bodies, in the order of their addresses or in reverse.
template <class Body, class Make>
std::vector<Body*> inOrderOfAddress(int count, bool descending, Make make)
{
    std::vector<Body*> bodies;
    for (int k = 0; k < count; ++k) bodies.push_back(make());
    std::sort(bodies.begin(), bodies.end(), std::less<Body*>());
    if (descending) std::reverse(bodies.begin(), bodies.end());
    return bodies;
}

/// Three soft cubes and four stones that fall on each other.
class Heap
{
public:
    Heap(Coupling coupling, bool descending) : m_world(m_fem, coupling), m_stone(btVector3(0.1f, 0.1f, 0.1f))
    {
        m_world.addFloorBox();
        m_soft = inOrderOfAddress<btSoftBody>(3, descending,
                                              [this] {
                                                  return btFemHelpers::createBox(m_world.info(), btVector3(0, 0, 0),
                                                                                 btVector3(0.2f, 0.2f, 0.2f), 0.14f);
                                              });
        for (int k = 0; k < 3; ++k)
        {
            m_soft[k]->translate(btVector3(0.3f * k - 0.3f, 0.05f * k, 0.25f + 0.45f * (k % 2)));
            m_world.addSoft(m_soft[k]);
        }
        btVector3 inertia;
        m_stone.calculateLocalInertia(5, inertia);
        m_rigid = inOrderOfAddress<btRigidBody>(4, descending,
                                                [&] { return new btRigidBody(5, nullptr, &m_stone, inertia); });
        for (int k = 0; k < 4; ++k)
        {
            m_rigid[k]->setCenterOfMassTransform(at(0.25f * k - 0.4f, 0.03f * k, 1.3f + 0.22f * (k % 2)));
            m_rigid[k]->setActivationState(DISABLE_DEACTIVATION);
            m_world.world().addRigidBody(m_rigid[k]);
        }
    }
    ~Heap()
    {
        for (btRigidBody* stone : m_rigid)
        {
            m_world.world().removeRigidBody(stone);
            delete stone;
        }
    }

    std::vector<btScalar> run()
    {
        std::vector<btScalar> bits;
        for (int k = 0; k < 150; ++k)
        {
            m_world.step();
            for (const btSoftBody* cube : m_soft)
                for (const btScalar value : bitsOf(*cube)) bits.push_back(value);
            for (const btRigidBody* stone : m_rigid)
                for (const btScalar value : bitsOf(*stone)) bits.push_back(value);
        }
        return bits;
    }

    int contacts() const
    {
        int sum = 0;
        for (const btSoftBody* cube : m_soft) sum += m_fem.contacts(cube).size();
        return sum;
    }

private:
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btBoxShape m_stone;
    std::vector<btSoftBody*> m_soft;
    std::vector<btRigidBody*> m_rigid;
};

class Repeated : public testing::TestWithParam<Coupling>
{
};

TEST_P(Repeated, GivesTheSameBits)
{
    Heap first(GetParam(), false);
    const std::vector<btScalar> bits = first.run();
    EXPECT_GT(first.contacts(), 20);
    EXPECT_TRUE(Heap(GetParam(), false).run() == bits);
}

TEST_P(Repeated, GivesTheSameBitsAtOtherAddresses)
{
    Heap ascending(GetParam(), false), descending(GetParam(), true);
    EXPECT_TRUE(descending.run() == ascending.run());
}

INSTANTIATE_TEST_SUITE_P(Solvers, Repeated, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

}  // namespace
}  // namespace bullet_fem
