// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Times each kernel of a step on its own, compared with the limits of the machine's memory and arithmetic.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/json_file.h"
#include "benchmarks/kernels/kernel_report.h"
#include "benchmarks/kernels/machine_limits.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
One thread; the clamped beam after half a second under its own weight at E = 1e6 Pa; the kernels run in turns, five
times. Rates and ratios are those of the best repetition, which other programs disturb least.
element pass    F, rotation, tensile part, force and contribution to A of all elements
preparation     element pass, sums over nodes and rotations of the nodes: all work before the first iteration
product A p     of all elements, with the sums over nodes
preconditioner  P r: rotations, one solve pair, rotations
solve pair      forward and backward solve with the packed factor; GB/s counts the factor twice
GB/s            minimum memory traffic, in or out of the caches
GFLOP/s         product: 180 per tet; solves: from the factor's entries; factorization: Cholesky's, in double precision
pair / 2 reads  one solve pair over two reads of a buffer of the packed factor's size, alternately, median: as in a
                step, neither finds its own data in the caches
of the best     ratio of the best times when each is repeated on its own; a buffer larger than the caches may then stay
                in them in part
16 / 1          16 right-hand sides together over one
factors         order and symbolic factorization, numeric factorization (BulletFEM: in double precision, packed in
                single), forward and backward solve of one and of 16 right-hand sides (BulletFEM: single precision;
                others: double, with their copies in and out), entries of L over those of A0, memory, |b - A x| / |b|;
                medians
set-up          from positions and elements to the end of the first step: mesh and rest shape, factor, body and step
fill            entries of L over those of A0's lower half, before supernodes are merged
compliance      columns of A0^-1 of 64 neighbouring surface nodes, and the 64 x 64 blocks between them, rotated
)";

struct Options
{
    std::vector<int> m_tets = {1536, 12288, 41472};
    bool m_large = false;
    std::vector<int> m_touch;
    std::vector<int> m_factors;
    bool m_fill = false;
    double m_seconds = 0.5;
    std::string m_jsonFile;
};

double measurePeak(double seconds)
{
    const int rounds = 100000;
    float sink = 0;
    const Timing time = timeInTurns({{"peak", [&] { sink += multiplyAdd(rounds); }, nullptr}}, seconds).front();
    return sink > 0 ? 1e-9 * multiplyAddOperations(rounds) / time.m_best : 0;
}

constexpr int kFirstSteps = 5;  // repetitions: allocations in set-up make the first one slower

/// A beam and a cube of about each number of elements.
std::vector<FactorCase> factorCases(const std::vector<int>& sizes)
{
    std::vector<FactorCase> cases;
    const auto cellsOf = [](double tets) { return std::max(1, static_cast<int>(std::lround(std::cbrt(tets)))); };
    for (int tets : sizes) cases.push_back(beamCase(cellsOf(tets / 24.0)));
    for (int tets : sizes) cases.push_back(cubeCase(cellsOf(tets / 6.0)));
    return cases;
}

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--tets", options.m_tets, "mesh sizes, each 24 n^3 with n in [1, 32] cells per metre")
        ->delimiter(',')
        ->capture_default_str();
    app.add_flag("--large", options.m_large, "also 98,304 tets: a factor far larger than the caches");
    app.add_option("--touch", options.m_touch,
                   "approximate sizes of blocks for the compliance of 64 nodes on both paths")
        ->delimiter(',')
        ->check(CLI::Range(40, 500000));
    app.add_option("--factors", options.m_factors,
                   "approximate sizes of beams and free cubes; times their factors and those of CHOLMOD and Eigen")
        ->delimiter(',')
        ->check(CLI::Range(6, 200000));
    app.add_flag("--fill", options.m_fill, "the fill of AMD, METIS and Eigen in thirty meshes");
    app.add_option("--seconds", options.m_seconds, "time for each kernel and size [s]")
        ->check(CLI::Range(1e-3, 60.0))
        ->capture_default_str();
    app.add_option("--json", options.m_jsonFile, "write the results to this file");
    app.footer(
        "Example, a quick look: bulletfem_bench_kernels --tets 1536 --seconds 0.1\n"
        "Exit code 0 if all ran, another if an option is wrong or a file cannot be written.");
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Times the kernels of a step, compared with limits of memory and arithmetic",
                 "bulletfem_bench_kernels");
    addOptions(app, options);
    CLI11_PARSE(app, argc, argv);
    if (options.m_large) options.m_tets.push_back(98304);

    const auto run = [&]
    {
        JsonFile json(options.m_jsonFile);
        MachineInfo machine = readMachineInfo(1);
        machine.emplace_back("vectors", vectorTarget());
        machine.emplace_back("factors", factorLibraries());
        KernelReport report;
        report.m_peakGigaflops = measurePeak(options.m_seconds);
        for (int tets : options.m_tets)
        {
            std::cerr << tets << " tets ..." << std::endl;
            report.m_runs.push_back(measureKernels(tets, options.m_seconds));
        }
        std::cerr << "compliance ..." << std::endl;
        report.m_compliance = measureCompliance(kComplianceTets, FactorChoice::full, options.m_seconds);
        for (int tets : options.m_touch)
            for (const FactorChoice choice : {FactorChoice::full, FactorChoice::lowMemory})
                report.m_touch.push_back(measureCompliance(tets, choice, options.m_seconds));
        for (const FactorCase& factorCase : factorCases(options.m_factors))
        {
            std::cerr << "factors of " << factorCase.m_name << " ..." << std::endl;
            const std::vector<FactorRow> rows = measureFactors(factorCase, options.m_seconds);
            report.m_factors.insert(report.m_factors.end(), rows.begin(), rows.end());
            report.m_firstSteps.push_back(measureFirstStep(factorCase, kFirstSteps));
        }
        if (options.m_fill)
            for (const FactorCaseMaker& make : thirtyFactorCases()) report.m_fill.push_back(measureFill(make()));
        std::cout << toText(machine) << '\n';
        printTables(std::cout, report);
        std::cout << g_legend;
        json.write(machine, toJson(report));
        return 0;
    };
    return runProgram("bulletfem_bench_kernels", run);
}
