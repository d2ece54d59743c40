// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/scenes/each_world.h"

namespace bullet_fem
{

constexpr int kFiveSeconds = 300;  ///< steps within which a body at rest must fall asleep

/// Cubes of 0.4 m and rigid bodies, all with Bullet's default sleeping.
class SleepingScene
{
protected:
    explicit SleepingScene(WorldClass worldClass = WorldClass::softRigid) : m_world(worldClass) {}
    explicit SleepingScene(Coupling coupling) : m_world(WorldClass::softRigid, coupling) {}

    btSoftBody& addCube(btScalar x = 0, btScalar height = btScalar(0.01), int state = ACTIVE_TAG)
    {
        btSoftBody* cube = btFemHelpers::createBox(m_world.info(), btVector3(x, 0, height + btScalar(0.2)),
                                                   btVector3(0.2, 0.2, 0.2), btScalar(0.1));
        btFemMaterial material;
        material.m_density = 1000;
        m_fem.setMaterial(cube, material);
        m_world.addSoft(cube);
        cube->forceActivationState(state);
        return *cube;
    }

    btRigidBody& addGround()
    {
        btRigidBody& ground = m_world.addFloorBox();
        ground.forceActivationState(ISLAND_SLEEPING);
        return ground;
    }

    btRigidBody& addSphere(btScalar height, btScalar mass = 10)
    {
        btRigidBody& sphere = m_world.addRigid(new btSphereShape(btScalar(0.1)), {mass, at(0, 0, height)});
        sphere.forceActivationState(ACTIVE_TAG);
        return sphere;
    }

    /// A kinematic box of 0.2 m.
    btRigidBody& addPusher(const btTransform& transform)
    {
        btRigidBody& pusher = m_world.addRigid(new btBoxShape(btVector3(0.1, 0.1, 0.1)), {0, transform});
        m_world.bullet().removeRigidBody(&pusher);
        pusher.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        m_world.bullet().addRigidBody(&pusher);
        return pusher;
    }

    void sleepAll(const btSoftBody& body)
    {
        m_world.step(kFiveSeconds);
        ASSERT_EQ(body.getActivationState(), ISLAND_SLEEPING);
    }

    /// Makes a body rest for more than a second; returns its deactivation time then [s].
    btScalar restForMoreThanASecond(const btSoftBody& body)
    {
        m_world.step(100);
        EXPECT_GT(body.getDeactivationTime(), 1);
        return body.getDeactivationTime();
    }

    FemWorld m_world;
    btFemSoftBodySolver& m_fem = m_world.fem();
};

class Sleeping : public SleepingScene, public EachWorld
{
protected:
    Sleeping() : SleepingScene(GetParam()) {}
};

}  // namespace bullet_fem
