// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The dynamic clamped beam: our step beside that of Bullet's own deformable world, each time with its error.
#include <CLI/CLI.hpp>
#include <exception>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/beam_report.h"
#include "benchmarks/bullet_deformable_beam.h"
#include "benchmarks/fem_beam.h"
#include "benchmarks/machine_info.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
Times are of the step alone, on one thread.
residual   largest true |b - A dv| / |b| of all steps
tip error  largest of all steps, against our own solution at 1e-8; Bullet's against that without the tension term, which
           it has not (and it linearises at x + h v, not at x)
counts     residual within the tolerance (1e-3 where none is set) and tip error within 0.1 % (or 1e-5 m;
           0.6 % for Bullet)
x Bullet   Bullet's median over this one's
)";

struct Options
{
    std::vector<int> m_tets = {1536, 12288};
    std::vector<double> m_youngModuli = {1e6, 1e7};
    int m_steps = 60;
    bool m_noBullet = false;
    bool m_reference = false;
    std::string m_jsonFile;
};

/// The n with 24 n^3 = tets. Throws std::invalid_argument if there is none.
int cellsPerMetre(int tets)
{
    for (int n = 1; n <= 32; ++n)
        if (24 * n * n * n == tets) return n;
    throw std::invalid_argument("--tets is " + std::to_string(tets) +
                                ", must be 24 n^3 with n in [1, 32] cells per metre; try 192, 1536, 12288 or 98304");
}

/// Adds Bullet's row, and to the others how much faster they were. Bullet has no tension term, so its tips are measured
/// against our solution without it.
void compareWithBullet(const BeamCase& beam, std::vector<BeamFigures>& rows)
{
    StepSettings settings;
    settings.m_tension = false;
    settings.m_tolerance = 1e-8;
    rows.push_back(summarise(beam, runBulletDeformable(beam), runFem(beam, settings)));
    const double bullet = rows.back().m_medianMilliseconds;
    for (BeamFigures& row : rows) row.m_timesFasterThanBullet = bullet / row.m_medianMilliseconds;
}

/// All methods on one beam, one after the other.
std::vector<BeamFigures> runCase(const BeamCase& beam, const Options& options)
{
    std::cerr << beam.m_tets.size() << " tets, E = " << beam.m_material.m_youngModulus << " Pa ..." << std::endl;

    StepSettings settings;
    settings.m_tension = !options.m_reference;
    settings.m_tolerance = 1e-8;
    const BeamRun exact = runFem(beam, settings);

    std::vector<BeamFigures> rows;
    for (double tolerance : {1e-3, 1e-6})
        for (Warp warp : {Warp::nodal, Warp::global})
        {
            settings.m_tolerance = tolerance;
            settings.m_warp = warp;
            rows.push_back(summarise(beam, runFem(beam, settings), exact));
        }
    rows.push_back(summarise(beam, exact, exact));
    settings.m_warp = Warp::nodal;
    settings.m_tolerance = 1e-3;
    settings.m_direct = true;
    rows.push_back(summarise(beam, runFem(beam, settings), exact));

    if (!options.m_noBullet) compareWithBullet(beam, rows);
    return rows;
}

std::vector<BeamFigures> runAll(const Options& options)
{
    std::vector<BeamFigures> rows;
    for (int tets : options.m_tets)
        for (double youngModulus : options.m_youngModuli)
        {
            Material material;
            material.m_youngModulus = youngModulus;
            material.m_poissonRatio = 0.3;
            material.m_density = 1000;
            material.m_stiffnessDamping = 0.01;
            BeamCase beam = makeBeamCase(cellsPerMetre(tets), material);
            beam.m_steps = options.m_steps;
            for (BeamFigures& row : runCase(beam, options)) rows.push_back(std::move(row));
        }
    return rows;
}

void printReport(const MachineInfo& machine, const std::vector<BeamFigures>& rows, const Options& options)
{
    std::cout << toText(machine) << "\nClamped beam 4 x 1 x 1 m, nu .3, rho 1000 kg/m3, beta .01 s, h 1/60 s, "
              << options.m_steps << " steps from rest, tension term " << (options.m_reference ? "off" : "on") << "\n\n";
    printTable(std::cout, rows, options.m_steps, options.m_reference);
    std::cout << g_legend;
}

void writeJson(std::ofstream& file, const MachineInfo& machine, const std::vector<BeamFigures>& rows,
               const Options& options)
{
    nlohmann::json document;
    for (const auto& field : machine) document["machine"][field.first] = field.second;
    document["steps"] = options.m_steps;
    document["tension_term"] = !options.m_reference;
    document["results"] = toJson(rows, options.m_steps);
    file << document.dump(2) << '\n';
    if (!file.flush()) throw std::runtime_error("cannot write to " + options.m_jsonFile);
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Times the dynamic clamped beam: BulletFEM beside Bullet's own deformable world",
                 "bulletfem_bench_beam");
    app.add_option("--tets", options.m_tets, "mesh sizes, each 24 n^3 with n cells per metre")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--young", options.m_youngModuli, "Young's moduli [Pa]")->delimiter(',')->capture_default_str();
    app.add_option("--steps", options.m_steps, "steps of 1/60 s")->check(CLI::Range(1, 100000))->capture_default_str();
    app.add_flag("--no-bullet", options.m_noBullet, "leave Bullet's deformable world out");
    app.add_flag("--reference", options.m_reference,
                 "tension term off, beside the digits the project verifies itself with");
    app.add_option("--json", options.m_jsonFile, "write the same figures to this file");
    CLI11_PARSE(app, argc, argv);

    try
    {
        std::ofstream json;
        if (!options.m_jsonFile.empty())
        {
            json.open(options.m_jsonFile);
            if (!json)
                throw std::runtime_error("cannot open " + options.m_jsonFile + " for writing: choose another --json");
        }
        const MachineInfo machine = readMachineInfo(1);
        const std::vector<BeamFigures> rows = runAll(options);
        printReport(machine, rows, options);
        if (json.is_open()) writeJson(json, machine, rows, options);
    }
    catch (const std::exception& error)
    {
        std::cerr << "bulletfem_bench_beam: " << error.what() << std::endl;
        return 1;
    }
    return 0;
}
