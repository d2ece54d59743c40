// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "benchmarks/beam/beam_report.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{

/// Which rivals run beside us, and on what terms.
struct BeamMethods
{
    bool m_withBullet = true;            ///< Bullet's deformable world and its mass-spring solver, too
    bool m_tension = true;               ///< keep the tension term of A
    int m_springIterations = 20;         ///< of the mass-spring solver, >= 1
    const Threads* m_threads = nullptr;  ///< that share our steps; null: one. Rivals run on one
};

/// Our step at 1e-3 and 1e-6 in both warps, at 1e-8, and in direct mode, then the rivals, one after the other. Tips are
/// measured against our solution at 1e-8, Bullet's against that without the tension term, which it has not.
std::vector<BeamFigures> compareMethods(const BeamCase& beam, const BeamMethods& methods);

/// Error against time: our step at tolerances 1e-1 to 1e-8 in both warps and in direct mode, Bullet's at several of its
/// own. Each scheme's tips are measured against its own solution at the finest tolerance, so that nobody is blamed for
/// another model.
std::vector<BeamFigures> traceErrorCurve(const BeamCase& beam, const BeamMethods& methods);

}  // namespace bullet_fem
