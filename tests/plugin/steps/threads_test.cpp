// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>

#include "bullet_fem/btFemHelpers.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "support/thread_sanitizer.h"

namespace bullet_fem
{
namespace
{

const int g_counts[] = {1, 2, 3, 8};

btFemSolverInfo withThreads(int count)
{
    btFemSolverInfo info;
    info.m_threads = count;
    return info;
}

/// Seven soft boxes of different sizes, a soft column of 4,320 tetrahedra and three stones fall on a heap.
class Heap
{
public:
    Heap(Coupling coupling, int threads) : m_fem(withThreads(threads)), m_world(m_fem, coupling)
    {
        m_world.addFloorBox();
        for (int k = 0; k < 8; ++k)
        {
            SoftBox box;
            box.m_size = {0.3, 0.3, 0.3};
            box.m_cells = {2 + k % 3, 3, 2};
            box.m_center = {0.32 * (k % 3), 0.03 * k, 0.16 + 0.31 * (k / 3)};
            box.m_youngModulus = btScalar(1e5 * (1 + k));
            if (k == 3) box = column();
            m_soft.push_back(&addSoftBox(m_world, m_fem, box));
        }
        for (int k = 0; k < 3; ++k)
            m_rigid.push_back(&addRigidBox(m_world, {0.2, 0.2, 0.2}, {5, at(0.32f * k - 0.05f, 0.1f, 1.1f)}));
    }

    std::vector<btScalar> run(int steps)
    {
        std::vector<btScalar> bits;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (const btSoftBody* soft : m_soft) append(bitsOf(*soft), bits);
            for (const btRigidBody* stone : m_rigid) append(bitsOf(*stone), bits);
            for (const btSoftBody* soft : m_soft)
            {
                const btFemStepReport& report = m_fem.stepReport(soft);
                append({btScalar(report.m_iterations), btScalar(report.m_contactIterations), btScalar(report.m_flags)},
                       bits);
                m_mostContacts = std::max(m_mostContacts, report.m_contacts);
            }
        }
        return bits;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    std::vector<btSoftBody*> m_soft;
    std::vector<btRigidBody*> m_rigid;
    int m_mostContacts = 0;

private:
    // Large enough that its own work is divided among threads.
    static SoftBox column()
    {
        SoftBox box;
        box.m_size = {0.3, 0.3, 1.2};
        box.m_cells = {6, 6, 24};
        box.m_center = {-0.32, 0.09, 0.61};
        return box;
    }

    static void append(const std::vector<btScalar>& values, std::vector<btScalar>& bits)
    {
        bits.insert(bits.end(), values.begin(), values.end());
    }
};

class SharedWorld : public testing::TestWithParam<Coupling>
{
};

TEST_P(SharedWorld, GivesTheSameBitsForEveryNumberOfThreads)
{
    Heap alone(GetParam(), 1);
    const std::vector<btScalar> bits = alone.run(stepsOnThreads(60));
    EXPECT_GT(alone.m_mostContacts, 20);
    for (const int count : g_counts) EXPECT_TRUE(Heap(GetParam(), count).run(stepsOnThreads(60)) == bits) << count;
}

// One body's mesh is rejected, another's velocity becomes NaN: the others move bitwise as on one thread.
TEST_P(SharedWorld, LosesNoBodyBesideABadOne)
{
    const auto run = [](int threads)
    {
        Heap heap(GetParam(), threads);
        btSoftBody& flat = addUnitCube(heap.m_world, btVector3(20, 0, 5));
        for (int i = 0; i < flat.m_nodes.size(); ++i) flat.m_nodes[i].m_x.setZ(5);
        flat.initializeDmInverse();  // the flat shape becomes its rest shape
        heap.run(2);
        heap.m_soft[5]->m_nodes[0].m_v.setX(std::numeric_limits<btScalar>::quiet_NaN());
        const std::vector<btScalar> bits = heap.run(10);
        EXPECT_TRUE(heap.m_fem.stepReport(&flat).m_flags & BT_FEM_REJECTED);
        for (const btSoftBody* soft : heap.m_soft)
        {
            EXPECT_TRUE(allFinite(*soft));
            EXPECT_TRUE(heap.m_fem.isFem(soft));
        }
        return bits;
    };
    const std::vector<btScalar> alone = run(1);
    EXPECT_TRUE(run(2) == alone);
    EXPECT_TRUE(run(8) == alone);
}

INSTANTIATE_TEST_SUITE_P(Solvers, SharedWorld, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

TEST(ThreadsOfASolver, BadCountsAreRejected)
{
    for (const int count : {-1, 257})
    {
        std::string why;
        EXPECT_FALSE(withThreads(count).valid(&why));
        EXPECT_NE(why.find(std::to_string(count)), std::string::npos) << why;
        EXPECT_NE(why.find("[0, 256]"), std::string::npos) << why;
        EXPECT_NE(why.find("1 is usual"), std::string::npos) << why;
        EXPECT_THROW(btFemSoftBodySolver{withThreads(count)}, std::invalid_argument);
    }
    for (const int count : {0, 1, 256}) EXPECT_TRUE(withThreads(count).valid());
    EXPECT_NO_THROW(btFemSoftBodySolver{withThreads(0)});
}

/// Processes pairs of soft bodies concurrently, as Bullet's multithreaded dispatcher does. Bullet's pools are not
/// thread-safe in this build, so algorithms are created beforehand, and rigid pairs are processed serially.
class ConcurrentDispatcher : public btCollisionDispatcher
{
public:
    ConcurrentDispatcher(btCollisionConfiguration* configuration, int threads)
        : btCollisionDispatcher(configuration), m_threads(threads)
    {
    }

    void dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info, btDispatcher*) override
    {
        std::vector<btBroadphasePair*> soft;
        btBroadphasePairArray& pairs = cache->getOverlappingPairArray();
        for (int k = 0; k < pairs.size(); ++k)
        {
            if (btSoftBody::upcast(first(pairs[k])) || btSoftBody::upcast(second(pairs[k])))
                soft.push_back(&pairs[k]);
            else
                getNearCallback()(pairs[k], *this, info);
        }
        for (btBroadphasePair* pair : soft)
            if (!pair->m_algorithm) pair->m_algorithm = algorithmOf(*pair);
        std::vector<std::thread> threads;
        for (int t = 0; t < m_threads; ++t)
            threads.emplace_back(
                [&, t]
                {
                    for (std::size_t k = t; k < soft.size(); k += m_threads) getNearCallback()(*soft[k], *this, info);
                });
        for (std::thread& thread : threads) thread.join();
        m_maxPairs = std::max(m_maxPairs, soft.size());
    }

    std::size_t m_maxPairs = 0;

private:
    static btCollisionObject* first(const btBroadphasePair& pair)
    {
        return static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
    }
    static btCollisionObject* second(const btBroadphasePair& pair)
    {
        return static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
    }
    static btCollisionObjectWrapper wrapperOf(const btCollisionObject& object)
    {
        return {nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1};
    }
    btCollisionAlgorithm* algorithmOf(const btBroadphasePair& pair)
    {
        const btCollisionObjectWrapper a = wrapperOf(*first(pair)), b = wrapperOf(*second(pair));
        return findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    }

    int m_threads;
};

/// A soft slab on a floor under a grid of stones, with soft cubes among them: each body has many pairs.
std::vector<btScalar> runSlab(int collisionThreads, bool manifolds)
{
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    ConcurrentDispatcher dispatcher(&configuration, collisionThreads);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver rigidSolver;
    btFemSolverInfo info;
    info.m_manifolds = manifolds;
    btFemSoftBodySolver fem(info);
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigidSolver, &configuration, &fem);
    world.setGravity(btVector3(0, 0, -10));
    world.getWorldInfo().m_gravity = world.getGravity();

