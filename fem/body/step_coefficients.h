// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"
#include "fem/body/step_scratch.h"

namespace bullet_fem
{

/// What a step of numerical damping s multiplies with what [-] (docs/theory.md):
///
///     y = x + (1 - theta) h v          A (v* - v) = h f(y) - h (s h + beta) K' v - r c h^2 T v
///     x+ = y + theta h v*              v+ = v* - d A^-1 (A - M) (v* - v)          A = M + c h^2 (K' + T) + h beta K'
///
/// s = 1 is implicit Euler, s = 0 of second order. A mode of (omega h)^2 = k keeps the share 1 - d c k^2 / (2 (1 + c
/// k)^2) of its amplitude's square then; c = 3/8 and d = 2 c are the pair of which that tends to zero as k grows while
/// strips of twice their length come to rest.
struct StepCoefficients
{
    explicit StepCoefficients(double numericalDamping) : m_damping(numericalDamping) {}
    StepCoefficients(const StepSettings& settings, const Body& body)
        : m_damping(std::max(
              {settings.m_numericalDamping, body.m_loads.m_leastDamping, body.m_workspace.scratch().m_leastDamping}))
    {
    }

    double m_damping;                                       ///< s
    double theta() const { return 0.5 * (1 + m_damping); }  ///< share of the end velocities in the motion
    double stiffness() const { return kLeast + (1 - kLeast) * m_damping; }  ///< c, of h^2 K' and h^2 T in A
    double smoothing() const { return 2 * kLeast * (1 - m_damping); }       ///< d, of what the step does not resolve

    /// What a body that turns by phi = h w a step does with K' although it keeps its shape, in shares of h w x (w x r):
    /// its nodes go along chords. v grows by h w^2 / 2 as y sees it, and dv is -h w^2: so 1 - 1/2 of the velocity
    /// v + dv is no strain. With s = 0, y is longer than x by phi^2 / 8, and c - 1/8 of the length is none; Euler's
    /// step goes without the latter.
    double turningOfLength() const { return (1 - m_damping) * (kLeast - 0.125); }
    static constexpr double kTurningOfVelocity = 0.5;

    static constexpr double kLeast = 0.375;
};

/// Of what K' makes forces of h besides the positions y: of the velocities v and of h w x (w x r), as they turn with
/// the body in the step [s].
struct ViscousShares
{
    ViscousShares(const StepCoefficients& step, double h, double beta)
        : m_ofVelocity(step.m_damping * h + beta),
          m_ofTurning(step.turningOfLength() * h + StepCoefficients::kTurningOfVelocity * beta)
    {
    }

    double m_ofVelocity, m_ofTurning;
};

}  // namespace bullet_fem
