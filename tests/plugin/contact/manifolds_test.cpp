// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

btFemSolverInfo withManifolds()
{
    btFemSolverInfo info;
    info.m_manifolds = true;
    return info;
}

btSoftBody& addCube(SoftWorld& world, btScalar lowest, btScalar x = 0)
{
    btSoftBody& cube = addSmallCube(world, lowest, x);
    cube.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    return cube;
}

btRigidBody& addStone(SoftWorld& world, btScalar height)
{
    return addRigidBox(world, {0.2, 0.2, 0.2}, {10, at(0, 0, height)});
}

/// The manifolds between two objects, by Bullet's loop over manifolds.
std::vector<const btPersistentManifold*> manifoldsOf(SoftWorld& world, const btCollisionObject& a,
                                                     const btCollisionObject& b)
{
    std::vector<const btPersistentManifold*> found;
    btDispatcher& dispatcher = *world.bullet().getDispatcher();
    for (int k = 0; k < dispatcher.getNumManifolds(); ++k)
    {
        const btPersistentManifold* m = dispatcher.getManifoldByIndexInternal(k);
        const bool isTheirs =
            (m->getBody0() == &a && m->getBody1() == &b) || (m->getBody0() == &b && m->getBody1() == &a);
        if (isTheirs) found.push_back(m);
    }
    return found;
}

int countOf(SoftWorld& world)
{
    return world.bullet().getDispatcher()->getNumManifolds();
}

/// A cube at rest on a floor, with manifolds.
class Manifolds : public EachWorld
{
protected:
    void SetUp() override
    {
        m_cube = &addCube(m_world, btScalar(0.001));
        m_floor = &m_world.addFloorBox();  // added second, so that Bullet pairs them in the other order
        m_world.step(60);
    }

    const btPersistentManifold& manifold()
    {
        const auto found = manifoldsOf(m_world, *m_floor, *m_cube);
        EXPECT_EQ(found.size(), 1u);
        return *found.at(0);
    }

    FemWorld m_world{GetParam(), withManifolds()};
    btFemSoftBodySolver& m_fem = m_world.fem();
    btRigidBody* m_floor;
    btSoftBody* m_cube;
};

INSTANTIATE_TEST_SUITE_P(Worlds, Manifolds, eachWorld(), nameOfWorld);

TEST(ManifoldDefaults, MakeNoManifolds)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addFloorBox();
    addCube(world, btScalar(0.001));
    world.step(60);
    EXPECT_EQ(countOf(world), 0);
}

TEST_P(Manifolds, LeaveBulletsContactArraysWithTheBody)
{
    ASSERT_GT(m_cube->m_rcontacts.size(), 0);
    m_world.take(*m_cube);
    EXPECT_EQ(m_cube->m_rcontacts.size() + m_cube->m_faceRigidContacts.size(), 0);
    m_world.put(*m_cube);
}

TEST_P(Manifolds, HaveTheRigidBodyFirstAndAreLeftAloneByTheRigidSolver)
{
    EXPECT_EQ(countOf(m_world), 1);
    EXPECT_EQ(manifold().getBody0(), m_floor);
    EXPECT_EQ(manifold().getBody1(), m_cube);
    EXPECT_EQ(manifold().getContactProcessingThreshold(), -BT_LARGE_FLOAT);
}

