// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/scaling/scaling_report.h"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "benchmarks/figures.h"

namespace bullet_fem
{
namespace
{

constexpr int kSmallestFitted = 1536;  // elements

using Column = std::function<double(const ScalingFigures&)>;

/// With a = log n and b = log y: p = sum (a - mean a)(b - mean b) / sum (a - mean a)^2.
PowerLaw fit(const std::vector<ScalingFigures>& rows, const Column& column)
{
    double n = 0, a = 0, b = 0, aa = 0, ab = 0;
    for (const ScalingFigures& row : rows)
    {
        if (row.m_beam.m_tets < kSmallestFitted) continue;
        const double x = std::log(double(row.m_beam.m_tets)), y = std::log(column(row));
        n += 1, a += x, b += y, aa += x * x, ab += x * y;
    }
    PowerLaw law;
    law.m_points = static_cast<int>(n);
    const double spread = n * aa - a * a;
    if (spread > 1e-9 * n * aa) law.m_exponent = (n * ab - a * b) / spread;
    return law;
}

nlohmann::json orNull(const PowerLaw& law)
{
    return law.m_exponent != 0 && std::isfinite(law.m_exponent) ? nlohmann::json(law.m_exponent) : nlohmann::json();
}

}  // namespace

ScalingExponents fitExponents(const std::vector<ScalingFigures>& rows)
{
    return {fit(rows, [](const ScalingFigures& row) { return row.m_stages.m_order; }),
            fit(rows, [](const ScalingFigures& row) { return row.m_stages.m_tree + row.m_stages.m_numeric; }),
            fit(rows, [](const ScalingFigures& row) { return row.m_beam.m_setupSeconds; }),
            fit(rows, [](const ScalingFigures& row) { return row.m_beam.m_factorMegabytes; }),
            fit(rows, [](const ScalingFigures& row) { return row.m_beam.m_cpuMilliseconds; })};
}

void printTable(std::ostream& out, const std::vector<ScalingFigures>& rows)
{
    print(out, "%7s %7s  %8s %6s %8s %10s %9s  %6s %9s %7s  %5s  %9s %9s %9s %9s\n", "tets", "nodes", "setup ms",
          "order", "ms", "numeric ms", "factor MB", "fill", "all MB", "B/tet", "iter", "median ms", "CPU ms",
          "worst ms", "residual");
    for (const ScalingFigures& row : rows)
    {
        const BeamFigures& beam = row.m_beam;
        print(out, "%7d %7d  %8.1f %6s %8.1f %10.1f %9.2f  %6.1f %9.1f %7.0f  %5.1f  %9.3f %9.3f %9.3f %9.1e\n",
              beam.m_tets, beam.m_nodes, 1e3 * beam.m_setupSeconds, row.m_stages.m_ordering.c_str(),
              1e3 * row.m_stages.m_order, 1e3 * (row.m_stages.m_tree + row.m_stages.m_numeric), beam.m_factorMegabytes,
              row.m_stages.m_fill, beam.m_heapMegabytes, 1e6 * beam.m_heapMegabytes / beam.m_tets,
              beam.m_meanIterations, beam.m_medianMilliseconds, beam.m_cpuMilliseconds, beam.m_worstMilliseconds,
              beam.m_worstResidual);
    }
    const ScalingExponents p = fitExponents(rows);
    if (p.m_step.m_points < 2) return;
    print(out, "\nfitted n^p from %d sizes of %d elements and more: setup %.2f, order %.2f, numeric %.2f, ",
          p.m_step.m_points, kSmallestFitted, p.m_setup.m_exponent, p.m_order.m_exponent, p.m_numeric.m_exponent);
    print(out, "factor MB %.2f, step %.2f\n", p.m_factorMegabytes.m_exponent, p.m_step.m_exponent);
}

nlohmann::json toJson(const std::vector<ScalingFigures>& rows)
{
    nlohmann::json results = nlohmann::json::array();
    for (const ScalingFigures& row : rows)
        results.push_back({{"tets", row.m_beam.m_tets},
                           {"nodes", row.m_beam.m_nodes},
                           {"setup_ms", 1e3 * row.m_beam.m_setupSeconds},
                           {"assembly_ms", 1e3 * row.m_stages.m_assembly},
                           {"ordering", row.m_stages.m_ordering},
                           {"order_ms", 1e3 * row.m_stages.m_order},
                           {"tree_ms", 1e3 * row.m_stages.m_tree},
                           {"numeric_ms", 1e3 * row.m_stages.m_numeric},
                           {"fill", row.m_stages.m_fill},
                           {"factor_mb", row.m_beam.m_factorMegabytes},
                           {"memory_mb", row.m_beam.m_heapMegabytes},
                           {"iterations_mean", row.m_beam.m_meanIterations},
                           {"ms_cpu_median", row.m_beam.m_cpuMilliseconds},
                           {"ms_median", row.m_beam.m_medianMilliseconds},
                           {"ms_worst", row.m_beam.m_worstMilliseconds},
                           {"residual_worst", row.m_beam.m_worstResidual}});
    const ScalingExponents p = fitExponents(rows);
    return {{"results", results},
            {"exponents",
             {{"setup", orNull(p.m_setup)},
              {"order", orNull(p.m_order)},
              {"numeric", orNull(p.m_numeric)},
              {"factor_mb", orNull(p.m_factorMegabytes)},
              {"step", orNull(p.m_step)}}}};
}

}  // namespace bullet_fem
