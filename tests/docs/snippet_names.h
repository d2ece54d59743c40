// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// What the code blocks of documents have without including or declaring it. A block may declare any name again.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h"
#include "BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btDeformableBodySolver.h"
#include "BulletSoftBody/btDeformableMultiBodyConstraintSolver.h"
#include "BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"

// All public headers; the test writes this one.
#include "public_headers.h"

// The program around a block.
extern btSoftBodyRigidBodyCollisionConfiguration config;
extern btCollisionDispatcher dispatcher;
extern btDbvtBroadphase broadphase;
extern btFemSoftBodySolver fem;
extern btFemConstraintSolver rigidSolver;
extern btSoftRigidDynamicsWorld world;
extern btSoftBodyWorldInfo worldInfo;
extern btSoftBody* body;
extern btSoftBody* other;
extern btRigidBody* rigidBody;
extern btScalar mass, timeStep;
extern btVector3 from, to, mouse;

// Text in TetGen's form, as Bullet reads it.
extern const char *ele, *face, *node;
