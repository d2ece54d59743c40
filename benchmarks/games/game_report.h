// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace bullet_fem
{

/// Cost and result of one scene with one way of stepping.
struct GameRow
{
    std::string m_scene, m_coupling;
    std::string m_outcome;  ///< the result as a sentence; may be empty
    int m_tets = 0;
    bool m_isOfBullet = false;  ///< run by Bullet alone: there are only times of whole frames
    // times [ms] (medians), counts (means or medians), speeds [m/s] and depths [m]
    double m_median = 0, m_late = 0, m_worst = 0, m_free = 0, m_contact = 0, m_points = 0;
    double m_sweeps = 0, m_iterations = 0, m_closing = 0, m_deepest = 0,
           m_force = -1;  // [-]; below 0: no reference value is known
    int m_asleep = 0;
};

void printTable(std::ostream& out, const std::vector<GameRow>& rows);
nlohmann::json toJson(const std::vector<GameRow>& rows);

}  // namespace bullet_fem
