// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/fem_beam.h"

#include <chrono>
#include <cmath>

#include "bullet_fem/fem/stepping.h"
#include "fem/step_scratch.h"
#include "fem/warped_system.h"

namespace bullet_fem
{
namespace
{

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string methodName(const StepSettings& settings)
{
    if (settings.m_direct) return "direct";
    return settings.m_warp == Warp::nodal ? "nodal" : "global";
}

/// |b - A (v_after - v_before)| / |b| of the step just made; its rotations, tension and b are still those of its start.
double trueResidual(const Body& body, const std::vector<Vec3>& velocityBefore, double step)
{
    const std::size_t n = velocityBefore.size();
    std::vector<Vec3> dv(n), Adv(n);
    for (std::size_t i = 0; i < n; ++i) dv[i] = body.m_state.m_v[i] - velocityBefore[i];
    WarpedSystem(body, step).apply(dv, Adv);

    const std::vector<Vec3>& b = body.m_workspace.scratch().m_rightSide;
    double squaredResidual = 0;
    for (std::size_t i = 0; i < n; ++i) squaredResidual += dot(b[i] - Adv[i], b[i] - Adv[i]);
    return std::sqrt(squaredResidual / dot(b, b));
}

}  // namespace

std::shared_ptr<const BodyModel> makeBeamModel(const BeamCase& beam)
{
    const auto shape = std::make_shared<const RestShape>(TetMesh(beam.m_positions, beam.m_tets), beam.m_material);
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_fixed.assign(beam.m_positions.size(), 0);
    for (int i : beam.m_clampedNodes) input.m_fixed[i] = 1;
    input.m_step = beam.m_step;
    return BodyModel::create(shape, std::move(input));
}

BeamRun runFem(const BeamCase& beam, StepSettings settings)
{
    settings.m_step = beam.m_step;
    BeamRun run;
    run.m_method = methodName(settings);
    run.m_tolerance = settings.m_direct ? 0 : settings.m_tolerance;

    const Clock::time_point setUp = Clock::now();
    Body body(makeBeamModel(beam));
    run.m_setupSeconds = secondsSince(setUp);
    for (std::size_t i = 0; i < beam.m_positions.size(); ++i)
    {
        body.m_loads.m_force[i] = body.m_state.m_mass[i] * beam.m_gravity;
        if (!body.m_state.m_fixed[i]) run.m_mass += body.m_state.m_mass[i];
    }

    for (int k = 0; k < beam.m_steps; ++k)
    {
        const std::vector<Vec3> velocityBefore = body.m_state.m_v;
        const Clock::time_point start = Clock::now();
        const SolveReport report = step(body, settings);
        run.m_stepSeconds.push_back(secondsSince(start));
        run.m_iterations.push_back(report.m_iterations);
        run.m_residuals.push_back(trueResidual(body, velocityBefore, beam.m_step));
        run.m_tipHeights.push_back(body.m_state.m_x[beam.m_tipNode].z);
    }
    return run;
}

}  // namespace bullet_fem
