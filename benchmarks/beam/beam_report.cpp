// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/beam/beam_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "benchmarks/figures.h"

namespace bullet_fem
{
namespace
{

std::string toleranceText(const BeamFigures& row)
{
    char text[16] = "-";
    if (row.m_tolerance > 0) std::snprintf(text, sizeof text, "%.0e", row.m_tolerance);
    return text;
}

/// Prints the error columns.
void printErrors(std::ostream& out, const BeamFigures& row)
{
    if (row.m_sameModel)
        print(out, "  %9.1e  %8.4f%%  %6s", row.m_worstResidual, 100 * row.m_worstTipError,
              row.m_counts ? "yes" : "no");
    else
        print(out, "  %9s  %9s  %6s", "-", "-", "-");
}

void printTimes(std::ostream& out, const std::vector<BeamFigures>& rows)
{
    print(out, "%6s %7s  %-11s %6s  %9s %9s %9s  %6s  %9s  %9s  %6s  %8s %7s  %9s %9s\n", "tets", "E [Pa]", "method",
          "tol", "median ms", "CPU ms", "worst ms", "iter", "residual", "tip error", "counts", "setup ms", "MB",
          "x Bullet", "by CPU");
    for (const BeamFigures& row : rows)
    {
        print(out, "%6d %7.0e  %-11s %6s  %9.3f %9.3f %9.3f  %6.1f", row.m_tets, row.m_youngModulus,
              row.m_method.c_str(), toleranceText(row).c_str(), row.m_medianMilliseconds, row.m_cpuMilliseconds,
              row.m_worstMilliseconds, row.m_meanIterations);
        printErrors(out, row);
        print(out, "  %8.1f %7.1f", 1e3 * row.m_setupSeconds, row.m_heapMegabytes);
        if (row.m_timesFasterThanBullet > 0)
            print(out, "  %9.2f %9.2f", row.m_timesFasterThanBullet, row.m_cpuTimesFaster);
        out << '\n';
    }
}

void printTipRow(std::ostream& out, const BeamFigures& row, const char* method, const std::vector<double>& heights)
{
    print(out, "%6d %7.0e  %-11s %6s", row.m_tets, row.m_youngModulus, method, toleranceText(row).c_str());
    for (double height : heights) print(out, " %10.7f", height);
    out << '\n';
}

void printTips(std::ostream& out, const std::vector<BeamFigures>& rows, int steps, bool withVerified)
{
    print(out, "%6s %7s  %-11s %6s", "tets", "E [Pa]", "method", "tol");
    for (int step : listedSteps(steps)) print(out, " %6s %3d", "step", step);
    out << '\n';
    std::pair<int, double> lastCase;
    for (const BeamFigures& row : rows)
    {
        const std::pair<int, double> thisCase(row.m_tets, row.m_youngModulus);
        std::vector<double> verified = verifiedTipHeights(row.m_tets, row.m_youngModulus);
        if (withVerified && thisCase != lastCase && !verified.empty())
        {
            verified.resize(std::min(verified.size(), row.m_tipHeights.size()));
            BeamFigures header = row;
            header.m_tolerance = 0;
            printTipRow(out, header, "verified", verified);
        }
        lastCase = thisCase;
        printTipRow(out, row, row.m_method.c_str(), row.m_tipHeights);
    }
}

/// JSON null for runs of another model.
nlohmann::json orNull(double value, const BeamFigures& row)
{
    return row.m_sameModel && std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

}  // namespace

std::vector<int> listedSteps(int steps)
{
    std::vector<int> listed = {1, 11, 21, 31, 41, 51, 60};
    listed.erase(std::upper_bound(listed.begin(), listed.end(), steps), listed.end());
    return listed;
}

double tipError(double a, double b)
{
    const double smallest = 0.01;  // [m]: 0.1 % of it is the absolute tolerance of 1e-5 m for small heights
    return std::abs(a - b) / std::max(std::abs(b), smallest);
}

BeamFigures summarise(const BeamCase& beam, const BeamRun& run, const BeamRun& exact)
{
    BeamFigures row;
    row.m_tets = static_cast<int>(beam.m_tets.size());
    row.m_nodes = static_cast<int>(beam.m_positions.size());
    row.m_youngModulus = beam.m_material.m_youngModulus;
    row.m_mass = run.m_mass;
    row.m_method = run.m_method;
    row.m_tolerance = run.m_tolerance;
    row.m_setupSeconds = run.m_setupSeconds;
    row.m_cpuMilliseconds = 1e3 * median(run.m_cpuSeconds);
    row.m_medianMilliseconds = 1e3 * median(run.m_stepSeconds);
    row.m_worstMilliseconds = 1e3 * largest(run.m_stepSeconds);
    row.m_meanIterations = std::accumulate(run.m_iterations.begin(), run.m_iterations.end(), 0.0) / beam.m_steps;
    row.m_heapMegabytes = 1e-6 * static_cast<double>(run.m_heapBytes);
    row.m_factorMegabytes = 1e-6 * static_cast<double>(run.m_factorBytes);
    row.m_sameModel = run.m_sameModel;
    row.m_worstResidual = largest(run.m_residuals);
    std::vector<double> tipErrors;
    for (int step = 0; step < beam.m_steps; ++step)
        tipErrors.push_back(tipError(run.m_tipHeights[step], exact.m_tipHeights[step]));
    row.m_worstTipError = largest(tipErrors);
    row.m_counts =
        run.m_sameModel && row.m_worstResidual <= run.m_residualBound && row.m_worstTipError <= run.m_tipBound;
    for (int step : listedSteps(beam.m_steps)) row.m_tipHeights.push_back(run.m_tipHeights[step - 1]);
    return row;
}

std::vector<double> verifiedTipHeights(int tets, double youngModulus)
{
    static const std::map<std::pair<int, double>, std::vector<double>> verified = {
        {{1536, 1e6}, {-0.0027, -0.1933, -0.7881, -1.6197, -2.3372, -2.8412, -3.0598}},
        {{1536, 1e7}, {-0.0029, -0.2109, -0.4823, -0.5202, -0.3310, -0.1533, -0.1615}},
        {{12288, 1e6}, {-0.0027252, -0.1903987, -0.7817914, -1.6440172, -2.3943814, -2.9187233, -3.1367230}},
        {{12288, 1e7}, {-0.0028764, -0.2177664, -0.5308375, -0.6332297, -0.4684626, -0.2281448, -0.1462021}}};
    const auto found = verified.find({tets, youngModulus});
    return found == verified.end() ? std::vector<double>() : found->second;
}

void printTable(std::ostream& out, const std::vector<BeamFigures>& rows, int steps, bool withVerified)
{
    printTimes(out, rows);
    out << "\nTip height [m] after\n";
    printTips(out, rows, steps, withVerified);
}

nlohmann::json toJson(const std::vector<BeamFigures>& rows, int steps)
{
    const std::vector<int> listed = listedSteps(steps);
    nlohmann::json results = nlohmann::json::array();
    for (const BeamFigures& row : rows)
    {
        nlohmann::json tips = nlohmann::json::array();
        for (std::size_t k = 0; k < listed.size(); ++k)
            tips.push_back({{"step", listed[k]}, {"height_m", row.m_tipHeights[k]}});
        const nlohmann::json ratio =
            row.m_timesFasterThanBullet > 0 ? nlohmann::json(row.m_timesFasterThanBullet) : nullptr;
        results.push_back({{"tets", row.m_tets},
                           {"nodes", row.m_nodes},
                           {"free_mass_kg", row.m_mass},
                           {"young_modulus_pa", row.m_youngModulus},
                           {"method", row.m_method},
                           {"tolerance", row.m_tolerance},
                           {"ms_cpu_median", row.m_cpuMilliseconds},
                           {"ms_median", row.m_medianMilliseconds},
                           {"ms_worst", row.m_worstMilliseconds},
                           {"setup_s", row.m_setupSeconds},
                           {"memory_mb", row.m_heapMegabytes},
                           {"factor_mb", row.m_factorMegabytes},
                           {"same_model", row.m_sameModel},
                           {"iterations_mean", row.m_meanIterations},
                           {"residual_worst", orNull(row.m_worstResidual, row)},
                           {"tip_error_worst", orNull(row.m_worstTipError, row)},
                           {"counts", row.m_counts},
                           {"ratio_to_bullet", ratio},
                           {"ratio_to_bullet_cpu", row.m_cpuTimesFaster},
                           {"tip", tips}});
    }
    return results;
}

}  // namespace bullet_fem
