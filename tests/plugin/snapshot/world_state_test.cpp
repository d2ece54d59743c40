// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// States of whole worlds: the run goes on with equal bits, in the world that was saved and in one that is built anew.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "bullet_fem/btFemWorldState.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/multibody_scene.h"
#include "plugin/scenes/snapshot_scene.h"

namespace bullet_fem
{
namespace
{

using Bytes = std::vector<unsigned char>;

/// The soft bodies of SnapshotScene, and beside them a heap of rigid spheres, boxes and capsules that fall into
/// contact with each other, sleep, and hang on a joint.
class HeapScene : public SnapshotScene
{
public:
    using SnapshotScene::SnapshotScene;

    HeapScene& withHeap()
    {
        build();
        for (int k = 0; k < 24; ++k)
        {
            RigidSettings settings{btScalar(1 + k % 3)};
            settings.m_transform = btTransform(
                btQuaternion(btVector3(0, 1, btScalar(0.5)), btScalar(0.3 * k)),
                btVector3(btScalar(20 + 0.1 * (k % 4)), btScalar(0.12 * (k % 3)), btScalar(0.3 + 0.32 * k)));
            m_rigid.push_back(&m_world.addRigid(shape(k), settings));
            if (k % 5) m_rigid.back()->forceActivationState(ACTIVE_TAG);
        }
        m_joint = std::make_unique<btPoint2PointConstraint>(*m_rigid.back(), *m_rigid[m_rigid.size() - 2],
                                                            btVector3(0, 0, btScalar(-0.16)),
                                                            btVector3(0, 0, btScalar(0.16)));
        m_world.bullet().addConstraint(m_joint.get());
        return *this;
    }
    ~HeapScene() { m_world.bullet().removeConstraint(m_joint.get()); }

    HeapScene& prepared()
    {
        for (btSoftBody* body : m_soft) m_fem.prepare(body, kStep);
        return *this;
    }

    Bytes saveWorld()
    {
        Bytes bytes;
        btFemWorldState::save(m_world.bullet(), m_fem, bytes);
        return bytes;
    }
    void restoreWorld(const Bytes& bytes)
    {
        btFemWorldState::restore(m_world.bullet(), m_fem, bytes.data(), bytes.size());
    }

