// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/contact/contact_run.h"

#include <algorithm>
#include <numeric>

#include "benchmarks/contact/contact_measures.h"
#include "benchmarks/figures.h"

namespace bullet_fem
{
namespace
{

constexpr int kCreepSteps = 20;
constexpr double kFailure = 0.5;  // overlap over the cell size at which a run is aborted

/// One entry per step with contact; if no step has contact, one per step.
struct Series
{
    std::vector<double> m_total, m_cpu, m_free, m_contact, m_sweeps, m_iterations, m_closing;

    void add(const ContactStep& step)
    {
        m_total.push_back(step.m_milliseconds);
        m_cpu.push_back(step.m_cpuMilliseconds);
        m_free.push_back(step.m_freeMilliseconds);
        m_contact.push_back(step.m_contactMilliseconds);
        m_sweeps.push_back(step.m_sweeps);
        m_iterations.push_back(step.m_correctiveIterations);
        m_closing.push_back(step.m_closingSpeed);
    }
};

double mean(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

void summarise(const Series& series, ContactFigures& row)
{
    row.m_medianMilliseconds = median(series.m_total);
    row.m_worstMilliseconds = largest(series.m_total);
    row.m_cpuMilliseconds = median(series.m_cpu);
    row.m_freeMilliseconds = median(series.m_free);
    row.m_contactMilliseconds = median(series.m_contact);
    row.m_sweeps = mean(series.m_sweeps);
    row.m_correctiveIterations = mean(series.m_iterations);
    row.m_closingSpeed = largest(series.m_closing);
}

void noteMomentum(const Momentum& start, const Momentum& now, ContactFigures& row)
{
    const double scale = std::max(start.m_scale, now.m_scale);
    row.m_linearError = largest({row.m_linearError, norm(now.m_linear - start.m_linear) / scale});
    row.m_angularError = largest({row.m_angularError, norm(now.m_angular - start.m_angular) / (scale * row.m_size)});
}

double fastest(const std::vector<Vec3>& before, const std::vector<Vec3>& after, double seconds)
{
    std::vector<double> speeds;
    for (std::size_t i = 0; i < before.size(); ++i) speeds.push_back(norm(after[i] - before[i]) / seconds);
    return largest(speeds);
}

}  // namespace

ContactFigures runContact(const ContactScene& scene, ContactWorld& world)
{
    ContactFigures row;
    row.m_scene = scene.m_name;
    row.m_method = world.name();
    row.m_tets = scene.tetCount();
    row.m_nodes = scene.nodeCount();
    row.m_size = scene.m_size;
    row.m_free = scene.isFree();
    row.m_steps = scene.m_steps;

    const Momentum start = momentumOf(world);
    std::vector<Vec3> centers = centersOf(world);
    Series touching, apart;
    const int creepFrom = std::max(0, scene.m_steps - kCreepSteps);
    for (int k = 0; k < scene.m_steps && row.holds(); ++k)
    {
        if (k == creepFrom) centers = centersOf(world);
        const ContactStep step = world.step();
        (step.m_contacts > 0 ? touching : apart).add(step);
        row.m_contacts = std::max(row.m_contacts, step.m_contacts);
        row.m_flags |= step.m_flags;
        row.m_deepest = largest({row.m_deepest, deepestPenetration(world, 0)});
        if (!(row.m_deepest <= kFailure * scene.m_cellSize)) row.m_failedStep = k + 1;
        if (row.m_free) noteMomentum(start, momentumOf(world), row);
    }
    row.m_touchingSteps = static_cast<int>(touching.m_total.size());
    row.m_deepestAtEnd = deepestPenetration(world, world.restDistance());
    row.m_creep = row.holds() ? fastest(centers, centersOf(world), (scene.m_steps - creepFrom) * scene.m_step) : NAN;
    summarise(touching.m_total.empty() ? apart : touching, row);
    return row;
}

}  // namespace bullet_fem
