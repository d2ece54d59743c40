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

/// The figures of one phase of a crowd: one row of the table. Times are of a step [ms].
struct CrowdFigures
{
    std::string m_phase;
    int m_steps = 0;
    double m_medianMilliseconds = 0, m_worstMilliseconds = 0;
    double m_cpuMilliseconds = 0;      ///< median of the processor time of the calling thread
    double m_freeMilliseconds = 0;     ///< median
    double m_contactMilliseconds = 0;  ///< median
    double m_restMilliseconds = 0;  ///< median of what remains: Bullet's broadphase, rigid solver, its exchange with us
    double m_contacts = 0;          ///< mean
    double m_sweeps = 0;            ///< mean
    double m_correctiveIterations = 0;  ///< mean
    int m_asleep = 0;                   ///< soft bodies, after the last step
    double m_closingSpeed = 0;          ///< worst [m/s]
    double m_deepest = 0;               ///< worst [m]
    int m_flags = 0;                    ///< btFemFlags of all steps
};

/// Sums up one phase; `steps` must not be empty.
CrowdFigures summarise(const std::string& phase, const std::vector<CrowdStep>& steps);

/// One table.
void printTable(std::ostream& out, const std::vector<CrowdFigures>& rows);

/// The same figures, one object a row.
nlohmann::json toJson(const std::vector<CrowdFigures>& rows);

}  // namespace bullet_fem