TEST_P(Manifolds, HoldTheFourDeepestContactPoints)
{
    const auto& contacts = m_fem.contacts(m_cube);
    std::vector<btScalar> gaps;
    for (int k = 0; k < contacts.size(); ++k) gaps.push_back(contacts[k].m_gap);
    std::sort(gaps.begin(), gaps.end());
    ASSERT_GT(gaps.size(), 4u);
    ASSERT_EQ(manifold().getNumContacts(), 4);
    for (int k = 0; k < 4; ++k)
    {
        const btManifoldPoint& point = manifold().getContactPoint(k);
        EXPECT_EQ(point.getDistance(), gaps[k]);
        int matches = 0;
        for (int c = 0; c < contacts.size(); ++c)
        {
            if ((contacts[c].m_point - point.getPositionWorldOnB()).length() > 1e-6) continue;
            ++matches;
            EXPECT_EQ(point.getAppliedImpulse(), contacts[c].m_normalImpulse);
            const btVector3 friction = point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                       point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
            const double most = 1e-5 * contacts[c].m_impulse.length();
            EXPECT_LE((friction + contacts[c].m_frictionImpulse).length(), most);  // of the floor
        }
        EXPECT_EQ(matches, 1);
        EXPECT_LT((point.m_normalWorldOnB - btVector3(0, 0, -1)).length(), 1e-5);  // to the first, the floor
        const btVector3 apart = point.getPositionWorldOnA() - point.getPositionWorldOnB();
        EXPECT_NEAR(apart.dot(point.m_normalWorldOnB), point.getDistance(), 1e-6);
        EXPECT_LT((m_floor->getWorldTransform() * point.m_localPointA - point.getPositionWorldOnA()).length(), 1e-5);
        EXPECT_LT((point.m_localPointB - point.getPositionWorldOnB()).length(), 1e-6);
        EXPECT_FLOAT_EQ(point.m_combinedFriction, m_cube->m_cfg.kDF * m_floor->getFriction());
    }
}

TEST_P(Manifolds, PersistWhileTheContactLasts)
{
    const btPersistentManifold* first = &manifold();
    const int lifeTime = first->getContactPoint(0).getLifeTime();
    EXPECT_GT(lifeTime, 10);
    int user = 0;
    first->getContactPoint(0).m_userPersistentData = &user;
    m_world.step(10);
    EXPECT_EQ(&manifold(), first);
    EXPECT_EQ(first->getContactPoint(0).getLifeTime(), lifeTime + 10);
    EXPECT_EQ(first->getContactPoint(0).m_userPersistentData, &user);
}

TEST_P(Manifolds, EndWithTheContact)
{
    m_cube->translate(btVector3(0, 0, btScalar(0.05)));
    m_world.step();
    EXPECT_EQ(countOf(m_world), 0);
}

TEST_P(Manifolds, GoAtOnceWithTheRigidBody)
{
    m_world.deleteRigid(*m_floor);
    EXPECT_EQ(countOf(m_world), 0);
    m_world.step();
    EXPECT_EQ(countOf(m_world), 0);
}

TEST_P(Manifolds, GoAtOnceWithTheSoftBody)
{
    m_world.deleteSoft(*m_cube);
    EXPECT_EQ(countOf(m_world), 0);
    m_world.step();
    EXPECT_EQ(countOf(m_world), 0);
}

TEST_P(Manifolds, SurviveASolverForgettingTheBody)
{
    m_fem.forget(m_cube);
    m_world.step(2);
    EXPECT_EQ(countOf(m_world), 1);
}

TEST_P(Manifolds, PersistForASleepingBodyWithoutWakingIt)
{
    m_floor->forceActivationState(ISLAND_SLEEPING);
    m_cube->forceActivationState(ACTIVE_TAG);
    m_world.step(300);
    ASSERT_EQ(m_cube->getActivationState(), ISLAND_SLEEPING);
    EXPECT_EQ(manifold().getNumContacts(), 4);
    EXPECT_GT(manifold().getContactPoint(0).getAppliedImpulse() + manifold().getContactPoint(1).getAppliedImpulse(), 0);
}

TEST(ManifoldsOfWorlds, DieWithThemNotWithTheSolver)
{
    btFemSoftBodySolver fem(withManifolds());
    for (int k = 0; k < 2; ++k)
    {
        SoftWorld world(fem);
        world.addFloorBox();
        addCube(world, btScalar(0.001));
        world.step(30);
        EXPECT_EQ(countOf(world), 1);
    }
}

