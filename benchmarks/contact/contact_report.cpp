// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/contact/contact_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmarks/figures.h"
#include "bullet_fem/btFemReports.h"

namespace bullet_fem
{
namespace
{

void printHeader(std::ostream& out, const ContactFigures& first)
{
    out << '\n' << first.m_scene << ", " << first.m_steps << " steps\n";
    print(out, "%-10s %6s  %-7s %6s  %9s %9s %9s %9s %9s  %6s %6s  %8s %9s %7s %8s", "", "tets", "method", "points",
          "median ms", "worst ms", "CPU ms", "free ms", "contact", "sweeps", "corr.", "closing", "deepest", "of",
          "at end");
    out << (first.m_free ? "   linear  angular" : "    creep") << "  x Bullet\n";
    print(out, "%-10s %6s  %-7s %6s  %9s %9s %9s %9s %9s  %6s %6s  %8s %9s %7s %8s", "", "", "", "", "", "", "", "",
          "ms", "", "it.", "m/s", "mm", "size", "mm");
    out << (first.m_free ? "    error    error" : "     mm/s") << '\n';
}

std::string countText(double mean)
{
    if (mean == 0) return "-";
    char text[16];
    std::snprintf(text, sizeof text, "%.1f", mean);
    return text;
}

void printRow(std::ostream& out, const ContactFigures& row)
{
    print(out, "%-10s %6d  %-7s %6d  %9.3f %9.3f %9.3f %9.3f %9.3f  %6s %6s  %8.1e %9.4f %7.0e %8.4f",
          row.m_variant.c_str(), row.m_tets, row.m_method.c_str(), row.m_contacts, row.m_medianMilliseconds,
          row.m_worstMilliseconds, row.m_cpuMilliseconds, row.m_freeMilliseconds, row.m_contactMilliseconds,
          countText(row.m_sweeps).c_str(), countText(row.m_correctiveIterations).c_str(), row.m_closingSpeed,
          1e3 * row.m_deepest, row.m_deepest / row.m_size, 1e3 * row.m_deepestAtEnd);
    if (row.m_free)
        print(out, "  %7.0e  %7.0e", row.m_linearError, row.m_angularError);
    else
        print(out, "  %7.2f", 1e3 * row.m_creep);
    if (row.m_timesFasterThanBullet > 0) print(out, "  %8.2f", row.m_timesFasterThanBullet);
    out << '\n';
}

/// Flags that affect the interpretation of a row.
std::string flagText(int flags)
{
    std::string text;
    if (flags & BT_FEM_NOT_CONVERGED) text += " not converged in a step;";
    if (flags & BT_FEM_BREAKDOWN) text += " a solve broke down;";
    if (flags & BT_FEM_CONTACT_LIMIT) text += " more contact points than the limit;";
    if (flags & BT_FEM_RESTORED) text += " a node was restored;";
    if (flags & BT_FEM_UNKNOWN_SHAPE) text += " a shape without contact;";
    return text;
}

/// JSON null for NaN.
nlohmann::json number(double value)
{
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

}  // namespace

void printTables(std::ostream& out, const std::vector<ContactFigures>& rows)
{
    std::string scene;
    for (const ContactFigures& row : rows)
    {
        if (row.m_scene != scene) printHeader(out, row);
        scene = row.m_scene;
        printRow(out, row);
        const std::string flags = flagText(row.m_flags);
        if (!flags.empty()) out << "           ^" << flags << '\n';
        if (!row.holds())
            print(out, "           ^ stopped in step %d: %s\n", row.m_failedStep,
                  std::isfinite(row.m_deepest) ? "overlap of half a cell" : "not finite");
        if (row.m_touchingSteps == 0) out << "           ^ no contact; times are of all steps\n";
    }
}

nlohmann::json toJson(const std::vector<ContactFigures>& rows)
{
    nlohmann::json results = nlohmann::json::array();
    for (const ContactFigures& row : rows)
    {
        nlohmann::json entry = {{"scene", row.m_scene},
                                {"variant", row.m_variant},
                                {"method", row.m_method},
                                {"tets", row.m_tets},
                                {"nodes", row.m_nodes},
                                {"steps", row.m_steps},
                                {"stopped_in_step", row.m_failedStep},
                                {"steps_in_contact", row.m_touchingSteps},
                                {"contacts", row.m_contacts},
                                {"ms_median", row.m_medianMilliseconds},
                                {"ms_worst", row.m_worstMilliseconds},
                                {"ms_cpu_median", row.m_cpuMilliseconds},
                                {"ms_free_median", row.m_freeMilliseconds},
                                {"ms_contact_median", row.m_contactMilliseconds},
                                {"sweeps_mean", row.m_sweeps},
                                {"corrective_iterations_mean", row.m_correctiveIterations},
                                {"closing_speed_worst_m_s", number(row.m_closingSpeed)},
                                {"size_m", row.m_size},
                                {"penetration_worst_m", number(row.m_deepest)},
                                {"penetration_at_end_m", number(row.m_deepestAtEnd)},
                                {"creep_m_s", number(row.m_creep)},
                                {"flags", row.m_flags}};
        entry["linear_momentum_error"] = row.m_free ? number(row.m_linearError) : nlohmann::json();
        entry["angular_momentum_error"] = row.m_free ? number(row.m_angularError) : nlohmann::json();
        entry["ratio_to_bullet"] =
            row.m_timesFasterThanBullet > 0 ? nlohmann::json(row.m_timesFasterThanBullet) : nlohmann::json();
        results.push_back(std::move(entry));
    }
    return results;
}

}  // namespace bullet_fem
