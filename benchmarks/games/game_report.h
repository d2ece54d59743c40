// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace bullet_fem
{

/// What a scene cost in one way of stepping, and what came of it.
struct GameRow
{
    std::string m_scene, m_coupling;
    std::string m_outcome;  ///< a sentence; may be empty
    int m_tets = 0;
    bool m_isOfBullet = false;  ///< it has no reports: times of whole frames alone
    // [ms], and means or medians of counts; speeds [m/s] and depths [m]
    double m_median = 0, m_late = 0, m_worst = 0, m_free = 0, m_contact = 0, m_points = 0;
    double m_sweeps = 0, m_iterations = 0, m_closing = 0, m_deepest = 0,
           m_force = -1;  // [-]; below 0: there is no law for it
    int m_asleep = 0;
};

void printTable(std::ostream& out, const std::vector<GameRow>& rows);
nlohmann::json toJson(const std::vector<GameRow>& rows);

}  // namespace bullet_fem