    btBoxShape floor(btVector3(5, 5, 1)), stone(btVector3(0.1f, 0.1f, 0.1f));
    std::vector<std::unique_ptr<btRigidBody>> rigid;
    const auto addRigid = [&](btScalar mass, btCollisionShape& shape, const btTransform& place)
    {
        rigid.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, btVector3(1, 1, 1)));
        rigid.back()->setWorldTransform(place);
        rigid.back()->setActivationState(DISABLE_DEACTIVATION);
        world.addRigidBody(rigid.back().get());
    };
    std::vector<std::unique_ptr<btSoftBody>> soft;
    const auto addSoft = [&](const btVector3& center, const btVector3& half, btScalar cell)
    {
        soft.emplace_back(btFemHelpers::createBox(world.getWorldInfo(), center, half, cell));
        soft.back()->setActivationState(DISABLE_DEACTIVATION);
        world.addSoftBody(soft.back().get());
    };
    addRigid(0, floor, at(0, 0, -1));
    addSoft(btVector3(0, 0, 0.15f), btVector3(1, 1, 0.15f), 0.25f);
    for (int k = 0; k < 16; ++k) addRigid(1, stone, at(0.45f * (k % 4) - 0.7f, 0.45f * (k / 4) - 0.7f, 0.41f));
    for (int k = 0; k < 4; ++k) addSoft(btVector3(0.45f * k - 0.65f, 0.2f, 0.8f), btVector3(0.1f, 0.1f, 0.1f), 0.1f);

    std::vector<btScalar> bits;
    for (int k = 0; k < stepsOnThreads(40); ++k)
    {
        world.stepSimulation(kStep, 0);
        for (const auto& body : soft)
            for (const btScalar value : bitsOf(*body)) bits.push_back(value);
        for (const auto& body : rigid)
            for (const btScalar value : bitsOf(*body)) bits.push_back(value);
    }
    EXPECT_GT(dispatcher.m_maxPairs, 20u);
    EXPECT_GT(fem.contacts(soft[0].get()).size(), 20);
    for (const auto& body : soft) world.removeSoftBody(body.get());
    for (const auto& body : rigid) world.removeRigidBody(body.get());
    return bits;
}

class ConcurrentCollisions : public testing::TestWithParam<bool>
{
};

TEST_P(ConcurrentCollisions, FindTheSameContacts)
{
    const std::vector<btScalar> inTurn = runSlab(1, GetParam());
    for (const int threads : {2, 4, 7}) EXPECT_TRUE(runSlab(threads, GetParam()) == inTurn) << threads;
}

INSTANTIATE_TEST_SUITE_P(Algorithms, ConcurrentCollisions, testing::Bool(),
                         [](const auto& suite) { return suite.param ? "WithManifolds" : "Bullets"; });

}  // namespace
}  // namespace bullet_fem
