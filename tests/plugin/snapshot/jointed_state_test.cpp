// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Islands of soft bodies, Bullet's contacts and Bullet's joints: repeated on any number of threads, and rewound.
#include <gtest/gtest.h>

#include <vector>

#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/loaded_rigid_scene.h"

namespace bullet_fem
{
namespace
{

btFemSolverInfo onThreads(int count)
{
    btFemSolverInfo info;
    info.m_threads = count;
    return info;
}

/// Trays with payloads: one on the ground that a motor turns, others that a chain and a slider join to it; and a ball
/// that rolls on it with rolling friction.
class JointedTrays : public LoadedRigidScene
{
public:
    explicit JointedTrays(int threads = 1)
        : LoadedRigidScene(Coupling::coupled, Payload::soft, {0, 0, btScalar(-kGravity)}, onThreads(threads))
    {
        m_world.addFloorBox();
        const btVector3 up(0, 0, 1), end(btScalar(0.25), 0, 0);
        const double height = kTray.z / 2;
        for (const double x : {0.0, 0.5, 1.0}) m_bodies.push_back(&addLoadedTray({x, 0, height}, 0.3));
        m_bodies.push_back(&addLoadedTray({0, 0, height + kTray.z + kEdge + 0.002}, 0.6));
        join<btHingeConstraint>(*m_bodies[0], btVector3(0, 0, 0), up).enableAngularMotor(true, 2, 1);
        join<btPoint2PointConstraint>(*m_bodies[0], *m_bodies[1], end, -end);
        join<btConeTwistConstraint>(*m_bodies[1], *m_bodies[2], btTransform(btQuaternion::getIdentity(), end),
                                    btTransform(btQuaternion::getIdentity(), -end))
            .setLimit(btScalar(0.4), btScalar(0.4), btScalar(0.1));
        RigidSettings ball{btScalar(0.5), at(btScalar(0.15), btScalar(0.12), btScalar(kTray.z + 0.05))};
        m_bodies.push_back(&m_world.addRigid(new btSphereShape(btScalar(0.05)), ball));
        m_bodies.back()->setRollingFriction(btScalar(0.002));
        m_bodies[0]->setRollingFriction(1);
    }

    /// Bits of all bodies after each of `steps` steps.
    std::vector<btScalar> run(int steps)
    {
        std::vector<btScalar> bits;
        const auto append = [&bits](const std::vector<btScalar>& more)
        { bits.insert(bits.end(), more.begin(), more.end()); };
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (const btSoftBody* cube : m_softPayloads) append(bitsOf(*cube));
            for (const btRigidBody* body : m_bodies) append(bitsOf(*body));
        }
        return bits;
    }

private:
    std::vector<btRigidBody*> m_bodies;
};

TEST(JointedIslands, AreRepeatedOnAnyNumberOfThreads)
{
    JointedTrays one;
    const std::vector<btScalar> bits = one.run(30);
    EXPECT_TRUE(one.touches());
    for (const int threads : {1, 2, 3}) EXPECT_TRUE(JointedTrays(threads).run(30) == bits) << threads << " threads";
}

TEST(JointedIslands, ContinueFromARewoundState)
{
    JointedTrays scene;
    scene.run(20);
    ASSERT_TRUE(scene.touches());
    const BulletState bullet(scene.m_world);
    std::vector<unsigned char> fem;
    scene.m_world.fem().saveState(fem);
    const auto rewind = [&]
    {
        bullet.restore(scene.m_world);
        scene.m_world.fem().restoreState(fem.data(), fem.size());
    };
    rewind();
    const std::vector<btScalar> bits = scene.run(20);
    for (int again = 0; again < 2; ++again)
    {
        rewind();
        EXPECT_TRUE(scene.run(20) == bits) << again;
    }
}

}  // namespace
}  // namespace bullet_fem
