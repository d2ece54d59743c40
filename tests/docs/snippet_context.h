// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

// Declarations that the documents' C++ snippets rely on; they are compiled, never run.
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <bullet_fem/btFemCollision.h>
#include <bullet_fem/btFemConstraintSolver.h>
#include <bullet_fem/btFemDeformableBodySolver.h>
#include <bullet_fem/btFemFracture.h>
#include <bullet_fem/btFemHelpers.h>
#include <bullet_fem/btFemRay.h>
#include <bullet_fem/btFemSoftBodySolver.h>
#include <bullet_fem/btFemWelds.h>
#include <bullet_fem/btFemWorldState.h>

#include <iostream>
#include <vector>

extern btCollisionDispatcher dispatcher;
extern btBroadphaseInterface& broadphase;
extern btSoftBodyRigidBodyCollisionConfiguration config;
extern btSoftRigidDynamicsWorld world;
extern btFemSoftBodySolver fem;
extern btSoftBody* body;
extern const char *ele, *node;  // contents of TetGen's files
