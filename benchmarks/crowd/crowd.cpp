// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Many soft bodies and rigid balls in a pit: cost of a step while all bodies move, rest or sleep.
#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/crowd/crowd_report.h"
#include "benchmarks/crowd/free_copies.h"
#include "benchmarks/json_file.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
Wall times of stepSimulation; all bodies are factored before the first step.
falling    from the first step on: the bodies fall into the pit and pile up
awake      afterwards, sleeping disabled
sleeping   afterwards, sleeping allowed: the first steps, in which bodies fall asleep, are not timed
CPU ms     processor time of the calling thread; on one thread that of the step, nearly independent of other programs
free       elastic solves without contact: sum over the bodies, over the number of threads
contact    search of surfaces, sweeps, corrective solves; sum over all groups of bodies in contact
rest       Bullet's broad phase and rigid solver, and the exchange with its nodes
points     contact points, mean; those between soft bodies count twice
corr.it    conjugate gradient iterations of the corrective solves, mean
closing    largest remaining closing speed at a contact point; deepest: largest penetration at the start of a step
)";

constexpr int kDrowsySteps = 90;  // steps beyond the settling time in which a crowd falls asleep

struct Options
{
    CrowdSettings m_crowd;
    double m_settleSeconds = 2;
    int m_steps = 120;
    bool m_awakeOnly = false;
    bool m_quick = false;
    bool m_free = false;
    std::string m_jsonFile;
};

/// Runs `count` steps and reports progress: a large crowd takes minutes.
std::vector<CrowdStep> runSteps(CrowdWorld& world, int count, const char* phase)
{
    const int told = 20;
    std::vector<CrowdStep> steps;
    for (int k = 0; k < count; ++k)
    {
        if (k % told == 0) std::cerr << phase << ", step " << k << " of " << count << std::endl;
        steps.push_back(world.step());
    }
    return steps;
}

std::vector<CrowdFigures> runPhases(CrowdWorld& world, const Options& options)
{
    const int settle = std::max(1, static_cast<int>(std::lround(60 * options.m_settleSeconds)));
    std::vector<CrowdFigures> rows;
    rows.push_back(summarise("falling", runSteps(world, settle, "falling")));
    rows.push_back(summarise("awake", runSteps(world, options.m_steps, "awake")));
    if (options.m_awakeOnly) return rows;
    world.allowSleep(true);
    runSteps(world, settle + kDrowsySteps, "falling asleep");
    rows.push_back(summarise("sleeping", runSteps(world, options.m_steps, "sleeping")));
    return rows;
}

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--bodies", options.m_crowd.m_bodies, "soft bodies of about 1,000 tets")
        ->check(CLI::Range(1, 2000))
        ->capture_default_str();
    app.add_option("--balls", options.m_crowd.m_balls, "rigid balls among them")
        ->check(CLI::Range(0, 2000))
        ->capture_default_str();
    app.add_flag("--cubes", options.m_crowd.m_cubes, "soft cubes, which rest on whole faces, in place of soft balls");
    app.add_flag("--different", options.m_crowd.m_different, "bodies of different sizes, meshes and stiffness");
    app.add_option("--contact-tolerance", options.m_crowd.m_contactTolerance, "btFemSolverInfo::m_contactTolerance")
        ->check(CLI::Range(1e-7, 0.1))
        ->capture_default_str();
    app.add_option("--threads", options.m_crowd.m_threads, "btFemSolverInfo::m_threads")
        ->check(CLI::Range(0, 256))
        ->capture_default_str();
    app.add_flag("--coupled", options.m_crowd.m_coupled, "btFemConstraintSolver in place of Bullet's rigid solver");
    app.add_option("--settle", options.m_settleSeconds, "time to fall into the pit [s]")
        ->check(CLI::Range(0.02, 60.0))
        ->capture_default_str();
    app.add_option("--steps", options.m_steps, "timed steps of 1/60 s, awake and sleeping")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app.add_flag("--awake-only", options.m_awakeOnly, "skip the steps with sleeping allowed");
    app.add_flag("--free", options.m_free,
                 "instead: copies of a cube that oscillate in free fall, solved together and one by one");
    app.add_flag("--quick", options.m_quick, "10 bodies, 2 balls, 0.5 s and 30 steps, unless given otherwise");
    app.add_option("--json", options.m_jsonFile, "write the results to this file");
    app.footer(
        "Example: bulletfem_bench_crowd --bodies 400 --balls 80 --coupled\n"
        "Exit code 0 if all ran, another if an option is wrong or a file cannot be written.");
}

