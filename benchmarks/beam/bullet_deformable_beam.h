// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/beam/beam_case.h"

namespace bullet_fem
{

/// Runs the beam in Bullet's deformable world: implicit integration, projection, btDeformableLinearElasticityForce, and
/// Bullet's CG, which stops at r^T M^-1 r <= tolerance min(1, b^T M^-1 b) or after 300 iterations. A tolerance of 0
/// keeps Bullet's default, float epsilon. The physical model equals BulletFEM's: node masses set explicitly, Rayleigh
/// damping, no collisions, no sleeping. Bullet linearises at x_n + h v_n, BulletFEM at x_n; the tip positions therefore
/// agree within 0.6 %.
BeamRun runBulletDeformable(const BeamCase& beam, double tolerance = 0);

}  // namespace bullet_fem