TEST(ManifoldsOfWorlds, OneDispatcherServesTwoSolversInTurn)
{
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    for (int k = 0; k < 2; ++k)
    {
        btFemSoftBodySolver fem(withManifolds());
        btDbvtBroadphase broadphase;
        btSequentialImpulseConstraintSolver rigid;
        btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigid, &configuration, &fem);
        world.setGravity(btVector3(0, 0, -10));
        world.getWorldInfo().m_gravity = world.getGravity();
        btBoxShape box(btVector3(1, 1, 1));
        btRigidBody ground(0, nullptr, &box);
        ground.setWorldTransform(at(0, 0, -1));
        world.addRigidBody(&ground);
        const std::unique_ptr<btSoftBody> cube(btFemHelpers::createBox(
            world.getWorldInfo(), btVector3(0, 0, btScalar(0.201)), btVector3(0.2, 0.2, 0.2), btScalar(0.1)));
        world.addSoftBody(cube.get());
        for (int step = 0; step < 30; ++step) world.stepSimulation(kStep, 0);
        EXPECT_EQ(dispatcher.getNumManifolds(), 1);
        world.removeSoftBody(cube.get());
        world.removeRigidBody(&ground);
        EXPECT_EQ(dispatcher.getNumManifolds(), 0);
    }
}

class ManifoldReporting : public testing::TestWithParam<Coupling>
{
};

TEST_P(ManifoldReporting, LeavesTheMotionBitIdentical)
{
    std::vector<btScalar> bits[2];
    btVector3 stones[2];
    for (const bool shown : {false, true})
    {
        btFemSolverInfo info;
        info.m_manifolds = shown;
        btFemSoftBodySolver fem(info);
        SoftWorld world(fem, GetParam());
        world.addFloorBox();
        btSoftBody &lower = addCube(world, btScalar(0.001)), &upper = addCube(world, btScalar(0.402));
        btRigidBody& stone = addStone(world, btScalar(0.92));
        world.step(120);
        EXPECT_EQ(countOf(world), shown ? 3 : 0);
        bits[shown] = bitsOf(lower);
        const std::vector<btScalar> more = bitsOf(upper);
        bits[shown].insert(bits[shown].end(), more.begin(), more.end());
        stones[shown] = stone.getWorldTransform().getOrigin();
    }
    EXPECT_EQ(bits[0], bits[1]);
    EXPECT_EQ(stones[0], stones[1]);
}

INSTANTIATE_TEST_SUITE_P(Solvers, ManifoldReporting, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& p) { return couplingName(p.param); });

TEST(ManifoldsOfSoftBodies, AreShownOfTwoNotOfOne)
{
    btFemSoftBodySolver fem(withManifolds());
    SoftWorld world(fem);
    world.addFloorBox();
    btSoftBody &lower = addCube(world, btScalar(0.001)), &upper = addCube(world, btScalar(0.402));
    lower.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
    world.step(60);
    const auto found = manifoldsOf(world, lower, upper);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(manifoldsOf(world, lower, lower).empty());
    ASSERT_GT(found[0]->getNumContacts(), 0);
    const btManifoldPoint& point = found[0]->getContactPoint(0);
    const btScalar towardsFirst = found[0]->getBody0() == &upper ? btScalar(1) : btScalar(-1);
    EXPECT_GT(point.m_normalWorldOnB.z() * towardsFirst, 0.9);
    EXPECT_NEAR(point.getPositionWorldOnA().z(), 0.4, 0.02);
    world.deleteSoft(upper);
    EXPECT_EQ(countOf(world), 1);
}

struct Ground
{
    const char* m_name;
    btCollisionShape* (*m_make)(SoftWorld&);
};

class ManifoldsOnShapes : public testing::TestWithParam<Ground>
{
};

