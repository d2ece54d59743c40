// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btAlignedObjectArray.h"

class btDynamicsWorld;
class btSoftBody;
struct btDispatcherInfo;

namespace bullet_fem
{

/// The world whose members these are: the array of soft bodies that it gives to its btSoftBodySolver, and the info that
/// it gives to collision algorithms. Null unless both lie as in a btSoftRigidDynamicsWorld or a
/// btSoftMultiBodyDynamicsWorld. Bullet tells soft body solvers of no world, which alone knows its constraints.
/// Compares addresses, and accesses neither. Allocates at the first call in a program.
btDynamicsWorld* enclosingWorld(const btAlignedObjectArray<btSoftBody*>& softBodies, const btDispatcherInfo& info);

}  // namespace bullet_fem
