// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

namespace bullet_fem
{

/// Copies of one cube that oscillate in free fall, solved together or one by one.
struct FreeCopiesSettings
{
    int m_bodies = 16;          ///< >= 1
    int m_cells = 6;            ///< along each edge of 0.2 m, in [1, 40]; five or six tets per cell
    double m_young = 1e6;       ///< E [Pa], > 0
    double m_tolerance = 1e-3;  ///< StepSettings::m_tolerance
    double m_stale = 1;         ///< step over the factor's, > 0; other values than 1 take more iterations
    int m_steps = 120;          ///< timed steps of 1/60 s, >= 1
};

/// Results: processor time of the calling thread for solveFreeMotion and finishStep.
struct FreeCopiesFigures
{
    FreeCopiesSettings m_settings;
    int m_tets = 0;                     ///< per body
    double m_factorMegabytes = 0;       ///< [1e6 B]
    double m_iterations = 0;            ///< mean per body and step
    double m_togetherMilliseconds = 0;  ///< all bodies solved together, median per step [ms]
    double m_aloneMilliseconds = 0;     ///< bodies solved one by one, median per step [ms]
    bool m_sameBits = false;            ///< positions and velocities after the last step are bitwise equal

    double ratio() const { return m_aloneMilliseconds / m_togetherMilliseconds; }
};

/// Steps two sets of copies alternately, one solved together and one body by body, a third of a second each. External
/// load then affects both, and neither finds its own data in the caches.
FreeCopiesFigures measureFreeCopies(const FreeCopiesSettings& settings);

/// Prints one table.
void printTable(std::ostream& out, const std::vector<FreeCopiesFigures>& rows);

/// The results as JSON, one object per row.
nlohmann::json toJson(const std::vector<FreeCopiesFigures>& rows);

}  // namespace bullet_fem
