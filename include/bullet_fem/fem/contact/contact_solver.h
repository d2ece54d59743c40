// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/contact/contact_problem.h"

namespace bullet_fem
{

/// Minimum share of the impulses on a body that residuals are measured against in solves to a relative tolerance, so
/// that the residual is a fixed share of the contact tolerance. Both arguments > 0; result [-], in [1e-3, 1].
BULLETFEM_API double residualFloor(double contactTolerance, double solveTolerance);

/// Frictional contact and joints in compliance space (docs/contact.md). After solveFreeMotion of every body, finds
/// impulses with
///     normal: lambda_n >= 0, n . v + max(gap, 0) / h >= 0, complementary
///     friction: |lambda_t| <= mu lambda_n, opposite to the sliding velocity where it slides (Coulomb's disc)
///     joints: v = wanted, |lambda| <= limit
/// for relative velocities v. Sweeps approximate the response by W = J P J^T with the warped rest factor P; between
/// outer iterations the true system is solved. If W is too stiff (a stale factor) it is scaled up; if it is too soft,
/// more outer iterations follow. All joints within their limits are solved as one system in every sweep. Opposite
/// impulses act on the two sides, so momentum is conserved whatever the error of W. Penetration is corrected as a
/// displacement.
///
/// solve() runs the complete solution. A caller with rows of its own, such as those between rigid bodies, calls its
/// parts: begin, then while needsOuterIteration sweep ... sweep, correct, then if shouldRollBack restoreBest, and at
/// the end finish; it may read and write the rigid proxies' velocities between any two of them. The scratch memory
/// grows with the number of contacts and never shrinks. Deterministic, and dependent on the order of contacts.
class BULLETFEM_API ContactSolver
{
public:
    ContactSolver();
    ~ContactSolver();

    /// Solves a problem. Bodies must have had solveFreeMotion with settings.m_step. Adds the response of contacts and
    /// joints to their velocities, and to the rigid proxies'. Never throws; the report tells whether the solves
    /// converged. Allocates only when the problem grows.
    ContactReport solve(ContactProblem& problem, const ContactSettings& settings);

    /// Begins a solution: applies the reactions of the warm-start impulses to the rigid proxies, and measures all rows.
    /// `problem` must live until finish.
    void begin(ContactProblem& problem, const ContactSettings& settings);

    /// One sweep over all rows; the rigid proxies' velocities are updated. `others`: largest velocity change by the
    /// caller's own rows since the last sweep [m/s]. Returns false if both changed less than the tolerance or stall:
    /// the outer iteration may end.
    bool sweep(double others = 0);

    /// Ends an outer iteration: solves the true systems for the impulses added since the last call.
    void correct();

    /// True if another outer iteration is needed: fewer than m_rounds were made, or the error of the true velocities
    /// exceeds m_tolerance.
    bool needsOuterIteration() const;

    /// True if the last begin or correct left the smallest error so far: the caller saves the impulses of its own rows.
    bool isBest() const;

    /// True if the last outer iteration left a large error, and an earlier one less. The caller then restores the saved
    /// impulses of its own rows and calls restoreBest, or leaves all impulses unchanged.
    bool shouldRollBack() const;

    /// Restores the impulses of the best outer iteration.
    void restoreBest();

    [[deprecated("needsOuterIteration")]] bool wantsRound() const { return needsOuterIteration(); }
    [[deprecated("shouldRollBack")]] bool wantsBack() const { return shouldRollBack(); }
    [[deprecated("restoreBest")]] void goBack() { restoreBest(); }

    /// Ends a solution: corrects penetration, writes the impulses to the problem, and reports.
    ContactReport finish();

private:
    void guess();
    void correct(bool steady);
    void noteBest();
    double errorNow() const;
    double errorOfJoints() const;
    double speedLeft() const;

    struct Scratch;
    std::unique_ptr<Scratch> m_scratch;
};

}  // namespace bullet_fem
