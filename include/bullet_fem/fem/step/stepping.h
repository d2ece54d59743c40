// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// One linearly implicit step, in the three parts that constraints need. No function allocates or throws, except as
/// StepSettings::m_threads says; different threads may step different bodies.
///
///     y = x + (1 - theta) h v
///     A dv = b        A = (1 + h alpha) M + (c h^2 + h beta) K' + c h^2 T
///                     b = h (f_ext + f_el(y) - alpha M v - K' w) - r c h^2 T v
///     x+ = y + theta h (v + dv)
///
/// with K' = sum R_e K_e R_e^T, the tensile geometric stiffness T, and w = (s h + beta) v less the rigid rotation's
/// part (docs/theory.md). s is the numerical damping of the settings; s = 1 is implicit Euler with theta = c = 1. r is
/// 0 unless the recent steps vary.

/// Step to factor for [s]: h' with h'^2 + h' beta = c h^2 + h beta, so that A0 of step h' has the stiffness coefficient
/// of A. `step` h [s], in [1e-6, 1]; `numericalDamping` s [-], in [0, 1], which determines c; beta is the material's
/// stiffness damping.
BULLETFEM_API double factorStep(double step, double numericalDamping, const Material& material);

/// Solves the free motion: rotations, system and the free velocities v + dv, without contact. Fixed nodes get their
/// target velocity. The result is velocity(body); the state is unchanged until finishStep.
BULLETFEM_API SolveReport solveFreeMotion(Body& body, const StepSettings& settings);

/// Adds the response A^-1 J to velocity(body), for impulses J, one per node [N s]; those on fixed nodes are ignored.
/// The residual of earlier responses since solveFreeMotion joins the right-hand side, so that residuals do not
/// accumulate. The tolerance is relative to the norm of the right-hand side or to `floor` [N s], >= 0, whichever is
/// larger; if the initial residual is small enough, only the momentum changes. May be called any number of times after
/// solveFreeMotion.
BULLETFEM_API SolveReport applyImpulses(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings,
                                        double floor = 0);

/// Solves the free motions of `count` different bodies. Bodies that share a model and follow each other are solved
/// together, each with its own state, fixed nodes, loads and settings: one pass over their factor serves several, and a
/// converged body leaves. Every result is bitwise equal to that of the body alone. Bodies that share a model must have
/// equal StepSettings::m_threads.
BULLETFEM_API void solveFreeMotions(FreeMotion* motions, int count);
/// Adds the responses to impulses of `count` different bodies. Bodies that share a model and follow each other are
/// solved together; every result is bitwise equal to that of the body alone.
BULLETFEM_API void applyImpulses(ImpulseResponse* responses, int count);

/// Adds a change to velocity(body), one per node [m/s], as if the nodes had always moved so; of a fixed node to its
/// prescribed velocity, too.
BULLETFEM_API void addVelocity(Body& body, const std::vector<Vec3>& change);

/// Position correction: adds h P J to the displacement of this step without changing the velocities, J one impulse per
/// node [N s], P the warped preconditioner. On the low-memory path A^-1 J, solved to 1e-3, replaces P J;
/// settings.m_threads share the work. Returns the change of the body's angular momentum about the origin by the
/// displacement at unchanged velocities [kg m2/s].
BULLETFEM_API Vec3 applyPositionCorrection(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings);
[[deprecated("applyPositionCorrection")]] inline Vec3 applyPush(Body& body, const std::vector<Vec3>& impulses,
                                                                const StepSettings& settings)
{
    return applyPositionCorrection(body, impulses, settings);
}

/// Completes the step: x <- x+ plus the position corrections, v <- velocity(body); with less than full numerical
/// damping the unresolved part is removed from v. Elastic motion that would gain energy is shortened (docs/theory.md,
/// Energy). Requires the settings of solveFreeMotion.
BULLETFEM_API void finishStep(Body& body, const StepSettings& settings);
/// Completes the steps of `count` different bodies. Bodies that share a model and follow each other are solved
/// together; every result is bitwise equal to that of the body alone.
BULLETFEM_API void finishSteps(StepEnd* ends, int count);

/// True if velocities and position corrections of the step are finite, with magnitudes below 1e6 m/s.
BULLETFEM_API bool canFinishStep(const Body& body);

/// Replaces finishStep: leaves the positions unchanged and sets the velocities to zero.
BULLETFEM_API void abandonStep(Body& body);

/// solveFreeMotion and finishStep: a step of a body without contact.
BULLETFEM_API SolveReport step(Body& body, const StepSettings& settings);

/// Velocities during the step [m/s], one per node: valid from solveFreeMotion to finishStep.
BULLETFEM_API const std::vector<Vec3>& velocity(const Body& body);

/// Mean velocities of the nodes over the step without contact [m/s], (x+ - x) / h, one per node: valid from
/// solveFreeMotion to finishStep.
BULLETFEM_API const std::vector<Vec3>& freeMeanVelocity(const Body& body);

/// Linear momentum of a state [kg m/s].
BULLETFEM_API Vec3 linearMomentum(const BodyState& state);
/// Angular momentum of a state about the origin [kg m2/s].
BULLETFEM_API Vec3 angularMomentum(const BodyState& state);

/// Kinetic energy plus the warped elastic energy 1/2 sum (R^T x - X)^T K_e (R^T x - X) [J]. Uses the body's scratch:
/// not concurrently with a step of this body, or with another call for it.
BULLETFEM_API double mechanicalEnergy(const Body& body);

}  // namespace bullet_fem
