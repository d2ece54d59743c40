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

/// How the rest factor rotates with the body.
enum class Warp
{
    nodal,  ///< one rotation per node: fewest iterations, the default
    global  ///< one rotation for the body [Garcia et al. 2006]; exact for rigid motion
};

/// Solver settings of one step.
struct StepSettings
{
    double m_step = 1.0 / 60;  ///< h [s], in [1e-6, 1]
    /// Numerical damping s [-], in [0, 1]: 1 is implicit Euler, 0 a second-order step that damps only frequencies it
    /// cannot resolve (docs/theory.md).
    double m_numericalDamping = 1;
    double m_tolerance = 1e-3;  ///< tolerance of |r| / max(|b|, 1e-3 h |f_ext|) [-], in [1e-12, 1)
    int m_maxIterations = 100;  ///< maximum conjugate gradient iterations a solve, >= 1
    /// Rotations of the preconditioner.
    Warp m_warp = Warp::nodal;
    bool m_direct = false;  ///< one iteration whatever the residual [Garcia et al. 2006]; stiff bodies can gain energy
    bool m_tension = true;  ///< include the tensile geometric stiffness in A; off only to compare with references
    /// Threads that share the work on a body of some thousand elements; null: the calling thread alone. Does not change
    /// the bits of the result. Must outlive the settings.
    const Threads* m_threads = nullptr;
    /// Memory in which bodies of one model are solved side by side, if there are enough of them; null: one after
    /// another. Does not change the bits of the result. Must outlive the settings.
    BatchMemory* m_batchMemory = nullptr;
};

/// Termination of the conjugate gradients.
enum class SolveStop
{
    converged,  ///< the residual is at or below the tolerance
    budget,     ///< the iteration limit came first: usable but less accurate; raise the limit or refactor
    breakdown   ///< the system was not positive definite or not finite to rounding: the best iterate is kept
};

/// Result of a solve. Every field is written on every path.
struct SolveReport
{
    int m_iterations = 0;  ///< applications of the preconditioner that improved the answer
    /// True residual |b - A dv| / |b| of the elastic part at the end [-]; 0 if b = 0. |b| counts as at least the floor
    /// of the tolerance: 1e-3 h |f_ext|, with expected impulses, which may cancel the loads, their norm.
    double m_residual = 0;
    /// Reason of termination.
    SolveStop m_stop = SolveStop::converged;
};

/// solveFreeMotion() of one body among several.
struct FreeMotion
{
    Body* m_body = nullptr;   ///< not null
    StepSettings m_settings;  ///< settings of its step
    SolveReport m_report;     ///< output
    /// Expected contact impulses, one per node [N s]: solved for together with the loads, with the body's rigid motion
    /// continued as initial guess. Must equal ContactBody::m_predicted. Null: none.
    const std::vector<Vec3>* m_predicted = nullptr;
    double m_predictedFloor = 1;  ///< lower bound of |b| as a share of their norm, for the tolerance [-], in [0, 1]
};

/// applyImpulses() to one body among several.
struct ImpulseResponse
{
    Body* m_body = nullptr;                         ///< not null
    const std::vector<Vec3>* m_impulses = nullptr;  ///< one per node [N s]
    StepSettings m_settings;                        ///< settings of its step
    double m_floor = 0;                             ///< lower bound of |b| for the tolerance [N s], >= 0
    bool m_steady = false;  ///< initial guess: the body ends with the velocities it began the step with
    SolveReport m_report;   ///< output
};

/// finishStep() of one body among several.
struct StepEnd
{
    Body* m_body = nullptr;         ///< not null
    StepSettings m_settings;        ///< settings of its step
    bool m_needsSmoothing = false;  ///< output: the step changed the velocities by more than it resolves
    bool m_isShortened = false;     ///< output: elastic motion was shortened, as the step would have gained energy
};

}  // namespace bullet_fem
