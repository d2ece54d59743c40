// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/beam/beam_case.h"

namespace bullet_fem
{

/// Runs the beam's mesh with the mass-spring solver of Bullet's btSoftBody: a link on every edge of a tet at Bullet's
/// maximum stiffness (kLST 1), equal node masses and step, no collisions, no sleeping. `iterations` is Bullet's
/// m_cfg.piterations, >= 1. The stiffness of this model depends on step and iterations, so only its times are
/// comparable.
BeamRun runMassSpring(const BeamCase& beam, int iterations);

}  // namespace bullet_fem
