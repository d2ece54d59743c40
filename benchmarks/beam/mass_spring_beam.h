// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/beam/beam_case.h"

namespace bullet_fem
{

/// Runs the beam's mesh with the mass-spring solver of Bullet's plain btSoftBody: a link along every edge of a tet, at
/// Bullet's greatest stiffness (kLST 1), the same node masses and step, no collisions, no sleeping. `iterations` is
/// Bullet's m_cfg.piterations, >= 1. Another model: how stiff it is depends on step and iterations, so its times are
/// all that compares.
BeamRun runMassSpring(const BeamCase& beam, int iterations);

}  // namespace bullet_fem
