// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/games/game_report.h"

#include "benchmarks/figures.h"

namespace bullet_fem
{

void printTable(std::ostream& out, const std::vector<GameRow>& rows)
{
    print(out, "\n%-16s %-8s %6s %8s %8s %8s %7s %8s %7s %7s %6s %9s %9s %8s\n", "scene", "coupling", "tets", "median",
          "95 %", "worst", "free", "contact", "points", "sweeps", "c.it.", "closing", "deepest", "force");
    print(out, "%-16s %-8s %6s %8s %8s %8s %7s %8s %7s %7s %6s %9s %9s %8s\n", "", "", "", "[ms]", "[ms]", "[ms]",
          "[ms]", "[ms]", "", "", "", "[mm/s]", "[mm]", "[-]");
    for (const GameRow& r : rows)
    {
        if (r.m_isOfBullet)
        {
            print(out, "%-16s %-8s %6d %8.2f %8.2f %8.2f %7s %8s %7s %7s %6s %9s %9s %8s\n", r.m_scene.c_str(),
                  r.m_coupling.c_str(), r.m_tets, r.m_median, r.m_late, r.m_worst, "-", "-", "-", "-", "-", "-", "-",
                  "-");
            continue;
        }
        print(out, "%-16s %-8s %6d %8.2f %8.2f %8.2f %7.2f %8.2f %7.0f %7.0f %6.0f %9.3f %9.3f ", r.m_scene.c_str(),
              r.m_coupling.c_str(), r.m_tets, r.m_median, r.m_late, r.m_worst, r.m_free, r.m_contact, r.m_points,
              r.m_sweeps, r.m_iterations, 1e3 * r.m_closing, 1e3 * r.m_deepest);
        if (r.m_force >= 0)
            print(out, "%8.1e\n", r.m_force);
        else
            print(out, "%8s\n", "-");
    }
    for (const GameRow& r : rows)
        if (!r.m_outcome.empty()) out << r.m_scene << ", " << r.m_coupling << ": " << r.m_outcome << '\n';
}

nlohmann::json toJson(const std::vector<GameRow>& rows)
{
    nlohmann::json all = nlohmann::json::array();
    for (const GameRow& r : rows)
        all.push_back({{"scene", r.m_scene},
                       {"coupling", r.m_coupling},
                       {"tets", r.m_tets},
                       {"median_ms", r.m_median},
                       {"percentile95_ms", r.m_late},
                       {"worst_ms", r.m_worst},
                       {"free_ms", r.m_free},
                       {"contact_ms", r.m_contact},
                       {"points", r.m_points},
                       {"sweeps", r.m_sweeps},
                       {"corrective", r.m_iterations},
                       {"closing", r.m_closing},
                       {"deepest", r.m_deepest},
                       {"force_error", r.m_force},
                       {"outcome", r.m_outcome}});
    return all;
}

}  // namespace bullet_fem
