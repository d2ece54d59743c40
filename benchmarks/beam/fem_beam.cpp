// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/beam/fem_beam.h"

#include <cmath>
#include <stdexcept>

#include "benchmarks/figures.h"
#include "benchmarks/heap_bytes.h"
#include "benchmarks/reference/warped_elements.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

std::string methodName(const StepSettings& settings)
{
    if (settings.m_direct) return "direct";
    return settings.m_warp == Warp::nodal ? "nodal" : "global";
}

/// |b - A dv| / |b| of the last step. A and b are assembled anew in double precision from the state before the step,
/// independently of the solver.
class TrueResidual
{
public:
    TrueResidual(const Body& body, const StepSettings& settings)
        : m_body(body), m_settings(settings), m_rotation(body.m_model->shape().m_elements.size(), Mat3::identity())
    {
    }

    /// Call before the step.
    void start()
    {
        m_x = m_body.m_state.m_x;
        m_v = m_body.m_state.m_v;
    }

    /// Call after the step.
    double measure()
    {
        const RestShape& shape = m_body.m_model->shape();
        const double h = m_settings.m_step, alpha = shape.m_material.m_massDamping,
                     beta = shape.m_material.m_stiffnessDamping;
        std::vector<Vec3> b = m_body.m_loads.m_force, dv(b.size()), Adv(b.size());
        std::vector<std::array<double, 6>> tension(m_rotation.size());
        updateElementRotations(shape, m_x, m_rotation);
        addElasticForces(shape, m_x, m_v, h + beta, m_rotation, b, &tension);
        for (std::size_t i = 0; i < b.size(); ++i)
        {
            b[i] -= alpha * m_body.m_state.m_mass[i] * m_v[i];
            dv[i] = m_body.m_state.m_v[i] - m_v[i];
            Adv[i] = (1 + h * alpha) * m_body.m_state.m_mass[i] * dv[i];
        }
        addStiffnessProduct(shape, m_rotation, tension, {h * h + h * beta, m_settings.m_tension ? h * h : 0}, dv, Adv);
        double residual = 0, size = 0;
        for (std::size_t i = 0; i < b.size(); ++i)
        {
            if (m_body.m_state.m_fixed[i]) continue;
            const Vec3 bi = h * b[i], r = bi - Adv[i];
            residual += dot(r, r);
            size += dot(bi, bi);
        }
        return std::sqrt(residual / size);
    }

private:
    const Body& m_body;
    StepSettings m_settings;
    std::vector<Mat3> m_rotation;
    std::vector<Vec3> m_x, m_v;
};

void load(Body& body, const BeamCase& beam)
{
    for (std::size_t i = 0; i < beam.m_positions.size(); ++i)
        body.m_loads.m_force[i] = body.m_state.m_mass[i] * beam.m_gravity;
}

}  // namespace

std::shared_ptr<const BodyModel> makeBeamModel(const BeamCase& beam, FactorChoice choice)
{
    const auto shape = std::make_shared<const RestShape>(TetMesh(beam.m_positions, beam.m_tets), beam.m_material);
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_fixed.assign(beam.m_positions.size(), 0);
    for (int i : beam.m_clampedNodes) input.m_fixed[i] = 1;
    input.m_step = beam.m_step;
    input.m_choice = choice;
    return BodyModel::create(shape, std::move(input));
}

BeamRun runFem(const BeamCase& beam, StepSettings settings, FactorChoice choice)
{
    settings.m_step = beam.m_step;
    BeamRun run;
    run.m_method = methodName(settings);
    run.m_tolerance = settings.m_direct ? 0 : settings.m_tolerance;
    if (!settings.m_direct) run.m_residualBound = settings.m_tolerance;

    const std::size_t heapBefore = heapBytes();
    const Stopwatch setUp;
    Body body(makeBeamModel(beam, choice));
    run.m_setupSeconds = setUp.seconds();
    run.m_factorBytes = body.m_model->factorReport().m_bytes;
    load(body, beam);
    for (std::size_t i = 0; i < beam.m_positions.size(); ++i)
        if (!body.m_state.m_fixed[i]) run.m_mass += body.m_state.m_mass[i];
    for (int k = 0; k < beam.m_steps; ++k)
    {
        const Stopwatch watch;
        const SolveReport report = step(body, settings);
        run.m_cpuSeconds.push_back(watch.cpuSeconds());
        run.m_stepSeconds.push_back(watch.seconds());
        run.m_iterations.push_back(report.m_iterations);
        run.m_tipHeights.push_back(body.m_state.m_x[beam.m_tipNode].z);
    }
    run.m_heapBytes = heapBytes() - heapBefore;

    // Repeats the steps bit for bit for the error measurement, so that it does not evict the caches of the timed steps.
    Body again(body.m_model);
    load(again, beam);
    TrueResidual residual(again, settings);
    for (int k = 0; k < beam.m_steps; ++k)
    {
        residual.start();
        step(again, settings);
        run.m_residuals.push_back(residual.measure());
        if (again.m_state.m_x[beam.m_tipNode].z != run.m_tipHeights[k])
            throw std::runtime_error("the beam's step " + std::to_string(k) + " came out differently when repeated");
    }
    return run;
}

}  // namespace bullet_fem