    std::unique_ptr<btTypedConstraint> m_joint;

private:
    btCollisionShape* shape(int k)
    {
        const btVector3 half(btScalar(0.15), btScalar(0.12), btScalar(0.1));
        if (k % 3 == 0) return new btSphereShape(btScalar(0.15));
        if (k % 3 == 1) return new btBoxShape(half);
        return new btCapsuleShape(btScalar(0.1), btScalar(0.2));
    }
};

struct WorldStateCase
{
    WorldClass m_class;
    Coupling m_coupling;
};

class WorldState : public testing::TestWithParam<WorldStateCase>
{
protected:
    HeapScene& scene()
    {
        m_scenes.push_back(std::make_unique<HeapScene>(GetParam().m_coupling, btFemSolverInfo{}, GetParam().m_class));
        return m_scenes.back()->withHeap();
    }

private:
    std::vector<std::unique_ptr<HeapScene>> m_scenes;
};

TEST_P(WorldState, ContinuesBitForBitInItsWorldAndInANewOne)
{
    HeapScene &saved = scene(), &other = scene().prepared();
    for (const int before : {25, 90})  // in the fall, and when the heap rests
    {
        saved.m_world.step(before);
        const Bytes bytes = saved.saveWorld();
        EXPECT_TRUE(saved.saveWorld() == bytes) << "saving changed the world";
        const std::vector<double> state = saved.state(), bits = saved.run(60);
        saved.restoreWorld(bytes);
        EXPECT_TRUE(saved.state() == state);
        EXPECT_TRUE(saved.run(60) == bits);
        other.restoreWorld(bytes);
        EXPECT_TRUE(other.state() == state);
        EXPECT_TRUE(other.run(60) == bits);
    }
}

INSTANTIATE_TEST_SUITE_P(Worlds, WorldState,
                         testing::Values(WorldStateCase{WorldClass::softRigid, Coupling::swap},
                                         WorldStateCase{WorldClass::softRigid, Coupling::coupled},
                                         WorldStateCase{WorldClass::softMultiBody, Coupling::swap},
                                         WorldStateCase{WorldClass::deformable, Coupling::swap}),
                         [](const testing::TestParamInfo<WorldStateCase>& suite) {
                             return std::string(worldName(suite.param.m_class)) + "_" +
                                    couplingName(suite.param.m_coupling);
                         });

/// A motor presses a cube with a slider; beside it a pendulum swings, and another slider rests and falls asleep.
struct LinkScene
{
    LinkScene() : m_world(m_fem)
    {
        m_world.addFloorBox();
        SoftBox box;
        box.m_size = {0.4, 0.4, 0.4};
        box.m_center = {0.5, 0, 0.205};
        m_soft = &m_world.addSoft(makeSoftBox(m_world.info(), m_fem, box));
        m_fem.prepare(m_soft, kStep);
        const btVector3 half(btScalar(0.1), btScalar(0.1), btScalar(0.1));
        auto* slider = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
        slider->setupPrismatic(0, 1, boxInertia(1, half), -1, kNoTurn, btVector3(1, 0, 0),
                               btVector3(0, 0, btScalar(0.25)), btVector3(0, 0, 0), false);
        m_bodies.push_back(&m_world.addMultiBody(slider));
        m_world.addCollider(*slider, 0, new btBoxShape(half));
        m_world.addConstraint<btMultiBodyJointMotor>(slider, 0, btScalar(0.5), btScalar(0.3));
        auto* pendulum = new btMultiBody(1, 1, boxInertia(1, half), false, false);
        pendulum->setupRevolute(0, 1, boxInertia(1, half), -1, kNoTurn, btVector3(0, 1, 0), btVector3(0, 0, 0),
                                btVector3(0, 0, btScalar(-0.3)), false);
        pendulum->setBasePos(btVector3(0, 3, btScalar(0.6)));
        m_bodies.push_back(&m_world.addMultiBody(pendulum));
        m_world.addCollider(*pendulum, -1, new btBoxShape(half));
        m_world.addCollider(*pendulum, 0, new btBoxShape(half));
        auto* resting = new btMultiBody(1, 0, btVector3(0, 0, 0), true, true);
        resting->setupPrismatic(0, 1, boxInertia(1, half), -1, kNoTurn, btVector3(1, 0, 0),
                                btVector3(0, 6, btScalar(0.5)), btVector3(0, 0, 0), false);
        m_bodies.push_back(&m_world.addMultiBody(resting));
        m_world.addCollider(*resting, 0, new btBoxShape(half)).forceActivationState(ACTIVE_TAG);
    }

    std::vector<double> run(int steps)
    {
        std::vector<double> bits;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (int i = 0; i < m_soft->m_nodes.size(); ++i)
                for (int c = 0; c < 3; ++c) bits.push_back(double(m_soft->m_nodes[i].m_x[c]));
            for (const btMultiBody* body : m_bodies)
            {
                for (int c = 0; c < 3; ++c) bits.push_back(double(body->getBasePos()[c]));
                bits.insert(bits.end(),
                            {double(body->getJointPos(0)), double(body->getJointVel(0)), double(body->isAwake())});
            }
        }
        return bits;
    }

