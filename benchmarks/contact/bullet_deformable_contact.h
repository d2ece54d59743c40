// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/contact/contact_world.h"

namespace bullet_fem
{

/// The scene in Bullet's own deformable world, set up as Bullet's demo of collisions in implicit mode does: contacts of
/// nodes (and, soft on soft, of nodes with faces), 100 rigid iterations down to 1e-3, split impulse, error reduction
/// .3. The soft margin is a fifth of a cell, because the implicit mode sees only what is within it at the start of a
/// step. A frame of the scene's step is `subSteps` steps of Bullet's, >= 1: it recommends 4, and many scenes blow up
/// at 1.
std::unique_ptr<ContactWorld> makeBulletContactWorld(const ContactScene& scene, int subSteps);

}  // namespace bullet_fem
