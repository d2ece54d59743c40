// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/contact/contact_world.h"

namespace bullet_fem
{

/// The scene in a btSoftRigidDynamicsWorld with btFemSoftBodySolver. `coupled` replaces Bullet's rigid solver by
/// btFemConstraintSolver; `lowMemory` selects the low-memory factor. All bodies are factored before the first step.
std::unique_ptr<ContactWorld> makeFemContactWorld(const ContactScene& scene, bool coupled, bool lowMemory);

}  // namespace bullet_fem
