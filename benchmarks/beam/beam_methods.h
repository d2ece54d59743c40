// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "benchmarks/beam/beam_report.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{

/// Selects the methods that are compared with BulletFEM's step, and their settings.
struct BeamMethods
{
    bool m_withBullet = true;            ///< includes Bullet's deformable world and its mass-spring solver
    bool m_tension = true;               ///< keep the tension term of A
    int m_springIterations = 20;         ///< of the mass-spring solver, >= 1
    const Threads* m_threads = nullptr;  ///< of BulletFEM's steps; null: one thread. Bullet's methods run on one thread
};

/// Runs BulletFEM's step at 1e-3 and 1e-6 with both warps, at 1e-8, and in direct mode, then the other methods one
/// after another. Tip errors are relative to BulletFEM's solution at 1e-8; for Bullet, relative to that solution
/// without the tension term, which Bullet lacks.
std::vector<BeamFigures> compareMethods(const BeamCase& beam, const BeamMethods& methods);

/// Error against time: BulletFEM's step at tolerances 1e-1 to 1e-8 with both warps and in direct mode, and Bullet's
/// world at several of its own tolerances. Tip errors of each scheme are relative to its own solution at the tightest
/// tolerance, so that differences between the models do not count as errors.
std::vector<BeamFigures> traceErrorCurve(const BeamCase& beam, const BeamMethods& methods);

}  // namespace bullet_fem
