// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

namespace bullet_fem
{

/// Copies of one cube that wobble in free fall, solved together and one by one.
struct FreeCopiesSettings
{
    int m_bodies = 16;          ///< >= 1
    int m_cells = 6;            ///< along every edge of 0.2 m, in [1, 40]; a body has five or six tets a cell
    double m_young = 1e6;       ///< E [Pa], > 0
    double m_tolerance = 1e-3;  ///< StepSettings::m_tolerance
    double m_stale = 1;         ///< step over the factor's, > 0: away from 1 a step needs more iterations
    int m_steps = 120;          ///< of 1/60 s, timed; >= 1
};

/// What they took: processor time of the calling thread for solveFreeMotion and finishStep.
struct FreeCopiesFigures
{
    FreeCopiesSettings m_settings;
    int m_tets = 0;                     ///< of a body
    double m_factorMegabytes = 0;       ///< [1e6 B]
    double m_iterations = 0;            ///< a body and step, mean
    double m_togetherMilliseconds = 0;  ///< of all bodies, median step [ms]
    double m_aloneMilliseconds = 0;     ///< likewise
    bool m_sameBits = false;            ///< positions and velocities after the last step

    double ratio() const { return m_aloneMilliseconds / m_togetherMilliseconds; }
};

/// Steps two sets of copies in turns, one solved together and one body by body, a third of a second each, so that a
/// disturbance of the machine meets both and neither finds the caches full of the other's numbers.
FreeCopiesFigures measureFreeCopies(const FreeCopiesSettings& settings);

/// One table.
void printTable(std::ostream& out, const std::vector<FreeCopiesFigures>& rows);

/// The same figures, one object a row.
nlohmann::json toJson(const std::vector<FreeCopiesFigures>& rows);

}  // namespace bullet_fem
