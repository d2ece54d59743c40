// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Iterations and errors over the dimensionless stiffness h^2 E / (rho e^2).
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "benchmarks/figures.h"
#include "benchmarks/json_file.h"
#include "benchmarks/stiffness/bent_bar.h"
#include "benchmarks/stiffness/solver_jaws.h"
#include "benchmarks/stiffness/world_cubes.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
number     h^2 E / (rho e^2), h 1/60 s, 1000 kg/m3, nu .3, beta .005 s; e is the edge of a cell
bar        iterations of the free motion, most of the first four steps of a bar that is released from an arc of 30 degrees
jaws       a cube of 4 x 4 x 4 cells between jaws without friction that close by 1 % in a second; gravity as --gravity says
solver     ContactSolver alone, in double precision; swap, coupled: the plug-in in a Bullet world
rounds     outer iterations a step, mean and most
sweeps, CG sweeps, and conjugate gradient iterations of the corrective solves, a step, mean and most
force      of the upper jaw over E A .01, of the plane over the weight; fastest: largest speed of a node over the jaws'
rest       the cube on a plane in the second second, the swap alone; the largest soft cubes still swing then, also between jaws
)";

struct Row
{
    StiffnessCase m_case;
    int m_bar = 0;
    CubeFigures m_solver, m_swap, m_coupled, m_rest;
};

Row measure(const StiffnessCase& of, double gravity)
{
    print(std::cerr, "E %.0e Pa, e %g m ...\n", of.m_young, of.m_edge);
    return {of,
            releaseBentBar(of),
            pressBySolver(of),
            pressInWorld(of, BenchmarkLine::swap, gravity),
            pressInWorld(of, BenchmarkLine::coupled, gravity),
            restOnPlane(of)};
}

std::string forceOf(const CubeFigures& figures)
{
    if (figures.m_isThrown) return "thrown";
    if (figures.m_isTooSoft) return "too soft";
    char text[32];
    std::snprintf(text, sizeof text, "%.4f", figures.m_force);
    return text;
}

void printWork(const WorkCount& work)
{
    print(std::cout, " %6.1f %4d", work.mean(), work.m_most);
}

void printTable(const std::vector<Row>& rows)
{
    print(std::cout, "%8s %7s %6s %4s | %-43s | %-40s | %-40s | %s\n", "", "", "", "", "jaws, solver", "jaws, swap",
          "jaws, coupled", "rest, swap");
    print(std::cout, "%8s %7s %6s %4s", "number", "E [Pa]", "e [m]", "bar");
    print(std::cout, " | %11s %11s %8s %10s", "rounds", "sweeps", "force", "fastest");
    for (int k = 0; k < 2; ++k) print(std::cout, " | %11s %11s %8s %7s", "sweeps", "CG", "force", "fastest");
    print(std::cout, " | %11s %11s %8s\n", "sweeps", "CG", "force");
    for (const Row& row : rows)
    {
        print(std::cout, "%8.2g %7.0e %6g %4d |", row.m_case.number(), row.m_case.m_young, row.m_case.m_edge,
              row.m_bar);
        printWork(row.m_solver.m_rounds);
        printWork(row.m_solver.m_sweeps);
        print(std::cout, " %8s %10.2f |", forceOf(row.m_solver).c_str(), row.m_solver.m_fastest);
        for (const CubeFigures* figures : {&row.m_swap, &row.m_coupled})
        {
            printWork(figures->m_sweeps);
            printWork(figures->m_iterations);
            print(std::cout, " %8s %7.2f |", forceOf(*figures).c_str(), figures->m_fastest);
        }
        printWork(row.m_rest.m_sweeps);
        printWork(row.m_rest.m_iterations);
        print(std::cout, " %8s\n", forceOf(row.m_rest).c_str());
    }
}

nlohmann::json toJson(const WorkCount& work)
{
    if (work.m_steps == 0) return nullptr;
    return {{"mean", work.mean()}, {"most", work.m_most}};
}

nlohmann::json toJson(const CubeFigures& figures)
{
    return {{"force", figures.m_force},
            {"fastest", figures.m_fastest},
            {"thrown", figures.m_isThrown},
            {"too_soft", figures.m_isTooSoft},
            {"rounds", toJson(figures.m_rounds)},
            {"sweeps", toJson(figures.m_sweeps)},
            {"iterations", toJson(figures.m_iterations)}};
}

nlohmann::json toJson(const std::vector<Row>& rows)
{
    nlohmann::json results = nlohmann::json::array();
    for (const Row& row : rows)
        results.push_back({{"number", row.m_case.number()},
                           {"young_modulus_pa", row.m_case.m_young},
                           {"edge_m", row.m_case.m_edge},
                           {"bar_iterations", row.m_bar},
                           {"solver", toJson(row.m_solver)},
                           {"swap", toJson(row.m_swap)},
                           {"coupled", toJson(row.m_coupled)},
                           {"rest", toJson(row.m_rest)}});
    return results;
}

}  // namespace

int main(int argc, char** argv)
{
    std::vector<double> moduli = {1e4, 1e5, 1e6, 1e7, 1e8, 1e9}, edges = {1e-3, 1e-2, 0.1, 1};
    double gravity = 0;
    std::string jsonFile;
    CLI::App app("Measures iterations and errors over the dimensionless stiffness", "bulletfem_bench_stiffness");
    app.add_option("--young", moduli, "Young's moduli [Pa]")
        ->delimiter(',')
        ->check(CLI::Range(1e3, 1e12))
        ->capture_default_str();
    app.add_option("--edges", edges, "edges of a cell [m]")
        ->delimiter(',')
        ->check(CLI::Range(1e-4, 10.0))
        ->capture_default_str();
    app.add_option("--gravity", gravity, "downwards, on the cube between jaws of a world [m/s2]")
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    app.add_option("--json", jsonFile, "write the results to this file");
    app.footer("Exit code 0 if all ran, another if an option is wrong or a file cannot be written.");
    CLI11_PARSE(app, argc, argv);

    const auto run = [&]
    {
        JsonFile json(jsonFile);
        const MachineInfo machine = readMachineInfo(1);
        std::vector<Row> rows;
        for (const double edge : edges)
            for (const double young : moduli) rows.push_back(measure({young, edge}, gravity));
        std::stable_sort(rows.begin(), rows.end(),
                         [](const Row& a, const Row& b) { return a.m_case.number() < 0.99 * b.m_case.number(); });
        std::cout << toText(machine) << "\nStiffness, one thread\n\n";
        printTable(rows);
        std::cout << g_legend;
        json.write(machine, {{"gravity", gravity}, {"results", toJson(rows)}});
        return 0;
    };
    return runProgram("bulletfem_bench_stiffness", run);
}
