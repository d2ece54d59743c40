// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/quasi_newton.h"

#include <algorithm>
#include <cmath>

#include "bullet_fem/fem/common/threads.h"
#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/elements/model_elements.h"
#include "fem/solve/drift.h"

namespace bullet_fem
{
namespace
{

// Share of the initial slope, accepted at the full step [Bonet & Wood 2008, 9.6.2].
constexpr double kMaxTurned = 0.5;

/// Tolerance of a correction relative to |r| [-] [Dembo et al. 1982]; the next correction or step sees the rest.
constexpr double kInexact = 0.1;

}  // namespace

QuasiNewton::QuasiNewton(Body& body, const StepSettings& settings, const WarpedSystem& A)
    : m_body(body), m_settings(settings), m_A(A)
{
}

void QuasiNewton::correct(const ConjugateGradientStop& stop, SolveReport& report)
{
    StepScratch& scratch = m_body.m_workspace.scratch();
    QuasiNewtonScratch& newton = scratch.m_newton;
    const double scale = std::max(std::sqrt(dot(scratch.m_rightSide, scratch.m_rightSide)), stop.m_floor);
    ConjugateGradientStop corrections = stop;
    corrections.m_tolerance = std::max(stop.m_tolerance, kInexact);
    corrections.m_steady = false;
    newton.m_elastic = scratch.m_kickVelocity;
    removeRigidVelocity(m_body, newton.m_elastic);
    std::fill(newton.m_chord.begin(), newton.m_chord.end(), Vec3());
    addInward(m_body, -m_settings.m_step, newton.m_chord);
    double left = findResidual();
    for (int k = 0; k < kMaxCorrections && left > kLeftShare * scale && std::isfinite(left); ++k)
    {
        const WarpedPreconditioner P(m_body, m_settings.m_threads);
        const SolveReport found = solveConjugateGradients(
            {m_A, P, newton.m_residual, newton.m_direction, scratch.m_solver, m_settings.m_threads}, corrections,
            false);
        report.m_iterations += found.m_iterations;
        if (found.m_stop != SolveStop::converged) report.m_stop = found.m_stop;
        const double slope = dot(newton.m_direction, newton.m_residual);
        if (!(slope > 0)) return;  // nothing but rounding error is left
        move(1);
        left = findResidual();
        searchLine(slope);
    }
}

// The residual r of the equation in quasi_newton.h at z; also evaluates A there.
double QuasiNewton::findResidual()
{
    StepScratch& scratch = m_body.m_workspace.scratch();
    QuasiNewtonScratch& newton = scratch.m_newton;
    const BodyState& state = m_body.m_state;
    const StepCoefficients c(m_settings, m_body);
    const double h = m_settings.m_step, beta = m_body.m_model->shape().m_material.m_stiffnessDamping;
    std::vector<Vec3>&z = newton.m_position, &r = newton.m_residual, &w = newton.m_viscous;
    for (std::size_t i = 0; i < z.size(); ++i)
    {
        const Vec3 &dv = scratch.m_increment[i], &v = newton.m_elastic[i], &chord = newton.m_chord[i];
        z[i] = scratch.m_kickPosition[i] + h * (c.m_damping * v + c.stiffness() * dv) +
               c.chordStrain(m_body, h, 0) * chord;
        w[i] = beta * (v + dv) + c.chordStrain(m_body, 0, beta) * chord;
        r[i] = {};
    }
    prepareWarpedSystem(m_body, m_settings, z, w, r);
    if (scratch.m_reactions.isNoting()) scratch.m_reactions.noteForces(newton.m_loads, r);
    const std::vector<double>& mass = scratch.m_elements.m_scaledMass;
    for (std::size_t i = 0; i < r.size(); ++i)
        r[i] = state.m_fixed[i] ? Vec3() : newton.m_loads[i] + h * r[i] - mass[i] * scratch.m_increment[i];
    scratch.m_momentum.removeImpulses(m_body, r);
    return std::sqrt(dot(r, r));
}

void QuasiNewton::searchLine(double slope)
{
    const QuasiNewtonScratch& newton = m_body.m_workspace.scratch().m_newton;
    double length = 1;
    for (int k = 0; k < kMaxLineSearches; ++k)
    {
        const double turned = dot(newton.m_direction, newton.m_residual);
        if (turned >= -kMaxTurned * slope) return;
        const double back = std::isfinite(turned) ? slope / (slope - turned) * length : 0.25 * length;
        move(back - length);
        length = back;
        findResidual();
    }
}

void QuasiNewton::move(double length)
{
    StepScratch& scratch = m_body.m_workspace.scratch();
    std::vector<Vec3>& dv = scratch.m_increment;
    for (std::size_t i = 0; i < dv.size(); ++i)
        if (!m_body.m_state.m_fixed[i]) dv[i] += length * scratch.m_newton.m_direction[i];
}

}  // namespace bullet_fem
