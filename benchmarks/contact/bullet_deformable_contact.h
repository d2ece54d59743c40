// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/contact/contact_world.h"

namespace bullet_fem
{

/// The scene in Bullet's deformable world, set up as Bullet's demo of collisions in implicit mode: contacts of nodes
/// (between soft bodies, of nodes with faces), 100 rigid iterations down to 1e-3, split impulse, error reduction 0.3.
/// The soft margin is a fifth of a cell, because the implicit mode detects only contacts within it at the start of a
/// step. A frame of the scene's step is `subSteps` steps of Bullet's, >= 1. Bullet recommends 4; many scenes diverge at
/// 1.
std::unique_ptr<ContactWorld> makeBulletContactWorld(const ContactScene& scene, int subSteps);

}  // namespace bullet_fem
