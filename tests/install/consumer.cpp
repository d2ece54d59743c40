// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The five lines of the README, compiled with installed headers and libraries only.
#ifdef BULLETFEM_AMALGAM
#include "bullet_fem_runtime.h"
#else
#include <bullet_fem/btFemHelpers.h>
#include <bullet_fem/btFemSoftBodySolver.h>
#endif

#include <type_traits>

#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"

static_assert(std::is_same_v<btScalar, EXPECTED_SCALAR>);

int main()
{
    btSoftBodyRigidBodyCollisionConfiguration config;
    btCollisionDispatcher dispatcher(&config);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver rigidSolver;
    btFemSoftBodySolver fem;
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigidSolver, &config, &fem);

    btSoftBody* box = btFemHelpers::createBox(world.getWorldInfo(), btVector3(0, 1, 0), btVector3(.2f, .2f, .2f), .1f);
    fem.setMaterial(box, btFemMaterial::rubber());
    world.addSoftBody(box);
    for (int i = 0; i < 10; ++i) world.stepSimulation(1.f / 60, 1, 1.f / 60);
    const bool moved = fem.isFem(box) && box->m_nodes[0].m_v.y() < -1;
    world.removeSoftBody(box);
    delete box;
    return moved ? 0 : 1;
}
