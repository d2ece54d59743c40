// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/body/conjugate_gradients.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{

/// Where elements have a law that is not linear, the step's one linear solve is the first quasi-Newton iteration on
///
///     (1 + h alpha) M dv = b_0 + h f(z) - h beta K' (v + dv - t h w x (w x r)),
///     z = y + h (s v + c dv - e h w x (w x r)),    b_0: loads, damping by mass, predicted impulses
///
/// with e and t of StepCoefficients, turningOfLength() and kTurningOfVelocity. This adds at most kMostCorrections
/// more, each A d = r with A taken at z, over the same factor. They end when |r| is at most kLeftShare of |b|. Each is
/// followed by a line search on the energy [Bonet & Wood 2008, 9.6.2]: d . r is minus the slope of kinetic, elastic and
/// load's energy along d, and where it has turned to less than minus half of what it was, a secant step goes back to
/// where it is zero.
class QuasiNewton
{
public:
    static constexpr int kMostCorrections = 2;
    static constexpr int kMostLineSearches = 3;
    static constexpr double kLeftShare = 0.05;  ///< of |b| [-]

    /// b_0 has to be known: StepScratch::m_newton. `A` is of the body.
    QuasiNewton(Body& body, const StepSettings& settings, const WarpedSystem& A);

    /// Improves m_increment of the scratch, found by `report`, and adds what was done to it. A remains as of the last
    /// z; m_rightSide of the scratch is not b any more.
    void correct(const ConjugateGradientStop& stop, SolveReport& report);

private:
    void findTurning();
    double findResidual();  // returns |r|
    void searchLine(double slope);
    void move(double length);

    Body& m_body;
    const StepSettings& m_settings;
    const WarpedSystem& m_A;
};

}  // namespace bullet_fem
