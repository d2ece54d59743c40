// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Dynamic clamped beam: BulletFEM's step compared with Bullet's deformable world, each time listed with its error.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/beam/beam_methods.h"
#include "benchmarks/json_file.h"
#include "bullet_fem/fem/common/threads.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
Times cover the step alone; Bullet's methods run on one thread, BulletFEM on the number of threads above.
residual     largest true |b - A dv| / |b| over the steps
tip error    largest over the steps, relative to BulletFEM's solution at 1e-8; for Bullet, relative to that solution
             without the tension term, which Bullet lacks (and it linearises at x + h v, not at x)
counts       residual within the tolerance (1e-3 if none is set) and tip error within 0.1 % (or 1e-5 m;
             0.6 % for Bullet)
setup        time before the first step; for BulletFEM: mesh, order, factor, packing
MB           heap in use after the last step by model, body and (Bullet's) world, 1e6 bytes
CPU          median processor time of the stepping thread in a step, nearly independent of other programs; on an idle
             machine it equals the wall time, on a busy one it is the better measure
x Bullet     median of Bullet's deformable world over that of the row; by CPU: ratio of the processor times
mass-spring  Bullet's plain soft body on the same mesh: another model, whose stiffness depends on step and iterations;
             only its times are comparable
)";

const char* const g_curveLegend = R"(
Error against time. Tip errors of each scheme are relative to its own solution at a tighter tolerance than all listed:
1e-10 for BulletFEM; for Bullet 1e-12 of its own measure, r^T M^-1 r / min(1, b^T M^-1 b), in single precision.
)";

struct Options
{
    std::vector<int> m_tets = {1536, 12288};
    std::vector<double> m_youngModuli = {1e6, 1e7};
    int m_steps = 60;
    bool m_curve = false;
    bool m_noBullet = false;
    bool m_reference = false;
    int m_springIterations = 20;
    int m_threads = 1;
    std::string m_jsonFile;
};

BeamCase makeCase(int tets, double youngModulus, int steps)
{
    Material material;
    material.m_youngModulus = youngModulus;
    material.m_poissonRatio = 0.3;
    material.m_density = 1000;
    material.m_stiffnessDamping = 0.01;
    BeamCase beam = makeBeamCase(beamCells(tets), material);
    beam.m_steps = steps;
    return beam;
}

std::vector<BeamFigures> runAll(const Options& options, const Threads& threads)
{
    BeamMethods methods;
    methods.m_withBullet = !options.m_noBullet;
    methods.m_tension = !options.m_reference;
    methods.m_springIterations = options.m_springIterations;
    methods.m_threads = &threads;
    std::vector<BeamFigures> rows;
    for (int tets : options.m_tets)
        for (double youngModulus : options.m_youngModuli)
        {
            const BeamCase beam = makeCase(tets, youngModulus, options.m_steps);
            std::cerr << tets << " tets, E = " << youngModulus << " Pa ..." << std::endl;
            for (BeamFigures& row : options.m_curve ? traceErrorCurve(beam, methods) : compareMethods(beam, methods))
                rows.push_back(std::move(row));
        }
    return rows;
}

void printReport(const MachineInfo& machine, const std::vector<BeamFigures>& rows, const Options& options)
{
    std::cout << toText(machine) << "\nClamped beam 4 x 1 x 1 m, nu .3, rho 1000 kg/m3, beta .01 s, h 1/60 s, "
              << options.m_steps << " steps from rest, tension term " << (options.m_reference ? "off" : "on") << "\n\n";
    printTable(std::cout, rows, options.m_steps, options.m_reference);
    std::cout << g_legend;
    if (options.m_curve) std::cout << g_curveLegend;
}

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--tets", options.m_tets, "mesh sizes, each 24 n^3 with n in [1, 32] cells per metre")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--young", options.m_youngModuli, "Young's moduli [Pa]")->delimiter(',')->capture_default_str();
    app.add_option("--steps", options.m_steps, "steps of 1/60 s")->check(CLI::Range(1, 100000))->capture_default_str();
    app.add_flag("--curve", options.m_curve, "error against time: BulletFEM and Bullet at many tolerances");
    app.add_flag("--no-bullet", options.m_noBullet, "leave Bullet's deformable world and mass-spring solver out");
    app.add_option("--spring-iterations", options.m_springIterations, "position iterations of the mass-spring solver")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_flag("--reference", options.m_reference, "tension term off, compared with the verified tip heights");
    app.add_option("--threads", options.m_threads, "threads of BulletFEM's steps; 0: all of the machine")
        ->check(CLI::Range(0, Threads::kMax))
        ->capture_default_str();
    app.add_option("--json", options.m_jsonFile, "write the results to this file");
    app.footer(
        "Example, the table of docs/performance.md:\n  bulletfem_bench_beam --json beam.json\n"
        "Exit code 0 if all ran, another if an option is wrong or a file cannot be written.");
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Times the dynamic clamped beam: BulletFEM and Bullet's own deformable world", "bulletfem_bench_beam");
    addOptions(app, options);
    CLI11_PARSE(app, argc, argv);

    const auto run = [&]
    {
        JsonFile json(options.m_jsonFile);
        const Threads threads(options.m_threads);
        const MachineInfo machine = readMachineInfo(threads.count());
        const std::vector<BeamFigures> rows = runAll(options, threads);
        printReport(machine, rows, options);
        json.write(machine, {{"steps", options.m_steps},
                             {"curve", options.m_curve},
                             {"tension_term", !options.m_reference},
                             {"results", toJson(rows, options.m_steps)}});
        return 0;
    };
    return runProgram("bulletfem_bench_beam", run);
}
