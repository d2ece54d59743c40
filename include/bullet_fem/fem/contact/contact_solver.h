// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/contact/contact_problem.h"

namespace bullet_fem
{

/// For solves to a tolerance: the share of the impulses on a body that residuals are measured against at least, so that
/// what they leave of these is a share of what contact is solved to. Both > 0; [-], in [1e-3, 1].
BULLETFEM_API double residualFloor(double contactTolerance, double solveTolerance);

/// Frictional contact and joints in compliance space. After solveFreeMotion of every body, finds impulses with
///     normal: lambda_n >= 0, n . v + max(gap, 0) / h >= 0, complementary
///     friction: |lambda_t| <= mu lambda_n, opposite to the sliding velocity where it slides (Coulomb's disc)
///     joints: v = wanted, |lambda| <= limit
/// for relative velocities v. Their response is approximated by W = J P J^T with the warped rest factor P for the
/// sweeps, and solved for with the true system between rounds; where W turns out too stiff (a stale factor), it is
/// scaled up, and where it is too soft, more rounds follow. Joints are one system, solved at once in every sweep. The
/// same impulses act on both sides, so momentum is conserved however good W is. Penetration is taken back as a
/// displacement.
///
/// solve() does it all. Who sweeps rows of its own in between, such as those between rigid bodies, calls its parts:
/// begin, then while needsOuterIteration sweep ... sweep, correct, then if shouldRollBack restoreBest, and at the end
/// finish; it may read and write the rigid proxies' velocities between any two of them. The scratch grows with the
/// number of contacts and never shrinks. Deterministic: the order of contacts decides.
class BULLETFEM_API ContactSolver
{
public:
    ContactSolver();
    ~ContactSolver();

    /// Bodies must have had solveFreeMotion with settings.m_step. Adds the response of contacts and joints to their
    /// velocities, and to the rigid proxies'. Throws nothing; what did not converge is in the report.
    ContactReport solve(ContactProblem& problem, const ContactSettings& settings);

    /// Gives the rigid proxies the reactions of the guessed impulses, and measures. `problem` must live until finish.
    void begin(ContactProblem& problem, const ContactSettings& settings);

    /// One sweep over all rows; the rigid proxies' velocities follow. Returns false if it changed less than the
    /// tolerance, and so did rows of others that are swept in turn with these, or both no longer get anywhere: the
    /// round may end. `others`: the largest change of velocity by those rows since the last sweep [m/s].
    bool sweep(double others = 0);

    /// Ends a round: solves the true systems for the impulses that are new since the last call.
    void correct();

    /// True if another round is to be made: fewer than m_rounds were, or the error of the true velocities exceeds
    /// m_tolerance.
    bool needsOuterIteration() const;

    /// True if no impulses before have left a smaller error than those of the last begin or correct: others note those
    /// of their rows.
    bool isBest() const;

    /// True if the last round has left much more than the best. Others give their rows the impulses noted last, and
    /// call restoreBest, or leave everything as it is.
    bool shouldRollBack() const;

    /// Ends the rounds with the impulses of the best.
    void restoreBest();

    [[deprecated("needsOuterIteration")]] bool wantsRound() const { return needsOuterIteration(); }
    [[deprecated("shouldRollBack")]] bool wantsBack() const { return shouldRollBack(); }
    [[deprecated("restoreBest")]] void goBack() { restoreBest(); }

    /// Takes penetration back, and reports. The problem has the impulses from here on.
    ContactReport finish();

private:
    void guess();
    void noteBest();
    double errorNow() const;
    double errorOfJoints() const;
    double speedLeft() const;

    struct Scratch;
    std::unique_ptr<Scratch> m_scratch;
};

}  // namespace bullet_fem
