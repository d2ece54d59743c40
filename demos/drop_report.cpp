// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/drop_report.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{
namespace
{

constexpr double kMomentumTolerance = 1e-4;  // relative to the impulse of the weight; single precision gives about 1e-6
constexpr double kEnergyTolerance = 1e-4;    // relative to the initial energy
constexpr double kDepthTolerance = 0.02;     // relative to the longest side

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void row(const char* name, const char* format, ...)
{
    std::printf("  %-26s", name);
    va_list values;
    va_start(values, format);
    std::vprintf(format, values);
    va_end(values);
    std::printf("\n");
}

const char* verdict(bool good)
{
    return good ? "ok" : "FAILED";
}

void printBody(const DropScene& scene, const DropFigures& figures)
{
    const btFemStepReport& report = scene.report();
    row("nodes, tets", "%d, %d, in cells of %.4g m", report.m_nodes, report.m_tets, scene.cage().m_cellSize);
    row("mass, longest side", "%.4g kg, %.4g m", figures.mass(), scene.length());
    row("factor", "%.2f million entries, %.1f times the matrix's, made in %.0f ms", report.m_factorEntries / 1e6,
        double(report.m_factorEntries) / matrixEntries(scene.softBody()), 1e3 * report.m_factorSeconds);
}

void printSpeed(const DropScene& scene, const DropFigures& figures)
{
    const double simulated = figures.stepCount() * scene.stepSize();
    row("steps", "%d of %.3f ms", figures.stepCount(), 1e3 * scene.stepSize());
    row("wall time a step", "mean %.2f ms, worst %.2f ms", figures.m_stepMs.mean(), figures.m_stepMs.m_largest);
    row("  of it free motion", "mean %.2f ms, worst %.2f ms", figures.m_freeMotionMs.mean(),
        figures.m_freeMotionMs.m_largest);
    row("  of it contact", "mean %.2f ms, worst %.2f ms", figures.m_contactMs.mean(), figures.m_contactMs.m_largest);
    row("real time factor", "%.2f (simulated / wall time)", 1e3 * simulated / figures.m_stepMs.m_sum);
    row("PCG, free motion", "mean %.2f, most %.0f iterations", figures.m_freeIterations.mean(),
        figures.m_freeIterations.m_largest);
    row("PCG, after contact", "mean %.2f, most %.0f iterations", figures.m_contactIterations.mean(),
        figures.m_contactIterations.m_largest);
    row("steps not converged", "%d", figures.m_stepsNotConverged);
}

void printPhysics(const DropScene& scene, const DropFigures& figures)
{
    row("contacts", "mean %.1f, most %.0f", figures.m_contacts.mean(), figures.m_contacts.m_largest);
    row("deepest penetration", "%.2e m, %.2e of the longest side", figures.m_penetrationStatic,
        figures.m_penetrationStatic / scene.length());
    // Bullet moves its bodies before soft contact is solved, so a fast box penetrates by up to its path in one step.
    row("  with falling boxes", "%.2e m, %.2e of the longest side", figures.m_penetrationFalling,
        figures.m_penetrationFalling / scene.length());
    row("smallest element", "%.2f of its volume at rest%s", figures.m_smallestVolumeRatio,
        figures.m_smallestVolumeRatio < 0 ? " (inverted)" : "");
    row("speed at the end", "%.3f m/s soft body, %.3f m/s fastest box", figures.m_softSpeed, figures.m_boxSpeed);
}

bool printChecks(const DropScene& scene, const DropFigures& figures)
{
    const double balance = figures.momentumBalance();
    const bool momentum = balance < kMomentumTolerance;
    const bool energy = figures.m_largestEnergy <= figures.m_startEnergy * (1 + kEnergyTolerance);
    const bool plane = figures.m_lowestHeight >= -kDepthTolerance * scene.length();
    row("momentum", "%s: |dp - sum J - m g t| is %.1e of m g t over the run, at most %.1e in a step", verdict(momentum),
        balance, figures.m_worstStepBalance);
    row("energy", "%s: start %.2f J, largest %.2f J, end %.2f J (kinetic + weight, without elastic)", verdict(energy),
        figures.m_startEnergy, figures.m_largestEnergy, figures.m_endEnergy);
    row("plane", "%s: lowest node ever %.1e m below it", verdict(plane), std::abs(figures.m_lowestHeight));
    return momentum && energy && plane;
}

}  // namespace

bool printReport(const DropScene& scene, const DropFigures& figures)
{
    std::printf("\nbody\n");
    printBody(scene, figures);
    std::printf("speed (one thread)\n");
    printSpeed(scene, figures);
    std::printf("physics\n");
    printPhysics(scene, figures);
    std::printf("checks\n");
    return printChecks(scene, figures);
}

}  // namespace bullet_fem
