// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

class BatchMemory;
class Threads;

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

}  // namespace bullet_fem
