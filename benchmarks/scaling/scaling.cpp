// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The clamped beam in many sizes: set-up, memory and time per step, and their growth.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/beam/fem_beam.h"
#include "benchmarks/json_file.h"
#include "benchmarks/scaling/bake_times.h"
#include "benchmarks/scaling/scaling_report.h"
#include "bullet_fem/fem/common/threads.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
Nodal warp, tension term on. With --low-memory a second table lists the low-memory path at these sizes.
setup     time before the first step: mesh, A0, order, supernodes, numeric factorization, packing
order     the fill-reducing order with less fill; numeric: supernodes, factorization, packing (both timed separately)
factor    the packed factor in single precision, 1e6 bytes; fill: entries of the factor over those of A0's lower half
all MB    heap in use after the last step by model and body
CPU       median processor time of the stepping thread, to which the exponent is fitted
residual  largest true |b - A dv| / |b| over the steps
With --bake another table lists the time saved by baked bodies: set-up from positions and elements compared with reading
the file, mapped or copied, from the system's cache; medians of 9 runs.
)";

struct Options
{
    std::vector<int> m_tets = {192, 1536, 12288, 24000, 41472, 98304};
    double m_youngModulus = 1e6;
    int m_steps = 60;
    double m_tolerance = 1e-3;
    int m_threads = 1;
    bool m_large = false;
    bool m_lowMemory = false;
    bool m_bake = false;
    std::string m_jsonFile;
};

/// Settings shared by all sizes of a table.
struct Table
{
    const Options& m_options;
    const Threads& m_threads;
    FactorChoice m_choice;
};

BeamCase beamOf(int tets, const Options& options)
{
    Material material;
    material.m_youngModulus = options.m_youngModulus;
    material.m_stiffnessDamping = 0.01;
    return makeBeamCase(beamCells(tets), material);
}

ScalingFigures runSize(int tets, const Table& table)
{
    const Options& options = table.m_options;
    std::cerr << tets << " tets" << (table.m_choice == FactorChoice::lowMemory ? ", low memory" : "") << " ..."
              << std::endl;
    BeamCase beam = beamOf(tets, options);
    beam.m_steps = options.m_steps;
    ScalingFigures row;
    row.m_stages = measureSetup(*makeBeamModel(beam, table.m_choice));
    StepSettings settings;
    settings.m_tolerance = options.m_tolerance;
    settings.m_threads = &table.m_threads;
    const BeamRun run = runFem(beam, settings, table.m_choice);
    row.m_beam = summarise(beam, run, run);
    return row;
}

std::vector<ScalingFigures> runSizes(const Table& table)
{
    std::vector<ScalingFigures> rows;
    for (int tets : table.m_options.m_tets) rows.push_back(runSize(tets, table));
    return rows;
}

std::vector<BakeTimes> bakeSizes(const Options& options)
{
    std::vector<BakeTimes> rows;
    for (int tets : options.m_tets)
    {
        std::cerr << tets << " tets, baked ..." << std::endl;
        rows.push_back(measureBake(beamOf(tets, options)));
    }
    return rows;
}

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--tets", options.m_tets, "mesh sizes, each 24 n^3 with n in [1, 32] cells per metre")
        ->delimiter(',')
        ->capture_default_str();
    app.add_flag("--large", options.m_large, "also 192,000 tets: about a minute and a gigabyte more");
    app.add_option("--young", options.m_youngModulus, "Young's modulus [Pa], in (0, 1e13]")->capture_default_str();
    app.add_option("--steps", options.m_steps, "steps of 1/60 s")->check(CLI::Range(1, 100000))->capture_default_str();
    app.add_option("--tolerance", options.m_tolerance, "relative residual at which the solve stops")
        ->check(CLI::Range(1e-8, 0.5))
        ->capture_default_str();
    app.add_option("--threads", options.m_threads, "threads that share a step; 0: all of the machine")
        ->check(CLI::Range(0, Threads::kMax))
        ->capture_default_str();
    app.add_flag("--low-memory", options.m_lowMemory, "also run the low-memory path");
    app.add_flag("--bake", options.m_bake, "also measure the time saved by baked bodies");
    app.add_option("--json", options.m_jsonFile, "write the results to this file");
    app.footer(
        "Example, a quick look: bulletfem_bench_scaling --tets 192,1536,12288 --steps 20\n"
        "Exit code 0 if all ran, another if an option is wrong or a file cannot be written.");
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Times set-up and steps of the clamped beam over its number of elements", "bulletfem_bench_scaling");
    addOptions(app, options);
    CLI11_PARSE(app, argc, argv);
    if (options.m_large) options.m_tets.push_back(192000);

    const auto run = [&]
    {
        JsonFile json(options.m_jsonFile);
        const Threads threads(options.m_threads);
        const MachineInfo machine = readMachineInfo(threads.count());
        for (int tets : options.m_tets) beamCells(tets);  // reports an invalid size before the others run
        const std::vector<ScalingFigures> rows = runSizes({options, threads, FactorChoice::full});
        std::vector<ScalingFigures> lowMemory;
        if (options.m_lowMemory) lowMemory = runSizes({options, threads, FactorChoice::lowMemory});
        std::vector<BakeTimes> baked;
        if (options.m_bake) baked = bakeSizes(options);
        std::cout << toText(machine) << "\nClamped beam 4 x 1 x 1 m, E " << options.m_youngModulus
                  << " Pa, nu .3, rho 1000 kg/m3, beta .01 s, h 1/60 s, " << options.m_steps
                  << " steps from rest, tolerance " << options.m_tolerance << "\n\n";
        printTable(std::cout, rows);
        if (options.m_lowMemory)
        {
            std::cout << "\nLow-memory path:\n\n";
            printTable(std::cout, lowMemory);
        }
        if (options.m_bake)
        {
            std::cout << "\nBaked:\n\n";
            printTable(std::cout, baked);
        }
        std::cout << g_legend;
        nlohmann::json document = toJson(rows);
        document["young_modulus_pa"] = options.m_youngModulus;
        document["steps"] = options.m_steps;
        document["tolerance"] = options.m_tolerance;
        if (options.m_lowMemory) document["low_memory"] = toJson(lowMemory);
        if (options.m_bake) document["baked"] = toJson(baked);
        json.write(machine, std::move(document));
        return 0;
    };
    return runProgram("bulletfem_bench_scaling", run);
}
