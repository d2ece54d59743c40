// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/beam/beam_methods.h"

#include "benchmarks/beam/bullet_deformable_beam.h"
#include "benchmarks/beam/fem_beam.h"
#include "benchmarks/beam/mass_spring_beam.h"

namespace bullet_fem
{
namespace
{

constexpr double kExact = 1e-8;  // tolerance of the reference solution of each scheme

StepSettings exactSettings(bool tension, const Threads* threads)
{
    StepSettings settings;
    settings.m_tension = tension;
    settings.m_tolerance = kExact;
    settings.m_threads = threads;
    return settings;
}

void addDirect(const BeamCase& beam, StepSettings settings, const BeamRun& exact, std::vector<BeamFigures>& rows)
{
    settings.m_warp = Warp::nodal;
    settings.m_tolerance = 1e-3;
    settings.m_direct = true;
    rows.push_back(summarise(beam, runFem(beam, settings), exact));
}

/// Ratio of the median time of Bullet's deformable world (last row) to that of each row.
void compareTimes(std::vector<BeamFigures>& rows)
{
    const BeamFigures bullet = rows.back();
    for (BeamFigures& row : rows)
    {
        row.m_timesFasterThanBullet = bullet.m_medianMilliseconds / row.m_medianMilliseconds;
        row.m_cpuTimesFaster = bullet.m_cpuMilliseconds / row.m_cpuMilliseconds;
    }
}

}  // namespace

std::vector<BeamFigures> compareMethods(const BeamCase& beam, const BeamMethods& methods)
{
    StepSettings settings = exactSettings(methods.m_tension, methods.m_threads);
    const BeamRun exact = runFem(beam, settings);
    std::vector<BeamFigures> rows;
    for (double tolerance : {1e-3, 1e-6})
        for (Warp warp : {Warp::nodal, Warp::global})
        {
            settings.m_tolerance = tolerance;
            settings.m_warp = warp;
            rows.push_back(summarise(beam, runFem(beam, settings), exact));
        }
    rows.push_back(summarise(beam, exact, exact));
    addDirect(beam, settings, exact, rows);
    if (!methods.m_withBullet) return rows;

    const BeamRun springs = runMassSpring(beam, methods.m_springIterations);
    rows.push_back(summarise(beam, springs, exact));
    rows.push_back(summarise(beam, runBulletDeformable(beam), runFem(beam, exactSettings(false, methods.m_threads))));
    compareTimes(rows);
    return rows;
}

std::vector<BeamFigures> traceErrorCurve(const BeamCase& beam, const BeamMethods& methods)
{
    StepSettings settings = exactSettings(methods.m_tension, methods.m_threads);
    settings.m_tolerance = 1e-2 * kExact;  // tighter than the tightest tolerance of the curve
    const BeamRun exact = runFem(beam, settings);
    std::vector<BeamFigures> rows;
    for (Warp warp : {Warp::nodal, Warp::global})
        for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
        {
            settings.m_tolerance = tolerance;
            settings.m_warp = warp;
            rows.push_back(summarise(beam, runFem(beam, settings), exact));
        }
    addDirect(beam, settings, exact, rows);
    if (!methods.m_withBullet) return rows;

    const BeamRun bulletExact = runBulletDeformable(beam, 1e-12);
    for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
        rows.push_back(summarise(beam, runBulletDeformable(beam, tolerance), bulletExact));
    rows.push_back(summarise(beam, runBulletDeformable(beam), bulletExact));
    compareTimes(rows);
    return rows;
}

}  // namespace bullet_fem
