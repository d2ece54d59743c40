// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/body/conjugate_gradients.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{

/// For elements with a nonlinear law, the step's one linear solve is the first quasi-Newton iteration on
///
///     (1 + h alpha) M dv = b_0 + h f(z) - h beta K' (v + dv - t h w x (w x r)),
///     z = y + h (s v + c dv - e h w x (w x r)),    b_0: loads, mass damping, predicted impulses
///
/// with e = turningOfLength() and t = kTurningOfVelocity of StepCoefficients. QuasiNewton adds at most kMaxCorrections
/// iterations, each A d = r with A evaluated at z, preconditioned by the existing factor, until |r| <= kLeftShare |b|.
/// Each is followed by a line search on the energy [Bonet & Wood 2008, 9.6.2]: -d . r is the slope of kinetic, elastic
/// and potential energy along d; if the slope at the full step exceeds half its initial magnitude with the opposite
/// sign, secant steps seek its zero.
class QuasiNewton
{
public:
    static constexpr int kMaxCorrections = 2;
    static constexpr int kMaxLineSearches = 3;
    static constexpr double kLeftShare = 0.05;  ///< share of |b| [-]

    /// Requires b_0 in StepScratch::m_newton. `A` is the system of `body`.
    QuasiNewton(Body& body, const StepSettings& settings, const WarpedSystem& A);

    /// Improves m_increment of the scratch, the solution that `report` describes, and updates the report. A remains
    /// that of the last z; m_rightSide of the scratch is overwritten.
    void correct(const ConjugateGradientStop& stop, SolveReport& report);

private:
    double findResidual();  // returns |r|
    void searchLine(double slope);
    void move(double length);

    Body& m_body;
    const StepSettings& m_settings;
    const WarpedSystem& m_A;
};

}  // namespace bullet_fem