    btFemSoftBodySolver m_fem;
    CoupledLinkWorld m_world;
    btSoftBody* m_soft = nullptr;
    std::vector<btMultiBody*> m_bodies;
};

TEST(WorldStateOfLinks, ContinuesBitForBitInItsWorldAndInANewOne)
{
    LinkScene saved, other;
    for (const int before : {40, 80})
    {
        saved.run(before);
        Bytes bytes;
        btFemWorldState::save(saved.m_world.world(), saved.m_fem, bytes);
        const std::vector<double> bits = saved.run(60);
        btFemWorldState::restore(saved.m_world.world(), saved.m_fem, bytes.data(), bytes.size());
        EXPECT_TRUE(saved.run(60) == bits);
        btFemWorldState::restore(other.m_world.world(), other.m_fem, bytes.data(), bytes.size());
        EXPECT_TRUE(other.run(60) == bits);
    }
    EXPECT_GT(saved.m_fem.contacts(saved.m_soft).size(), 0);
}

// The timer has no effect on the motion until it is over.
TEST(WorldStateOfLinks, KeepsTheSleepTimer)
{
    LinkScene saved, other;
    int steps = 0;
    Bytes bytes;
    for (; saved.m_bodies[2]->isAwake() && steps < 600; ++steps)
    {
        if (steps == 60) btFemWorldState::save(saved.m_world.world(), saved.m_fem, bytes);
        saved.m_world.step();
    }
    ASSERT_LT(steps, 600);
    btFemWorldState::restore(other.m_world.world(), other.m_fem, bytes.data(), bytes.size());
    other.m_world.step(steps - 61);
    EXPECT_TRUE(other.m_bodies[2]->isAwake());
    other.m_world.step();
    EXPECT_FALSE(other.m_bodies[2]->isAwake());
}

// Bullet sets only the interpolated positions that a joint has.
TEST(WorldStateOfLinks, LeavesUndefinedPositionsOfLinksOut)
{
    LinkScene scene;
    scene.m_world.step();
    for (btMultiBody* body : scene.m_bodies)
        for (int k = 0; k < body->getNumLinks(); ++k)
            body->getLink(k).m_jointPos_interpolate[6] = std::numeric_limits<btScalar>::quiet_NaN();
    Bytes bytes;
    btFemWorldState::save(scene.m_world.world(), scene.m_fem, bytes);
    EXPECT_NO_THROW(btFemWorldState::restore(scene.m_world.world(), scene.m_fem, bytes.data(), bytes.size()));
}

class WorldStateRefusal : public testing::Test
{
protected:
    WorldStateRefusal()
    {
        m_scene.withHeap();
        m_scene.m_world.step(60);
        m_bytes = m_scene.saveWorld();
    }

    std::string reasonFor(HeapScene& scene, const Bytes& bytes)
    {
        std::string why;
        EXPECT_FALSE(btFemWorldState::restore(scene.m_world.bullet(), scene.m_fem, bytes.data(), bytes.size(), &why));
        return why;
    }

    HeapScene m_scene;
    Bytes m_bytes;
};

TEST_F(WorldStateRefusal, OfOtherWorldsNamesTheDifference)
{
    HeapScene other;
    other.withHeap().prepared();
    RigidSettings more{1};
    btRigidBody& added = other.m_world.addRigid(new btSphereShape(1), more);
    EXPECT_NE(reasonFor(other, m_bytes).find("objects, and the world"), std::string::npos);
    other.m_world.deleteRigid(added);
    other.restoreWorld(m_bytes);
    m_scene.m_world.bullet().removeConstraint(m_scene.m_joint.get());
    EXPECT_NE(reasonFor(m_scene, m_bytes).find("joints, and the world"), std::string::npos);
}

TEST_F(WorldStateRefusal, OfStatesOfBodiesAndOfDamagedBytesChangesNothing)
{
    EXPECT_NE(reasonFor(m_scene, m_scene.save()).find("not the state of a world"), std::string::npos);
    for (std::size_t k = 0; k < m_bytes.size(); k += 997)
    {
        Bytes damaged = m_bytes;
        damaged[k] ^= 4;
        EXPECT_FALSE(reasonFor(m_scene, damaged).empty());
        damaged.resize(k);
        EXPECT_FALSE(reasonFor(m_scene, damaged).empty());
    }
    EXPECT_TRUE(m_scene.saveWorld() == m_bytes);
}

int calls = 0;

bool countAdded(btManifoldPoint&, const btCollisionObjectWrapper*, int, int, const btCollisionObjectWrapper*, int, int)
{
    ++calls;
    return false;
}

TEST_F(WorldStateRefusal, OfBodiesThatAreNotFemYetLeavesBulletsPairs)
{
    HeapScene other;
    other.withHeap();
    const int pairs = other.m_world.bullet().getPairCache()->getNumOverlappingPairs();
    EXPECT_FALSE(reasonFor(other, m_bytes).empty());
    EXPECT_EQ(other.m_world.bullet().getPairCache()->getNumOverlappingPairs(), pairs);
    for (btRigidBody* body : m_scene.m_rigid)
        body->setCollisionFlags(body->getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    gContactAddedCallback = &countAdded;
    m_scene.restoreWorld(m_bytes);
    EXPECT_EQ(calls, 0);  // restoring tells no callback
    m_scene.m_world.step(20);
    gContactAddedCallback = nullptr;
    EXPECT_GT(calls, 0);
}

}  // namespace
}  // namespace bullet_fem