TEST_P(ManifoldsOnShapes, AreOneForThePair)
{
    btFemSoftBodySolver fem(withManifolds());
    SoftWorld world(fem);
    btRigidBody& ground = world.addRigid(GetParam().m_make(world));
    btSoftBody& cube = addCube(world, btScalar(0.05));
    world.step(60);
    const auto found = manifoldsOf(world, ground, cube);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(countOf(world), 1);
    ASSERT_GT(found[0]->getNumContacts(), 0);
    const btManifoldPoint& point = found[0]->getContactPoint(0);
    int matches = 0;
    for (int k = 0; k < fem.contacts(&cube).size(); ++k)
    {
        const btFemContact& contact = fem.contacts(&cube)[k];
        matches += contact.m_point == point.getPositionWorldOnB() && contact.m_part == point.m_partId0 &&
                   contact.m_index == point.m_index0;
    }
    EXPECT_EQ(matches, 1);
    EXPECT_EQ(point.m_index1, -1);
    EXPECT_NEAR(massOf(cube) * kGravity, fem.contactForce(&cube, &ground).z(), 0.1 * massOf(cube) * kGravity);
}

btCollisionShape* plane(SoftWorld&)
{
    return new btStaticPlaneShape(btVector3(0, 0, 1), 0);
}

btCollisionShape* compound(SoftWorld& world)
{
    auto* shape = new btCompoundShape;
    for (const btScalar x : {btScalar(-3), btScalar(0)})
        shape->addChildShape(at(x, 0, -1), world.keep(new btBoxShape(btVector3(1, 1, 1))));
    return shape;
}

btCollisionShape* hill(SoftWorld&)
{
    static const std::vector<float> heights(9 * 9, 0.0f);
    auto* shape = new btHeightfieldTerrainShape(9, 9, heights.data(), btScalar(-1), btScalar(1), 2, false);
    shape->setLocalScaling(btVector3(btScalar(0.5), btScalar(0.5), 1));
    return shape;
}

INSTANTIATE_TEST_SUITE_P(Shapes, ManifoldsOnShapes,
                         testing::Values(Ground{"plane", plane}, Ground{"compound", compound}, Ground{"field", hill}),
                         [](const auto& p) { return p.param.m_name; });

int s_started, s_ended, s_added;

TEST(ManifoldCallbacks, TellTheBeginTheEndAndThePoints)
{
    s_started = s_ended = s_added = 0;
    gContactStartedCallback = [](btPersistentManifold* const&) { ++s_started; };
    gContactEndedCallback = [](btPersistentManifold* const&) { ++s_ended; };
    gContactAddedCallback = [](btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                               const btCollisionObjectWrapper* b, int, int)
    {
        s_added += a->getCollisionObject() != b->getCollisionObject() && point.getAppliedImpulse() >= 0;
        return false;
    };
    btFemSoftBodySolver fem(withManifolds());
    {
        SoftWorld world(fem);
        btRigidBody& floor = world.addFloorBox();
        addCube(world, btScalar(0.001));
        world.step(60);
        EXPECT_EQ(s_added, 0);  // no callback is set
        floor.setCollisionFlags(floor.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
        world.step(10);
        EXPECT_EQ(s_added, 40);
        EXPECT_EQ(s_started - s_ended, 1);
    }
    EXPECT_EQ(s_ended, s_started);
    gContactStartedCallback = gContactEndedCallback = nullptr;
    gContactAddedCallback = nullptr;
}

TEST(ManifoldsOfSprings, BodiesOfBulletKeepBulletsWays)
{
    std::vector<btScalar> bits[2];
    for (const bool fem : {false, true})
    {
        btFemSoftBodySolver solver(withManifolds());
        btDefaultSoftBodySolver bullet;
        SoftWorld world(fem ? static_cast<btSoftBodySolver&>(solver) : bullet);
        world.addPlane();
        world.addRigid(compound(world));
        if (fem) addCube(world, btScalar(0.2), 20);  // registers with the dispatcher, far away
        btSoftBody& ball = world.addSoft(
            btSoftBodyHelpers::CreateEllipsoid(world.info(), btVector3(0, 0, 1), btVector3(0.3, 0.3, 0.3), 64));
        world.step(60);
        bits[fem] = bitsOf(ball);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

}  // namespace
}  // namespace bullet_fem
