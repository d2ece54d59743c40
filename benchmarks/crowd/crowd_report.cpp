// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/crowd/crowd_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmarks/figures.h"
#include "bullet_fem/btFemReports.h"

namespace bullet_fem
{

CrowdFigures summarise(const std::string& phase, const std::vector<CrowdStep>& steps)
{
    CrowdFigures row;
    row.m_phase = phase;
    row.m_steps = static_cast<int>(steps.size());
    std::vector<double> total, cpu, free, contact, rest;
    for (const CrowdStep& step : steps)
    {
        total.push_back(step.m_milliseconds);
        cpu.push_back(step.m_cpuMilliseconds);
        free.push_back(step.m_freeMilliseconds);
        contact.push_back(step.m_contactMilliseconds);
        rest.push_back(step.m_milliseconds - step.m_freeMilliseconds - step.m_contactMilliseconds);
        row.m_contacts += double(step.m_contacts) / row.m_steps;
        row.m_sweeps += double(step.m_sweeps) / row.m_steps;
        row.m_correctiveIterations += double(step.m_correctiveIterations) / row.m_steps;
        row.m_closingSpeed = std::max(row.m_closingSpeed, step.m_closingSpeed);
        row.m_deepest = std::max(row.m_deepest, step.m_deepest);
        row.m_flags |= step.m_flags;
    }
    row.m_asleep = steps.back().m_asleep;
    row.m_medianMilliseconds = median(total);
    row.m_worstMilliseconds = largest(total);
    row.m_cpuMilliseconds = median(cpu);
    row.m_freeMilliseconds = median(free);
    row.m_contactMilliseconds = median(contact);
    row.m_restMilliseconds = median(rest);
    return row;
}

void printTable(std::ostream& out, const std::vector<CrowdFigures>& rows)
{
    print(out, "%-15s %5s  %9s %9s %8s %8s %10s %8s  %7s %6s %7s  %6s  %11s %10s\n", "phase", "steps", "median ms",
          "worst ms", "CPU ms", "free ms", "contact ms", "rest ms", "points", "sweeps", "corr.it", "asleep",
          "closing m/s", "deepest mm");
    for (const CrowdFigures& row : rows)
    {
        print(out, "%-15s %5d  %9.2f %9.2f %8.2f %8.2f %10.2f %8.2f  %7.0f %6.0f %7.0f  %6d  %11.1e %10.3f\n",
              row.m_phase.c_str(), row.m_steps, row.m_medianMilliseconds, row.m_worstMilliseconds,
              row.m_cpuMilliseconds, row.m_freeMilliseconds, row.m_contactMilliseconds, row.m_restMilliseconds,
              row.m_contacts, row.m_sweeps, row.m_correctiveIterations, row.m_asleep, row.m_closingSpeed,
              1e3 * row.m_deepest);
        if (row.m_flags & BT_FEM_NOT_CONVERGED) out << "                ^ a solve hit its iteration cap in a step\n";
        if (row.m_flags & BT_FEM_BREAKDOWN) out << "                ^ a solve broke down in a step\n";
        if (row.m_flags & BT_FEM_CONTACT_LIMIT) out << "                ^ more contact points than a body's limit\n";
    }
}

nlohmann::json toJson(const std::vector<CrowdFigures>& rows)
{
    nlohmann::json results = nlohmann::json::array();
    for (const CrowdFigures& row : rows)
        results.push_back({{"phase", row.m_phase},
                           {"steps", row.m_steps},
                           {"ms_median", row.m_medianMilliseconds},
                           {"ms_worst", row.m_worstMilliseconds},
                           {"ms_cpu_median", row.m_cpuMilliseconds},
                           {"ms_free_median", row.m_freeMilliseconds},
                           {"ms_contact_median", row.m_contactMilliseconds},
                           {"ms_rest_median", row.m_restMilliseconds},
                           {"contacts_mean", row.m_contacts},
                           {"sweeps_mean", row.m_sweeps},
                           {"corrective_iterations_mean", row.m_correctiveIterations},
                           {"asleep", row.m_asleep},
                           {"closing_speed_worst_m_s", row.m_closingSpeed},
                           {"penetration_worst_m", row.m_deepest},
                           {"flags", row.m_flags}});
    return results;
}

}  // namespace bullet_fem
