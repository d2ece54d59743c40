// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/beam/beam_case.h"

namespace bullet_fem
{

/// Runs the beam in Bullet's own deformable world: implicit, projection, btDeformableLinearElasticityForce, Bullet's
/// own CG, which stops at r^T M^-1 r <= tolerance min(1, b^T M^-1 b) or after 300 iterations. A tolerance of 0 keeps
/// Bullet's default, float epsilon. Set up so that the physics is ours: node masses by hand, Rayleigh damping, no
/// collisions, no sleeping. Its step linearises at x_n + h v_n, ours at x_n, so its tip agrees within 0.6 % and not to
/// the last digit.
BeamRun runBulletDeformable(const BeamCase& beam, double tolerance = 0);

}  // namespace bullet_fem
