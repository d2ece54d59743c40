// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"
#include "fem/body/step_scratch.h"

namespace bullet_fem
{

/// Coefficients of a step of numerical damping s [-] (docs/theory.md):
///
///     y = x + (1 - theta) h v          A (v* - v) = h f(y) - h (s h + beta) K' v - r c h^2 T v
///     x+ = y + theta h v*              v+ = v* - d A^-1 (A - M) (v* - v)          A = M + c h^2 (K' + T) + h beta K'
///
/// s = 1 is implicit Euler, s = 0 is of second order. For s = 0 a mode of (omega h)^2 = k keeps the share 1 - d c k^2 /
/// (2 (1 + c k)^2) of its squared amplitude. c = 3/8 with d = 2 c makes this tend to zero as k grows, and lets strips
/// stretched to twice their length come to rest.
struct StepCoefficients
{
    explicit StepCoefficients(double numericalDamping) : m_damping(numericalDamping) {}
    StepCoefficients(const StepSettings& settings, const Body& body)
        : m_damping(std::max(
              {settings.m_numericalDamping, body.m_loads.m_leastDamping, body.m_workspace.scratch().m_leastDamping}))
    {
    }

    double m_damping;                                                   ///< s
    double theta() const { return 0.5 * (1 + m_damping); }              ///< weight of the end velocities in the motion
    double stiffness() const { return kMin + (1 - kMin) * m_damping; }  ///< coefficient c of h^2 K', h^2 T in A
    double smoothing() const { return 2 * kMin * (1 - m_damping); }     ///< coefficient d of the unresolved part

    /// Apparent strain of a rotation by phi = h W along chords, as a multiple of h W x (W x r) [s]: e is h W x (W x r)
    /// and w half of it outward, which is no strain; nor is the length of y, beyond that of x by ((1 - theta) phi)^2
    /// / 2. Bodies in contact that fixed nodes do not turn keep the length of s = 1, without which balls roll too fast.
    double chordStrain(const Body& body, double h, double beta) const
    {
        const bool mayRoll = body.m_loads.m_isInContact && !body.m_workspace.scratch().m_led.turns();
        const double before = 1 - theta();
        const double length =
            mayRoll ? (1 - m_damping) * (kMin - 0.125) : stiffness() - 0.5 * (m_damping + before * before);
        return length * h + 0.5 * beta;
    }

    static constexpr double kMin = 0.375;
};

}  // namespace bullet_fem
