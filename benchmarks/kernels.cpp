// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The kernels of one step, each on its own, on the clamped beam bent by half a second of its own weight at E = 1e6.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>

#include "benchmarks/fem_beam.h"
#include "benchmarks/machine_info.h"
#include "bullet_fem/fem/stepping.h"
#include "fem/warped_system.h"

namespace
{
using namespace bullet_fem;

/// The bent beam as a step finds it: x has moved on, the rotations are still those of the step before.
struct BentBeam
{
    explicit BentBeam(int cellsPerMetre)
    {
        Material material;
        material.m_stiffnessDamping = 0.01;
        const BeamCase beam = makeBeamCase(cellsPerMetre, material);
        m_body = std::make_unique<Body>(makeBeamModel(beam));
        for (std::size_t i = 0; i < beam.m_positions.size(); ++i)
            m_body->m_loads.m_force[i] = m_body->m_state.m_mass[i] * beam.m_gravity;
        m_settings.m_step = beam.m_step;
        for (int k = 0; k < 30; ++k) step(*m_body, m_settings);
        m_in = m_body->m_state.m_v;
        m_out = m_in;
    }

    const RestShape& shape() const { return m_body->m_model->shape(); }

    std::unique_ptr<Body> m_body;
    StepSettings m_settings;
    std::vector<Vec3> m_in, m_out;
};

/// Built once for each size.
BentBeam& bentBeam(const benchmark::State& state)
{
    static std::map<int, std::unique_ptr<BentBeam>> beams;
    const int cellsPerMetre = static_cast<int>(state.range(0));
    std::unique_ptr<BentBeam>& beam = beams[cellsPerMetre];
    if (!beam) beam = std::make_unique<BentBeam>(cellsPerMetre);
    return *beam;
}

void countTets(benchmark::State& state, const BentBeam& beam)
{
    state.counters["tets"] = static_cast<double>(beam.shape().m_elements.size());
    state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(beam.shape().m_elements.size()));
}

// F, rotations, forces and the part of A of all elements; the rotations start where the last step left them.
void elementPass(benchmark::State& state)
{
    BentBeam& beam = bentBeam(state);
    const std::vector<Quaternion> start = beam.m_body->m_state.m_elementRotation;
    for (auto _ : state)
    {
        state.PauseTiming();
        beam.m_body->m_state.m_elementRotation = start;
        state.ResumeTiming();
        prepareWarpedSystem(*beam.m_body, beam.m_settings, beam.m_out);
        benchmark::DoNotOptimize(beam.m_out.data());
    }
    countTets(state, beam);
}

void systemProduct(benchmark::State& state)
{
    BentBeam& beam = bentBeam(state);
    prepareWarpedSystem(*beam.m_body, beam.m_settings, beam.m_out);
    const WarpedSystem A(*beam.m_body);
    for (auto _ : state)
    {
        A.apply(beam.m_in, beam.m_out);
        benchmark::DoNotOptimize(beam.m_out.data());
    }
    countTets(state, beam);
}

void preconditioner(benchmark::State& state)
{
    BentBeam& beam = bentBeam(state);
    prepareWarpedSystem(*beam.m_body, beam.m_settings, beam.m_out);
    const WarpedPreconditioner P(*beam.m_body);
    for (auto _ : state)
    {
        P.apply(beam.m_in, beam.m_out);
        benchmark::DoNotOptimize(beam.m_out.data());
    }
    countTets(state, beam);
}

void factorization(benchmark::State& state)
{
    BentBeam& beam = bentBeam(state);
    for (auto _ : state)
    {
        const auto model = BodyModel::create(beam.m_body->m_model->sharedShape(), beam.m_body->m_model->factorInput());
        benchmark::DoNotOptimize(model.get());
    }
    countTets(state, beam);
    state.counters["entries"] = static_cast<double>(beam.m_body->m_model->factorReport().m_entries);
}

// Cells per metre: 1,536 and 12,288 tets.
BENCHMARK(elementPass)->Arg(4)->Arg(8)->Unit(benchmark::kMicrosecond);
BENCHMARK(systemProduct)->Arg(4)->Arg(8)->Unit(benchmark::kMicrosecond);
BENCHMARK(preconditioner)->Arg(4)->Arg(8)->Unit(benchmark::kMicrosecond);
BENCHMARK(factorization)->Arg(4)->Arg(8)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv)
{
    for (const auto& field : readMachineInfo(1)) benchmark::AddCustomContext(field.first, field.second);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
