// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// One linearly implicit step, in the three parts that constraints need. None of them allocates or throws, but for what
/// StepSettings::m_threads says; different bodies may be stepped by different threads.
///
///     y = x + (1 - theta) h v
///     A dv = b        A = (1 + h alpha) M + (c h^2 + h beta) K' + c h^2 T
///                     b = h (f_ext + f_el(y) - alpha M v - (s h + beta) K' v) - r c h^2 T v
///     x+ = y + theta h (v + dv)
///
/// with K' = sum R_e K_e R_e^T and the tensile geometric stiffness T (docs/theory.md). s is the numerical damping of
/// the settings; implicit Euler with s = 1, for which theta = c = 1. r is 0 unless the recent steps vary.

/// Step of FactorInput [s] that A of a step of `step` and that numerical damping is factored with: c of its h^2 K are
/// in that step's h^2.
BULLETFEM_API double factorStep(double step, double numericalDamping, const Material& material);

/// Rotations, system and the free velocities v + dv, as if nothing touched the body. Nodes marked fixed get their
/// target velocity. The result stands in velocity(body) and is not yet the state's.
BULLETFEM_API SolveReport solveFreeMotion(Body& body, const StepSettings& settings);

/// Adds the response A^-1 J to velocity(body), for impulses J on the nodes [N s]; those on fixed nodes are ignored.
/// What is left of other impulses since solveFreeMotion is solved for with them, so that no residual adds up; it is
/// measured against what there is to solve or `floor`, whichever is larger [N s], >= 0. Where it is small enough from
/// the start only the momentum changes. To be called after solveFreeMotion, any number of times.
BULLETFEM_API SolveReport applyImpulses(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings,
                                        double floor = 0);

/// The same for `count` different bodies. Those that share their model and come one after the other are solved
/// together, each with its own state, fixed nodes, loads and settings: a pass over their factor serves several of them,
/// and whoever has converged leaves. Every body gets the bits that it gets alone. Bodies that share their model must
/// have the same StepSettings::m_threads.
BULLETFEM_API void solveFreeMotions(FreeMotion* motions, int count);
/// applyImpulses of several bodies, likewise.
BULLETFEM_API void applyImpulses(ImpulseResponse* responses, int count);

/// Adds to velocity(body), one change a node [m/s], as if the nodes had always moved so; fixed nodes keep theirs.
BULLETFEM_API void addVelocity(Body& body, const std::vector<Vec3>& change);

/// Adds h P J to the displacement of this step without a trace in the velocities: position correction, J [N s]. On the
/// low-memory path A^-1 J, solved to 1e-3, stands for P J; settings.m_threads share the work. Returns the angular
/// momentum about the origin that the body gains by being elsewhere with its velocities [kg m2/s].
BULLETFEM_API Vec3 applyPush(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings);

/// x <- x+ and v <- velocity(body), and the pushes; with less than full numerical damping v goes without what the step
/// does not resolve. To be called with the settings of solveFreeMotion; side by side as above.
BULLETFEM_API void finishStep(Body& body, const StepSettings& settings);
/// finishStep of several bodies, likewise.
BULLETFEM_API void finishSteps(StepEnd* ends, int count);

/// True if the velocities and pushes of the step are numbers, and below 1e6 m/s.
BULLETFEM_API bool canFinishStep(const Body& body);

/// In place of finishStep: the body stands still where it is.
BULLETFEM_API void abandonStep(Body& body);

/// solveFreeMotion and finishStep: a step of a body that touches nothing.
BULLETFEM_API SolveReport step(Body& body, const StepSettings& settings);

/// Velocities during the step [m/s], one a node: valid from solveFreeMotion to finishStep.
BULLETFEM_API const std::vector<Vec3>& velocity(const Body& body);

/// With which nodes move in the step, as if nothing touched them [m/s]: (x+ - x) / h, valid likewise.
BULLETFEM_API const std::vector<Vec3>& freeMeanVelocity(const Body& body);

/// Linear momentum of a state [kg m/s].
BULLETFEM_API Vec3 linearMomentum(const BodyState& state);
/// Angular momentum of a state about the origin [kg m2/s].
BULLETFEM_API Vec3 angularMomentum(const BodyState& state);

/// Kinetic energy plus the warped elastic energy 1/2 sum (x R - X)^T K_e (R^T x - X) [J].
BULLETFEM_API double mechanicalEnergy(const Body& body);

}  // namespace bullet_fem
