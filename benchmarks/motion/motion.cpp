// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Motion of bodies at different step sizes, and cost of a step: implicit Euler and the second-order step.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/json_file.h"
#include "benchmarks/motion/motion_figures.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
Euler         btFemSolverInfo::m_numericalDamping and m_contactDamping = 1; second order: 0; rigid: Bullet's sphere;
              default: the settings of btFemSolverInfo, m_elasticRebound among them, which the others do without
tip           clamped beam of 4 x 1 x 1 m, 1,536 tets, E 1e7, undamped, falling from rest; compared 30 times per second
swing         a beam of 192 tets with a first frequency of 1.7 Hz; half-life from the energy loss in ten seconds
drop, roll    balls of .25 m radius, E 1e6; dropped balls are undamped, rolling ones have beta .005 s and friction .8
reference     second order at the step of --reference; theory for the swing and for rigid spheres
CPU           median processor time of a step: of the beam alone, of stepSimulation for the balls
)";

struct Options
{
    std::vector<std::string> m_cases = {"tip", "swing", "drop", "rebound", "roll10", "roll20"};
    std::vector<int> m_rates = {30, 60, 120, 240, 480, 960};
    int m_reference = 1920;
    int m_cells = 8;
    std::string m_jsonFile;
};

const CLI::Validator g_multiple(
    [](std::string& text)
    {
        const int value = std::atoi(text.c_str());
        const bool good = value >= 30 && value <= 7680 && value % 30 == 0;
        return good ? std::string() : "steps a second are " + text + ", must be a multiple of 30 in [30, 7680]";
    },
    "multiple of 30");

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--cases", options.m_cases, "a selection of tip, swing, drop, rebound, roll10, roll20")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--rates", options.m_rates, "steps per second")
        ->delimiter(',')
        ->check(g_multiple)
        ->capture_default_str();
    app.add_option("--reference", options.m_reference, "steps per second of the reference")
        ->check(g_multiple)
        ->capture_default_str();
    app.add_option("--cells", options.m_cells, "cells along a ball; 8 give 3,072 tets")
        ->check(CLI::Range(2, 32))
        ->capture_default_str();
    app.add_option("--json", options.m_jsonFile, "write the results to this file");
    app.footer(
        "Example, the pictures of docs/accuracy.md:\n  bulletfem_bench_motion --json motion.json\n"
        "  tools/plot_motion_against_step.py motion.json docs/motion_against_step.png\n"
        "  tools/plot_rebound.py motion.json docs/rebound_against_stiffness.png\n"
        "Exit code 0 if all ran, another if an option is wrong or a file cannot be written.");
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Measures how motion depends on the step", "bulletfem_bench_motion");
    addOptions(app, options);
    CLI11_PARSE(app, argc, argv);

    const auto run = [&]
    {
        JsonFile json(options.m_jsonFile);
        const MachineInfo machine = readMachineInfo(1);
        std::vector<MotionCase> cases;
        for (const std::string& name : options.m_cases) cases.push_back(motionCase(name));
        std::vector<MotionFigures> rows;
        for (const MotionCase chosen : cases)
            for (const MotionFigures& row :
                 measureMotion(chosen, options.m_rates, options.m_reference, options.m_cells))
                rows.push_back(row);
        std::cout << toText(machine) << "\nMotion against the step, one thread\n";
        printTable(std::cout, rows);
        std::cout << g_legend;
        json.write(machine, {{"reference", options.m_reference}, {"results", toJson(rows)}});
        return 0;
    };
    return runProgram("bulletfem_bench_motion", run);
}
