// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "benchmarks/crowd/crowd_world.h"

namespace bullet_fem
{

/// Results of one phase of a crowd: one row of the table. Times are per step [ms].
struct CrowdFigures
{
    std::string m_phase;
    int m_steps = 0;
    double m_medianMilliseconds = 0, m_worstMilliseconds = 0;
    double m_cpuMilliseconds = 0;       ///< median, calling thread only
    double m_freeMilliseconds = 0;      ///< median
    double m_contactMilliseconds = 0;   ///< median
    double m_restMilliseconds = 0;      ///< median of the remaining time: broad phase, rigid solver, exchange
    double m_contacts = 0;              ///< mean per step
    double m_sweeps = 0;                ///< mean per step
    double m_correctiveIterations = 0;  ///< mean per step
    int m_asleep = 0;                   ///< sleeping soft bodies after the last step
    double m_closingSpeed = 0;          ///< maximum [m/s]
    double m_deepest = 0;               ///< maximum [m]
    int m_flags = 0;                    ///< btFemFlags of all steps, combined
};

/// Summarises one phase; `steps` must not be empty.
CrowdFigures summarise(const std::string& phase, const std::vector<CrowdStep>& steps);

/// Prints one table.
void printTable(std::ostream& out, const std::vector<CrowdFigures>& rows);

/// The results as JSON, one object per row.
nlohmann::json toJson(const std::vector<CrowdFigures>& rows);

}  // namespace bullet_fem