// Bodies of about 1,000 tets that need one or several iterations per step, then smaller and larger bodies.
void runFreeCopies(const Options& options)
{
    JsonFile json(options.m_jsonFile);
    const MachineInfo machine = readMachineInfo(1);
    std::vector<FreeCopiesFigures> rows;
    const int steps = options.m_quick ? 20 : 120;
    for (const int bodies : {16, 100})
        for (const double stale : {1, 4}) rows.push_back(measureFreeCopies({bodies, 6, 1e6, 1e-3, stale, steps}));
    for (const int cells : {4, 10, 13}) rows.push_back(measureFreeCopies({16, cells, 1e6, 1e-3, 1, steps}));
    std::cout << toText(machine)
              << "\nCopies of a cube that oscillate in free fall, elastic solves only, one thread\n\n";
    printTable(std::cout, rows);
    std::cout << "\nMedian processor time of a step of all bodies; a kick every third of a second. \"stale\": step "
                 "over\nthe factor's.\n";
    json.write(machine, {{"results", toJson(rows)}});
}

void makeQuick(const CLI::App& app, Options& options)
{
    if (app.count("--bodies") == 0) options.m_crowd.m_bodies = 10;
    if (app.count("--balls") == 0) options.m_crowd.m_balls = 2;
    if (app.count("--settle") == 0) options.m_settleSeconds = 0.5;
    if (app.count("--steps") == 0) options.m_steps = 30;
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Times many soft bodies and rigid balls in a pit", "bulletfem_bench_crowd");
    addOptions(app, options);
    CLI11_PARSE(app, argc, argv);
    if (options.m_quick) makeQuick(app, options);

    const auto run = [&]
    {
        if (options.m_free)
        {
            runFreeCopies(options);
            return 0;
        }
        JsonFile json(options.m_jsonFile);
        const MachineInfo machine = readMachineInfo(options.m_crowd.m_threads);
        const CrowdSettings& crowd = options.m_crowd;
        CrowdWorld world(crowd);
        const std::vector<CrowdFigures> rows = runPhases(world, options);
        std::cout << toText(machine) << '\n'
                  << crowd.m_bodies << (crowd.m_different ? " different" : " identical")
                  << (crowd.m_cubes ? " soft cubes, " : " soft balls, ") << world.tetCount() << " tets in all, and "
                  << crowd.m_balls << " rigid balls in a pit, "
                  << (crowd.m_coupled ? "coupled (monolithic)" : "swap alone (staggered)") << ", contact tolerance "
                  << crowd.m_contactTolerance << "; set up in " << world.setupSeconds() << " s\n\n";
        printTable(std::cout, rows);
        std::cout << g_legend;
        json.write(machine, {{"bodies", crowd.m_bodies},
                             {"balls", crowd.m_balls},
                             {"cubes", crowd.m_cubes},
                             {"different", crowd.m_different},
                             {"coupled", crowd.m_coupled},
                             {"contact_tolerance", crowd.m_contactTolerance},
                             {"threads", crowd.m_threads},
                             {"tets", world.tetCount()},
                             {"setup_s", world.setupSeconds()},
                             {"results", toJson(rows)}});
        return 0;
    };
    return runProgram("bulletfem_bench_crowd", run);
}
