// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{

/// E [Pa] with mass damping 0.4 / s and stiffness damping 0.01 s.
Material dampedMaterial(double young = 1e5);

/// 1 x 0.4 x 0.4 m of the damped material, the 9 nodes at x = 0 fixed.
Body clampedBeam();

/// 1 x 0.6 x 0.5 m of the damped material.
Body freeBlock();

/// Strains of some 10 %, velocities of 0.5 m/s and loads of 3 N a node, at random; fixed nodes stand still.
void disturb(Body& body, unsigned seed = 7);

/// Expects nodal forces [N] to be the gradient of mechanicalEnergy() by central differences, at every `stride`-th node,
/// to 1e-5 of the largest one. Leaves the body displaced.
void expectEnergyGradient(Body& body, const std::vector<Vec3>& forces, std::size_t stride = 1);

}  // namespace bullet_fem
