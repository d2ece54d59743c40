// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/smoothing.h"

#include <algorithm>
#include <cmath>

#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/solve/drift.h"

namespace bullet_fem
{
namespace
{

// Maximum of |(A - M) dv| as a share of |M dv| [-] that may remain: modes of (omega h)^2 below a multiple of it are
// undamped.
constexpr double kUnresolved = 0.03;

double squaredLoads(const Body& body)
{
    double sum = 0;
    for (std::size_t i = 0; i < body.m_loads.m_force.size(); ++i)
        if (!body.m_state.m_fixed[i]) sum += dot(body.m_loads.m_force[i], body.m_loads.m_force[i]);
    return sum;
}

double squaredMomenta(const Body& body, const std::vector<Vec3>& v)
{
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) sum += body.m_state.m_mass[i] * body.m_state.m_mass[i] * dot(v[i], v[i]);
    return sum;
}

// Residual of the conjugate gradients for the loads' impulse.
double noise(const Body& body, const StepSettings& settings)
{
    return settings.m_tolerance * settings.m_step * std::sqrt(squaredLoads(body));
}

}  // namespace

bool findChange(Body& body, const StepSettings& settings)
{
    const StepCoefficients coefficients(settings, body);
    StepScratch& scratch = body.m_workspace.scratch();
    if (!(coefficients.smoothing() > 0) || scratch.m_isJoined) return false;
    std::vector<Vec3>& d = scratch.m_increment;
    for (std::size_t i = 0; i < d.size(); ++i) d[i] = scratch.m_velocity[i] - scratch.m_kickVelocity[i];
    addInward(body, -settings.m_step, d);
    scratch.m_led.removeChange(body.m_model->mesh().nodeComponent(), d);
    scratch.m_momentum.removeMotion(body, d);
    return std::sqrt(squaredMomenta(body, d)) > noise(body, settings);
}

ConjugateGradientStop smoothingStop(const Body& body, const StepSettings& settings)
{
    ConjugateGradientStop stop;
    stop.m_tolerance = kUnresolved;
    stop.m_floor = std::max(std::sqrt(squaredMomenta(body, body.m_workspace.scratch().m_increment)),
                            noise(body, settings) / kUnresolved);
    stop.m_maxIterations = settings.m_direct ? 1 : settings.m_maxIterations;
    return stop;
}

}  // namespace bullet_fem
