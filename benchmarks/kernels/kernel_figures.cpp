// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/kernels/kernel_figures.h"

#include <algorithm>
#include <cstdint>

#include "benchmarks/beam/setup_stages.h"
#include "benchmarks/kernels/bent_beam.h"
#include "benchmarks/kernels/machine_limits.h"
#include "fem/elements/element_pass.h"
#include "fem/elements/node_rotations.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

constexpr double kProductOperations = 180;  // per tet: H 54, stress 72, forces 54; sums over nodes not counted
constexpr std::size_t kReadGrain = 512;     // floats

// Bytes per tet of data stored in blocks of kLanes.
double perTet(std::size_t blockBytes)
{
    return static_cast<double>(blockBytes) / kLanes;
}

// Bytes that the element pass reads (rest shape, rotation) and writes (rotation, force, contribution to A).
double passBytes(double tets, double nodes)
{
    return tets * (perTet(sizeof(ElementBlock<float>) + sizeof(CornerBlock<float>) + sizeof(WarpedBlock<float>)) +
                   2 * sizeof(Quaternion)) +
           nodes * 2 * sizeof(PaddedVec3);
}

// The sums over nodes read the corners and their indices; the rotations are gathered a second time.
double preparationBytes(double tets, double nodes)
{
    const double sums = perTet(sizeof(CornerBlock<float>)) + 4 * sizeof(int),
                 rotations = sizeof(Quaternion) + sizeof(float) + 4 * sizeof(int);
    return passBytes(tets, nodes) + tets * (sums + rotations) +
           nodes * (6 * sizeof(Vec3) + 2 * sizeof(PaddedVec3) + sizeof(NodeRotation));
}

// Corner values are written and read again.
double productBytes(double tets, double nodes)
{
    return tets * (perTet(sizeof(WarpedBlock<float>) + 2 * sizeof(CornerBlock<float>)) + 4 * sizeof(std::int32_t) +
                   4 * sizeof(int)) +
           nodes * (2 * sizeof(Vec3) + 2 * sizeof(PaddedVec3) + sizeof(double));
}

// Operations for one right-hand side: M forward, S, M^T backward.
double solveOperations(const SupernodeTree& tree)
{
    double sum = 0;
    for (const Supernode& s : tree.m_supernodes)
    {
        const double c = 3.0 * s.m_columns, r = 3.0 * s.m_rows;
        sum += 4 * c * r + 2 * c * c;
    }
    return sum;
}

// A buffer of the packed factor's size, which is read in turns with it.
struct ReadBuffer
{
    explicit ReadBuffer(std::size_t bytes)
        : m_count((bytes / sizeof(float) + kReadGrain - 1) / kReadGrain * kReadGrain), m_values(allocateFloats(m_count))
    {
        std::fill(m_values.get(), m_values.get() + m_count, 1.f);
    }

    std::size_t m_count;
    AlignedFloats m_values;
    float m_sum = 0;
};

KernelFigures row(int tets, const TimedWork& work, const Timing& time)
{
    KernelFigures figures;
    figures.m_tets = tets;
    figures.m_kernel = work.m_name;
    figures.m_time = time;
    return figures;
}

/// Times the factorization alone; once for large beams.
KernelFigures timeFactorization(const BentBeam& beam, double seconds)
{
    std::vector<double> times;
    SetupStages stages;
    double spent = 0;
    do
    {
        stages = measureSetup(beam.model());
        times.push_back(stages.m_numeric);
        spent += stages.total();
    } while (spent < seconds);
    std::sort(times.begin(), times.end());
    KernelFigures figures;
    figures.m_tets = beam.tetCount();
    figures.m_kernel = "factorization";
    figures.m_time = {times.front(), times[times.size() / 2], static_cast<int>(times.size())};
    figures.m_operations = stages.m_operations;
    return figures;
}

}  // namespace

KernelRun measureKernels(int tets, double seconds)
{
    BentBeam beam(tets);
    const PackedFactor& factor = beam.model().factor().lower();
    ReadBuffer buffer(factor.byteCount());
    const std::vector<TimedWork> elements = {
        {"element pass", [&] { beam.passOverElements(); }, [&] { beam.restoreInput(); }},
        {"preparation", [&] { beam.prepareSystem(); }, [&] { beam.forgetRotations(); }},
        {"product A p", [&] { beam.multiply(); }, nullptr}};
    const std::vector<TimedWork> solves = {
        {"preconditioner", [&] { beam.precondition(); }, nullptr},
        {"read of that size", [&] { buffer.m_sum += readOnce(buffer.m_values.get(), buffer.m_count); }, nullptr},
        {"solve pair", [&] { beam.solve(); }, [&] { beam.resetVector(); }},
        {"16 solve pairs", [&] { beam.solveLanes(); }, [&] { beam.resetLanes(); }}};

    KernelRun run;
    for (const std::vector<TimedWork>& group : {elements, solves})
    {
        const std::vector<Timing> times = timeInTurns(group, seconds);
        for (std::size_t k = 0; k < group.size(); ++k) run.m_kernels.push_back(row(tets, group[k], times[k]));
    }
    const double nodes = beam.model().nodeCount(), bytes = static_cast<double>(factor.byteCount());
    std::vector<KernelFigures>& rows = run.m_kernels;
    rows[0].m_bytes = passBytes(tets, nodes);
    rows[1].m_bytes = preparationBytes(tets, nodes);
    rows[2].m_bytes = productBytes(tets, nodes);
    rows[2].m_operations = kProductOperations * tets;
    rows[4].m_bytes = static_cast<double>(buffer.m_count * sizeof(float));
    rows[3].m_bytes = rows[5].m_bytes = rows[6].m_bytes = 2 * bytes;
    rows[5].m_operations = solveOperations(factor.tree());
    rows[6].m_operations = kPanelLanes * rows[5].m_operations;

    run.m_solves.m_tets = tets;
    run.m_solves.m_factorMegabytes = 1e-6 * bytes;
    run.m_solves.m_readGigabytes = rows[4].gigabytesPerSecond();
    run.m_solves.m_solveOverTwoReads = medianRatio(solves[2], solves[1], seconds) / 2;
    run.m_solves.m_solveOverBestReads = rows[5].m_time.m_best / (2 * rows[4].m_time.m_best);
    run.m_solves.m_lanesOverOne = rows[6].m_time.m_best / rows[5].m_time.m_best;
    rows.push_back(timeFactorization(beam, seconds));
    return run;
}

}  // namespace bullet_fem
