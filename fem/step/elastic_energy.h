// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// Elastic energy of a body at node positions x [m], with its initial stress and inelastic strain [J]. Uses the body's
/// scratch, and never allocates.
double elasticEnergy(const Body& body, const std::vector<Vec3>& x);

/// Kinetic energy of a body at node velocities v [m/s], one per node [J].
double kineticEnergy(const BodyState& state, const std::vector<Vec3>& v);

}  // namespace bullet_fem
