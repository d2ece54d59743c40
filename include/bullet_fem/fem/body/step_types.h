// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

class BatchMemory;
class Threads;
struct Body;

/// How the rest factor is turned along with the body.
enum class Warp
{
    nodal,  ///< one rotation a node: fewest iterations, the default
    global  ///< the body's one rotation, as in [Garcia et al. 2006]; exact for rigid motion
};

/// How one step is solved.
struct StepSettings
{
    double m_step = 1.0 / 60;  ///< h [s], in [1e-6, 1]
    /// Damping by the step itself [-], in [0, 1]: 1 is implicit Euler, 0 a step of second order that damps only what it
    /// cannot resolve (docs/theory.md).
    double m_numericalDamping = 1;
    double m_tolerance = 1e-3;  ///< of |r| / max(|b|, 1e-3 h |f_ext|) [-], in [1e-12, 1)
    int m_maxIterations = 100;  ///< conjugate gradient iterations a solve, >= 1
    /// Which rotations turn the factor.
    Warp m_warp = Warp::nodal;
    bool m_direct = false;  ///< one iteration, whatever the residual: the paper's mode. Stiff bodies can gain energy
    bool m_tension = true;  ///< keep the tensile geometric stiffness in A; off only to compare with references
    bool m_momentumCorrection = true;  ///< restore the momentum that the impulses prescribe on unpinned pieces
    /// Who shares the work on a body of some thousand elements; null: the caller's thread alone. The bits of the result
    /// are the same. Must live as long as the settings are used.
    const Threads* m_threads = nullptr;
    /// Where bodies that share their model are solved side by side, if there are enough of them; null: one after
    /// another. The bits of the result are the same. Must live as long as the settings are used.
    BatchMemory* m_batchMemory = nullptr;
};

/// Why the conjugate gradients stopped.
enum class SolveStop
{
    converged,  ///< the residual is at or below the tolerance
    budget,     ///< the iteration cap came first: the answer is usable, less accurate; raise the cap or refactor
    breakdown   ///< the system was not positive definite or not finite to rounding: the best iterate was kept
};

/// What a solve did. Every field is written on every path.
struct SolveReport
{
    int m_iterations = 0;   ///< applications of the preconditioner that improved the answer
    double m_residual = 0;  ///< true |b - A dv| / |b| at the end [-]; 0 where b = 0. With expected impulses in b, which
                            ///< may cancel the loads, |b| is no less than the norm of these
    /// Why it ended.
    SolveStop m_stop = SolveStop::converged;
};

/// solveFreeMotion of one body of several.
struct FreeMotion
{
    Body* m_body = nullptr;   ///< not null
    StepSettings m_settings;  ///< of its step
    SolveReport m_report;     ///< out
    /// Impulses that contact is expected to make [N s], one a node: solved for with the loads, from the guess that the
    /// body goes on as it moves. ContactBody::m_predicted is to be the same then. Null: none.
    const std::vector<Vec3>* m_predicted = nullptr;
    double m_predictedFloor = 1;  ///< share of their norm that |b| counts as at least, for the tolerance [-], in [0, 1]
};

/// applyImpulses to one body of several.
struct ImpulseResponse
{
    Body* m_body = nullptr;                         ///< not null
    const std::vector<Vec3>* m_impulses = nullptr;  ///< [N s], one a node
    StepSettings m_settings;                        ///< of its step
    double m_floor = 0;                             ///< [N s], >= 0
    bool m_steady = false;  ///< the guess: the body ends with the velocities that it began the step with
    SolveReport m_report;   ///< out
};

/// finishStep of one body of several.
struct StepEnd
{
    Body* m_body = nullptr;   ///< not null
    StepSettings m_settings;  ///< of its step
    bool m_isRough = false;   ///< written: the step changed the velocities by more than it resolves
};

}  // namespace bullet_fem
