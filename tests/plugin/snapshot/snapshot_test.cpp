// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <string>

#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/snapshot_scene.h"

namespace bullet_fem
{
namespace
{

constexpr int kLong = 300;  ///< steps

btFemSolverInfo withThreads(int threads)
{
    btFemSolverInfo info;
    info.m_threads = threads;
    return info;
}

struct SnapshotCase
{
    Coupling m_coupling;
    int m_threads;
};

void expectToContinueInTheMidstOfContact(SnapshotScene& scene, int steps)
{
    scene.build();
    scene.m_world.step(40);
    ASSERT_GT(scene.contacts(), 50);
    const SnapshotScene::Saved saved = scene.saveAll();
    const std::vector<double> state = scene.state(), bits = scene.run(steps);
    scene.restore(saved);
    EXPECT_TRUE(scene.state() == state);
    EXPECT_TRUE(scene.save() == saved.m_fem);
    EXPECT_TRUE(scene.run(steps) == bits);
    scene.restore(saved);
    EXPECT_TRUE(scene.run(steps) == bits);
}

class Snapshot : public testing::TestWithParam<SnapshotCase>
{
protected:
    SnapshotScene m_scene{GetParam().m_coupling, withThreads(GetParam().m_threads)};
};

TEST_P(Snapshot, ContinuesBitForBitInTheMidstOfContact)
{
    expectToContinueInTheMidstOfContact(m_scene, kLong);
}

// The pending restitution of an impact is part of the saved state.
TEST_P(Snapshot, PendingRestitutionContinuesBitForBit)
{
    m_scene.addTower();
    for (btSoftBody* body : m_scene.m_soft) body->setRestitution(btScalar(0.8));
    for (btRigidBody* body : m_scene.m_rigid) body->setRestitution(1);
    m_scene.m_soft[1]->setVelocity({0, 0, -2});
    const auto impacts = [this]
    { return btFemCoupling::record(m_scene.m_fem, *m_scene.m_soft[0])->fem().m_memory.m_impacts.size(); };
    for (int k = 0; k < 20 && (k == 0 || impacts() == 0); ++k) m_scene.m_world.step();
    ASSERT_GT(impacts(), 0u);
    const SnapshotScene::Saved saved = m_scene.saveAll();
    const std::vector<double> bits = m_scene.run(40);
    EXPECT_EQ(impacts(), 0u);
    m_scene.restore(saved);
    EXPECT_TRUE(m_scene.save() == saved.m_fem);
    EXPECT_EQ(impacts(), 1u);
    EXPECT_TRUE(m_scene.run(40) == bits);
}

class SnapshotInOtherWorlds : public EachWorld
{
};

TEST_P(SnapshotInOtherWorlds, ContinuesBitForBitInTheMidstOfContact)
{
    SnapshotScene scene(Coupling::swap, {}, GetParam());
    expectToContinueInTheMidstOfContact(scene, 40);
}

INSTANTIATE_TEST_SUITE_P(Worlds, SnapshotInOtherWorlds,
                         testing::Values(WorldClass::softMultiBody, WorldClass::deformable), nameOfWorld);

TEST_P(Snapshot, BodiesFallingAsleepOrSleepingContinueBitForBit)
{
    m_scene.addSlab();
    m_scene.setState(ACTIVE_TAG);
    m_scene.m_rigid.back()->forceActivationState(DISABLE_DEACTIVATION);  // slow enough to fall asleep on its way
    m_scene.m_world.step(90);
    const SnapshotScene::Saved falling = m_scene.saveAll();
    std::vector<double> bits = m_scene.run(140);
    ASSERT_EQ(m_scene.m_soft[0]->getActivationState(), ISLAND_SLEEPING);
    const SnapshotScene::Saved sleeping = m_scene.saveAll();
    const std::vector<double> after = m_scene.run(kLong);
    ASSERT_EQ(m_scene.m_fem.touches(m_scene.m_soft[0]).size(), 3);  // and it was woken
    bits.insert(bits.end(), after.begin(), after.end());
    m_scene.restore(falling);
    EXPECT_NE(m_scene.m_soft[0]->getActivationState(), ISLAND_SLEEPING);
    EXPECT_TRUE(m_scene.run(140 + kLong) == bits);
    m_scene.restore(sleeping);
    EXPECT_EQ(m_scene.m_soft[0]->getActivationState(), ISLAND_SLEEPING);
    EXPECT_TRUE(m_scene.save() == sleeping.m_fem);
    EXPECT_TRUE(m_scene.run(kLong) == after);
    m_scene.restore(sleeping);
    m_scene.m_world.info().m_gravity *= 2;  // gravity during sleep is saved, too: the body wakes
    m_scene.m_world.step();
    EXPECT_NE(m_scene.m_soft[0]->getActivationState(), ISLAND_SLEEPING);
    m_scene.m_world.info().m_gravity /= 2;
    m_scene.restore(sleeping);
    m_scene.m_world.step();
    EXPECT_EQ(m_scene.m_soft[0]->getActivationState(), ISLAND_SLEEPING);
    m_scene.m_rigid.front()->setFriction(btScalar(0.1));  // and so is its neighbours' friction
    m_scene.restore(sleeping);
    m_scene.m_world.step();
    EXPECT_NE(m_scene.m_soft[0]->getActivationState(), ISLAND_SLEEPING);
}

TEST_P(Snapshot, IncludesBodiesAddedAsleep)
{
    m_scene.addTower();
    btSoftBody& asleep = *m_scene.m_soft[0];
    asleep.translate({50, 0, 0});  // nothing wakes it there
    asleep.setVelocity({0, 0, 1});
    asleep.forceActivationState(ISLAND_SLEEPING);
    m_scene.m_world.step();
    EXPECT_EQ(asleep.getActivationState(), ISLAND_SLEEPING);
    const SnapshotScene::Saved saved = m_scene.saveAll();
    asleep.activate();
    m_scene.m_world.step(3);
    ASSERT_TRUE(asleep.isActive());
    m_scene.restore(saved);
    EXPECT_EQ(asleep.getActivationState(), ISLAND_SLEEPING);
    EXPECT_TRUE(m_scene.save() == saved.m_fem);
}

TEST_P(Snapshot, UndoesTheUsersChanges)
{
    m_scene.build();
    m_scene.m_world.step(40);
    btSoftBody& beam = *m_scene.m_soft[3];
    btSoftBody &first = *m_scene.m_soft[5], &second = *m_scene.m_soft[6];
    beam.m_nodes[3].m_v += btVector3(0, 0, btScalar(0.1));  // before a step detects it
    beam.m_nodes[4].m_f = btVector3(1, 2, 3);
    const SnapshotScene::Saved saved = m_scene.saveAll();
    const std::vector<double> bits = m_scene.run(30);
    m_scene.m_fem.clearNodeTarget(&beam, beam.m_nodes.size() - 1);
    m_scene.m_fem.setNodeTarget(&beam, 5, beam.m_nodes[5].m_x);
    for (int i = 0; i < beam.m_nodes.size(); ++i) beam.setMass(i, 2);
    m_scene.m_fem.detach(&first, 1);
    m_scene.m_fem.attachNodes(&first, 0, &second, 5);
    first.translate(btVector3(1, 1, 1));
    m_scene.m_world.step(3);
    first.setMass(2, 0);
    m_scene.restore(saved);
    EXPECT_TRUE(m_scene.save() == saved.m_fem);
    EXPECT_TRUE(m_scene.run(30) == bits);
}

TEST_P(Snapshot, RecreatesItsFactor)
{
    const btScalar shorter = kStep / btScalar(1.3);  // stale, but not so much that contact refactors
    m_scene.addTower();
    m_scene.m_world.step(30);
    m_scene.m_world.step(2, shorter);
    const SnapshotScene::Saved saved = m_scene.saveAll();
    const std::vector<double> bits = m_scene.run(60, shorter);
    ASSERT_NE(m_scene.m_fem.stepReport(m_scene.m_soft[0]).m_flags & BT_FEM_STALE_FACTOR, 0);
    for (const btScalar h : {shorter, shorter / 2, shorter / 3})  // the first factor is evicted
        for (btSoftBody* body : m_scene.m_soft)
        {
            m_scene.m_world.step(1, h);
            m_scene.m_fem.refactor(body);
        }
    m_scene.restore(saved);
    EXPECT_TRUE(m_scene.save() == saved.m_fem);
    EXPECT_TRUE(m_scene.run(60, shorter) == bits);
}

TEST_P(Snapshot, BodyHeldByASpringContinuesBitForBit)
{
    m_scene.build();
    m_scene.m_world.step(2);
    btSoftBody* body = m_scene.m_soft[0];
    btFemSpring spring;
    spring.m_nodes[0] = 0;
    spring.m_target = body->m_nodes[0].m_x + btVector3(0, 0, 1);
    spring.m_stiffness = btScalar(500);
    spring.m_maxForce = btScalar(1000);
    const int handle = m_scene.m_fem.addSpring(body, spring);
    m_scene.m_world.step(30);
    const SnapshotScene::Saved saved = m_scene.saveAll();
    const std::vector<double> state = m_scene.state(), bits = m_scene.run(40);
    m_scene.restore(saved);
    EXPECT_TRUE(m_scene.state() == state);
    EXPECT_TRUE(m_scene.run(40) == bits);
    m_scene.m_fem.removeSpring(body, handle);
    m_scene.restore(saved);
    EXPECT_TRUE(m_scene.state() == state) << "released since";
    EXPECT_FALSE(m_scene.run(40) == bits);
}

TEST_P(Snapshot, RebuiltWorldContinuesBitForBit)
{
    m_scene.build();
    m_scene.m_world.step(40);
    const SnapshotScene::Saved saved = m_scene.saveAll();
    SnapshotScene again(GetParam().m_coupling);
    again.build();
    again.m_world.step(40);
    EXPECT_TRUE(again.state() == m_scene.state());
    again.m_fem.restoreState(saved.m_fem.data(), saved.m_fem.size());
    EXPECT_TRUE(again.run(60) == m_scene.run(60));
}

TEST_P(Snapshot, BodiesKnownInAnotherOrderContinueBitForBit)
{
    const SoftBox lower{{1, 1, 0.5}, {4, 4, 2}, {0, 0, 0.26}}, upper{{0.8, 0.8, 0.5}, {3, 3, 2}, {0.1, 0, 0.8}};
    m_scene.m_world.addPlane();
    m_scene.add(lower);
    m_scene.add(upper);
    m_scene.m_world.step(40);
    SnapshotScene again(GetParam().m_coupling);
    again.m_world.addPlane();
    btSoftBody* second = makeSoftBox(again.m_world, again.m_fem, upper);
    again.m_soft = {makeSoftBox(again.m_world, again.m_fem, lower), second};
    for (btSoftBody* body : again.m_soft) again.m_world.addSoft(body);
    again.m_world.step(40);
    const SnapshotScene::Saved saved = m_scene.saveAll();
    again.m_fem.restoreState(saved.m_fem.data(), saved.m_fem.size());
    EXPECT_TRUE(again.save() == saved.m_fem);
    EXPECT_TRUE(again.run(60) == m_scene.run(60));
}

TEST_P(Snapshot, ImpactContinuesBitForBit)
{
    btSoftBody& block = m_scene.add({{0.6, 0.6, 0.3}, {6, 6, 3}, {0, 0, 0}, btScalar(3e5)});
    clampBelow(block, -0.14);
    RigidSettings shot{3, at(btScalar(0.05), 0, btScalar(0.8))};
    shot.m_velocity = {0, 0, -20};
    m_scene.m_rigid.push_back(&m_scene.m_world.addRigid(new btSphereShape(btScalar(0.08)), shot));
    m_scene.m_world.step();
    int touching = 0;
    for (int k = 0; k < 12; ++k)
    {
        const SnapshotScene::Saved saved = m_scene.saveAll();
        const std::vector<double> bits = m_scene.run(10);
        m_scene.m_rigid[0]->setCenterOfMassTransform(at(0, 0, 5));  // its stored contacts are dropped
        m_scene.m_world.step(2);
        m_scene.restore(saved);
        EXPECT_TRUE(m_scene.run(10) == bits) << "step " << k;
        m_scene.restore(saved);
        m_scene.m_world.step();
        touching += m_scene.contacts() > 0;
    }
    EXPECT_GT(touching, 3);  // the ball rebounds
}

TEST_P(Snapshot, LevelsOfDetailContinueBitForBit)
{
    btFemViewerInterest viewer(5, 50);
    m_scene.m_fem.setInterest(&viewer);
    btSoftBody& box = m_scene.add({{1, 0.5, 0.5}, {4, 2, 2}, {0, 0, 0}});  // falls and rotates
    for (int i = 0; i < box.m_nodes.size(); ++i) box.m_nodes[i].m_v = btVector3(1, 2, 3).cross(box.m_nodes[i].m_x);
    m_scene.m_world.step(10);
    viewer.setViewer({1000, 0, 0});
    m_scene.m_world.step(15);  // half of its dwell time
    for (int k = 0; k < 2; ++k)
    {
        const SnapshotScene::Saved saved = m_scene.saveAll();
        const std::vector<double> bits = m_scene.run(50);
        ASSERT_NE(m_scene.m_fem.stepReport(m_scene.m_soft[0]).m_detail, btFemDetail::nodalWarp);
        m_scene.restore(saved);
        EXPECT_TRUE(m_scene.run(50) == bits);
    }
}

void giveModulus(SnapshotScene& scene, btScalar youngModulus)
{
    btFemMaterial material = btFemMaterial();
    material.m_youngModulus = youngModulus;
    for (btSoftBody* body : scene.m_soft) scene.m_fem.setMaterial(body, material);
}

TEST_P(Snapshot, CopiesContinueBitForBitWithForgottenFactors)
{
    for (const btFemFactorChoice choice : {btFemFactorChoice::full, btFemFactorChoice::lowMemory})
    {
        btFemSolverInfo info = withThreads(GetParam().m_threads);
        info.m_factorChoice = choice;
        SnapshotScene scene(GetParam().m_coupling, info);
        scene.m_world.addPlane();
        for (int k = 0; k < 6; ++k)
            scene.add({{0.5, 0.5, 0.5}, {3, 3, 3}, {0.3 * (k % 2), 0.55 * (k / 2), 0.26 + 0.55 * (k % 2)}});
        scene.m_world.step(30);
        const SnapshotScene::Saved saved = scene.saveAll();
        const std::vector<double> bits = scene.run(60);
        giveModulus(scene, btScalar(2e6));
        scene.m_world.step(2);
        giveModulus(scene, btScalar(1e6));
        scene.restore(saved);
        EXPECT_TRUE(scene.save() == saved.m_fem);
        EXPECT_TRUE(scene.run(60) == bits);
    }
}

// In contacts between rigid bodies Bullet stores warm starts, which cannot be restored. BulletState clears them in both
// runs, so that both continue without. With SOLVER_RANDMIZE_ORDER the rigid solver uses random numbers, but not for
// islands that are solved with FEM bodies.
TEST_P(Snapshot, RigidContactsContinueBitForBitOnceCleared)
{
    m_scene.addTower();
    for (const double x : {0.1, 0.2})
        m_scene.m_rigid.push_back(&addRigidBox(m_scene.m_world, {0.3, 0.3, 0.3},
                                               {btScalar(20), at(btScalar(x), 0, btScalar(1.35 + 3.5 * x))}));
    btSoftRigidDynamicsWorld& world = m_scene.m_world.world();
    world.getSolverInfo().m_solverMode |= SOLVER_RANDMIZE_ORDER;
    auto& solver = *static_cast<btSequentialImpulseConstraintSolver*>(world.getConstraintSolver());
    m_scene.m_world.step(40);
    ASSERT_GE(world.getDispatcher()->getNumManifolds(), 2);
    const SnapshotScene::Saved saved = m_scene.saveAll();
    const unsigned long seed = solver.getRandSeed();
    const auto runAgain = [&](unsigned long from)
    {
        m_scene.restore(saved);
        EXPECT_EQ(world.getDispatcher()->getNumManifolds(), 0);
        solver.setRandSeed(from);
        return m_scene.run(60);
    };
    const std::vector<double> remembered = m_scene.run(60), bits = runAgain(seed);
    EXPECT_FALSE(bits == remembered);
    EXPECT_TRUE(runAgain(seed + 1) == bits);
}

INSTANTIATE_TEST_SUITE_P(Solvers, Snapshot,
                         testing::Values(SnapshotCase{Coupling::swap, 1}, SnapshotCase{Coupling::swap, 3},
                                         SnapshotCase{Coupling::coupled, 1}, SnapshotCase{Coupling::coupled, 3}),
                         [](const auto& test)
                         {
                             return couplingName(test.param.m_coupling) + std::string("With") +
                                    std::to_string(test.param.m_threads) + "Threads";
                         });

TEST(SnapshotSize, GrowsLinearlyWithTheMesh)
{
    for (const int cells : {4, 8, 16})
    {
        SnapshotScene scene;
        scene.m_world.addPlane();
        const btSoftBody& box = scene.add({{1, 1, 1}, {cells, cells, cells}, {0, 0, 0.501}});
        scene.m_world.step(5);
        const std::size_t bytes = scene.save().size();
        const std::string name = std::to_string(cells) + "Cells";
        testing::Test::RecordProperty(name + "Bytes", static_cast<int>(bytes));
        testing::Test::RecordProperty(name + "Nodes", box.m_nodes.size());
        testing::Test::RecordProperty(name + "Tets", box.m_tetras.size());
        testing::Test::RecordProperty(name + "Contacts", scene.contacts());
        EXPECT_LT(bytes, 64 * 1024 + 320 * std::size_t(box.m_nodes.size()) + 16 * std::size_t(box.m_tetras.size()));
    }
}

}  // namespace
}  // namespace bullet_fem
