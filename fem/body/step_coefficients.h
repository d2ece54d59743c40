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

    /// Apparent strain of a rigid rotation by phi = h W along chords, as a multiple of h W x (W x r) [s]: v grows by h
    /// W^2 / 2 as seen at y, and e is -h W^2, so half of the velocity w + e is no strain. For s = 0, y is longer than x
    /// by phi^2 / 8, and c - 1/8 of the length is no strain; Euler's step has no such length term.
    double chordStrain(double h, double beta) const { return (1 - m_damping) * (kMin - 0.125) * h + 0.5 * beta; }

    static constexpr double kMin = 0.375;
};

}  // namespace bullet_fem
