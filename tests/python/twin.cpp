// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Prints node positions of a scene in C++, which test_package.py compares with those in Python; with an argument, the
// time of its steps [s], for benchmarks/python/measure.py.
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <bullet_fem/btFemConstraintSolver.h>
#include <bullet_fem/btFemHelpers.h>
#include <bullet_fem/btFemSoftBodySolver.h>
#include <bullet_fem/fem/mesh/generators.h>

#include <chrono>
#include <cstdio>

int main(int argc, char**)
{
    btSoftBodyRigidBodyCollisionConfiguration config;
    config.setPlaneConvexMultipointIterations();
    btCollisionDispatcher dispatcher(&config);
    btDbvtBroadphase broadphase;
    btFemSoftBodySolver fem;
    btFemConstraintSolver rigidSolver(&fem);
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigidSolver, &config, &fem);
    const btVector3 gravity(0, btScalar(-9.81), 0);
    world.setGravity(gravity);
    world.getWorldInfo().m_gravity = gravity;

    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    btRigidBody ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
    ground.setFriction(btScalar(.5));
    world.addRigidBody(&ground);

    const bullet_fem::TetMesh mesh = bullet_fem::makeBox({.4, .4, .4}, {3, 3, 3}, {-.2, .1, -.2});
    btSoftBody* box = btFemHelpers::createFromTetMesh(world.getWorldInfo(), mesh);
    fem.setMaterial(box, btFemMaterial::rubber());
    box->m_cfg.kDF = btScalar(.5);
    world.addSoftBody(box);
    fem.prepare(box, btScalar(1) / 60);

    const auto start = std::chrono::steady_clock::now();
    for (int step = 0; step < 120; ++step) world.stepSimulation(btScalar(1) / 60, 0);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    if (argc > 1) std::printf("%.9f\n", time.count());
    for (int i = 0; argc == 1 && i < box->m_nodes.size(); ++i)
    {
        const btVector3& x = box->m_nodes[i].m_x;
        std::printf("%a %a %a\n", double(x[0]), double(x[1]), double(x[2]));
    }
    world.removeSoftBody(box);
    world.removeRigidBody(&ground);
    delete box;
}
