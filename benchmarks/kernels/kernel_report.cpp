// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/kernels/kernel_report.h"

#include <nlohmann/json.hpp>

#include "benchmarks/figures.h"

namespace bullet_fem
{
namespace
{

std::string figureText(double value)
{
    char text[24] = "-";
    if (value > 0) std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

void printKernels(std::ostream& out, const std::vector<KernelRun>& runs)
{
    print(out, "%7s  %-17s %11s %11s %9s %8s %9s\n", "tets", "kernel", "best us", "median us", "ns/tet", "GB/s",
          "GFLOP/s");
    for (const KernelRun& run : runs)
        for (const KernelFigures& row : run.m_kernels)
            print(out, "%7d  %-17s %11.1f %11.1f %9.1f %8s %9s\n", row.m_tets, row.m_kernel.c_str(),
                  1e6 * row.m_time.m_best, 1e6 * row.m_time.m_median, row.nanosecondsPerTet(),
                  figureText(row.gigabytesPerSecond()).c_str(), figureText(row.gigaflops()).c_str());
}

void printSolves(std::ostream& out, const std::vector<KernelRun>& runs)
{
    print(out, "%7s  %10s %10s  %15s  %12s  %9s\n", "tets", "factor MB", "read GB/s", "pair / 2 reads", "of the best",
          "16 / 1");
    for (const KernelRun& run : runs)
        print(out, "%7d  %10.2f %10.1f  %15.2f  %12.2f  %9.2f\n", run.m_solves.m_tets, run.m_solves.m_factorMegabytes,
              run.m_solves.m_readGigabytes, run.m_solves.m_solveOverTwoReads, run.m_solves.m_solveOverBestReads,
              run.m_solves.m_lanesOverOne);
}

const char* pathName(const ComplianceFigures& figures)
{
    return figures.m_path == FactorPath::full ? "full" : "low memory";
}

}  // namespace

void printTables(std::ostream& out, const KernelReport& report)
{
    print(out, "peak of one thread, measured: %.0f GFLOP/s in single precision\n\n", report.m_peakGigaflops);
    printKernels(out, report.m_runs);
    out << '\n';
    printSolves(out, report.m_runs);
    const ComplianceFigures& c = report.m_compliance;
    print(out, "\ncompliance of %d nodes on a block of %d tets: first request %.3f ms, repeated %.3f ms (best)\n",
          c.m_touched, c.m_tets, 1e3 * c.m_fresh.m_best, 1e3 * c.m_known.m_best);
    for (const ComplianceFigures& t : report.m_touch)
        print(
            out,
            "%7d tets, %-10s factor %7.2f MB, A0 %6.2f MB: %d nodes, first request %8.2f ms, repeated %.3f ms (best)\n",
            t.m_tets, pathName(t), t.m_factorMegabytes, t.m_matrixMegabytes, t.m_touched, 1e3 * t.m_fresh.m_best,
            1e3 * t.m_known.m_best);
    if (!report.m_factors.empty()) printTable(out << '\n', report.m_factors);
    if (!report.m_firstSteps.empty()) printTable(out << '\n', report.m_firstSteps);
    if (!report.m_fill.empty()) printTable(out << '\n', report.m_fill);
}

nlohmann::json toJson(const KernelReport& report)
{
    nlohmann::json kernels = nlohmann::json::array(), solves = nlohmann::json::array();
    for (const KernelRun& run : report.m_runs)
    {
        for (const KernelFigures& row : run.m_kernels)
            kernels.push_back({{"tets", row.m_tets},
                               {"kernel", row.m_kernel},
                               {"us_best", 1e6 * row.m_time.m_best},
                               {"us_median", 1e6 * row.m_time.m_median},
                               {"repetitions", row.m_time.m_count},
                               {"ns_per_tet", row.nanosecondsPerTet()},
                               {"gb_per_s", row.gigabytesPerSecond()},
                               {"gflop_per_s", row.gigaflops()}});
        solves.push_back({{"tets", run.m_solves.m_tets},
                          {"factor_mb", run.m_solves.m_factorMegabytes},
                          {"read_gb_per_s", run.m_solves.m_readGigabytes},
                          {"pair_over_two_reads", run.m_solves.m_solveOverTwoReads},
                          {"pair_over_best_reads", run.m_solves.m_solveOverBestReads},
                          {"sixteen_over_one", run.m_solves.m_lanesOverOne}});
    }
    nlohmann::json touch = nlohmann::json::array();
    for (const ComplianceFigures& t : report.m_touch)
        touch.push_back({{"tets", t.m_tets},
                         {"path", pathName(t)},
                         {"touched", t.m_touched},
                         {"factor_mb", t.m_factorMegabytes},
                         {"matrix_mb", t.m_matrixMegabytes},
                         {"ms_new_best", 1e3 * t.m_fresh.m_best},
                         {"ms_known_best", 1e3 * t.m_known.m_best}});
    const ComplianceFigures& c = report.m_compliance;
    return {{"peak_gflop_per_s", report.m_peakGigaflops},
            {"kernels", kernels},
            {"solves", solves},
            {"touch", touch},
            {"factors", toJson(report.m_factors)},
            {"first_steps", toJson(report.m_firstSteps)},
            {"fill", toJson(report.m_fill)},
            {"compliance",
             {{"tets", c.m_tets},
              {"nodes", c.m_nodes},
              {"touched", c.m_touched},
              {"ms_new_best", 1e3 * c.m_fresh.m_best},
              {"ms_new_median", 1e3 * c.m_fresh.m_median},
              {"ms_known_best", 1e3 * c.m_known.m_best},
              {"ms_known_median", 1e3 * c.m_known.m_median}}}};
}

}  // namespace bullet_fem
