// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <bullet_fem/btFemHelpers.h>
#include <bullet_fem/btFemSoftBodySolver.h>

#include <cstdio>

int main()
{
    btSoftBodyRigidBodyCollisionConfiguration config;
    btCollisionDispatcher dispatcher(&config);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver rigidSolver;
    btFemSoftBodySolver fem;  // replaces Bullet's soft body solver
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigidSolver, &config, &fem);

    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    btRigidBody ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
    world.addRigidBody(&ground);

    const btVector3 center(0, btScalar(.4), 0), halfExtents(btScalar(.2), btScalar(.2), btScalar(.2));  // [m]
    btSoftBody* box = btFemHelpers::createBox(world.getWorldInfo(), center, halfExtents, btScalar(.1));
    fem.setMaterial(box, btFemMaterial::rubber());
    world.addSoftBody(box);

    for (int step = 1; step <= 60; ++step)
    {
        world.stepSimulation(btScalar(1) / 60, 0);
        const double top = box->m_nodes[box->m_nodes.size() - 1].m_x.y(), force = fem.contactForce(box, &ground).y();
        if (step % 10 == 0) std::printf("top at %.3f m, contact force %.1f N\n", top, force);
    }
    std::printf("m g = %.1f N\n", box->getTotalMass() * -world.getGravity().y());
    world.removeSoftBody(box);
    delete box;
}
