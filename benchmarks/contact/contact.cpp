// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Contact: time by stage and error against the number of contacts and of elements, compared with Bullet's deformable
// world.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/contact/bullet_deformable_contact.h"
#include "benchmarks/contact/contact_fem_world.h"
#include "benchmarks/contact/contact_report.h"
#include "benchmarks/json_file.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
Times are of steps in contact, on one thread; all bodies are factored before the first step.
CPU ms    median processor time of a step, nearly independent of other programs
points    maximum over the steps; between soft bodies Bullet counts a node once for each nearby face
free      elastic solve without contact; in Bullet its only elastic solve, after contact
contact   BulletFEM: search, sweeps, corrective solves; Bullet: the rest of the step
corr. it. conjugate gradient iterations of the corrective solves per step
closing   contact residual: largest speed at which a contact point closes beyond what its gap allows
deepest   largest overlap of the soft surface with the other one, sampled at 15 points of each triangle,
          in mm and relative to the soft body's size
at end    overlap after the last step beyond the engine's own rest distance (BulletFEM 0, Bullet its soft margin of a
          fifth of a cell)
creep     mean speed of the fastest body's centre over the last 20 steps
errors    largest |sum p - p0| / sum |p_i| and |sum L - L0| / (sum |p_i| 1 m)
x Bullet  Bullet's median time over that of the row, for completed runs only: a run
          stops at the first NaN, or when the overlap is half a cell
bullet/4  four steps of 1/240 s per frame, as Bullet recommends, for runs that failed with one step; times
          and counts are sums over the four steps
)";

constexpr int kRecommendedSubSteps = 4;  // recommended by Bullet for 1/60 s

struct Options
{
    std::vector<int> m_contacts = {10, 30, 100, 300, 1000, 2000};
    std::vector<int> m_tets = {1000, 5000, 20000};
    std::vector<double> m_massRatios = {0.01, 1, 100};
    std::vector<std::string> m_scenes = {"block", "ball", "slabs", "stack"};
    bool m_quick = false;
    bool m_noBullet = false;
    bool m_coupled = false;
    bool m_lowMemory = false;
    std::string m_jsonFile;
};

/// A scene and the label of its row.
struct Job
{
    std::string m_variant;
    ContactScene m_scene;
};

std::string text(const char* format, double value)
{
    char result[32];
    std::snprintf(result, sizeof result, format, value);
    return result;
}

void addBlocks(const Options& options, std::vector<Job>& jobs)
{
    for (int tets : options.m_tets)
        for (int contacts : options.m_contacts)
            if (hasBlock(contacts, tets)) jobs.push_back({text("~%.0f", contacts), blockOnBox(contacts, tets)});
}

void addColumns(const Options& options, std::vector<Job>& jobs)
{
    for (int tets : options.m_tets)
        for (int contacts : options.m_contacts)
            for (bool pinned : {false, true})
                jobs.push_back(
                    {text(pinned ? "~%.0f pinned" : "~%.0f", contacts), columnOnBox(contacts, tets, pinned)});
}

std::vector<Job> makeJobs(const Options& options)
{
    std::vector<Job> jobs;
    for (const std::string& scene : options.m_scenes)
    {
        if (scene == "block") addBlocks(options, jobs);
        if (scene == "column") addColumns(options, jobs);
        if (scene == "ball")
            for (double ratio : options.m_massRatios)
                jobs.push_back({text("ratio %g", ratio), ballAndCube(ratio, options.m_quick ? 4 : 8)});
        if (scene == "slabs")
            jobs.push_back({options.m_quick ? "~100" : "~500", slabOnSlab(options.m_quick ? 100 : 500)});
        if (scene == "stack") jobs.push_back({"1:50", rigidOnSoftStack(options.m_quick ? 4 : 10)});
    }
    if (jobs.empty())
        throw std::invalid_argument(
            "no block of --tets can rest on --contacts nodes: give at least a fifteenth of a cube's lower nodes and at "
            "most those of a plate of one layer, such as 30 for 1000 tets");
    return jobs;
}

/// Runs one job in every engine, one after another. Bullet runs at the scene's step and, if that fails, with its
/// recommended sub-steps.
void run(const Job& job, const Options& options, std::vector<ContactFigures>& rows)
{
    std::cerr << job.m_scene.m_name << ", " << job.m_scene.tetCount() << " tets, " << job.m_variant << " ..."
              << std::endl;
    const std::size_t first = rows.size();
    const auto add = [&](ContactWorld& world)
    {
        rows.push_back(runContact(job.m_scene, world));
        rows.back().m_variant = job.m_variant;
    };
    add(*makeFemContactWorld(job.m_scene, options.m_coupled, false));
    if (options.m_lowMemory) add(*makeFemContactWorld(job.m_scene, options.m_coupled, true));
    if (options.m_noBullet) return;
    add(*makeBulletContactWorld(job.m_scene, 1));
    if (!rows.back().holds()) add(*makeBulletContactWorld(job.m_scene, kRecommendedSubSteps));
    if (!rows.back().holds()) return;
    const double bullet = rows.back().m_medianMilliseconds;
    for (std::size_t k = first; k < rows.size(); ++k)
        if (rows[k].holds()) rows[k].m_timesFasterThanBullet = bullet / rows[k].m_medianMilliseconds;
}

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--contacts", options.m_contacts,
                   "approximate nodes in contact of blocks and columns; impossible blocks are skipped")
        ->delimiter(',')
        ->check(CLI::Range(4, 2000))
        ->capture_default_str();
    app.add_option("--tets", options.m_tets, "approximate number of elements of blocks and columns")
        ->delimiter(',')
        ->check(CLI::Range(5, 200000))
        ->capture_default_str();
    app.add_option("--mass-ratio", options.m_massRatios, "masses of the rigid cube over the ball's")
        ->delimiter(',')
        ->check(CLI::Range(1e-4, 1e4))
        ->capture_default_str();
    app.add_option("--scenes", options.m_scenes, "which of block, column, ball, slabs, stack")
        ->delimiter(',')
        ->check(CLI::IsMember({"block", "column", "ball", "slabs", "stack"}))
        ->capture_default_str();
    app.add_flag("--quick", options.m_quick, "small scenes: seconds instead of minutes");
    app.add_flag("--coupled", options.m_coupled, "btFemConstraintSolver in place of Bullet's rigid solver");
    app.add_flag("--low-memory", options.m_lowMemory, "also run the low-memory path");
    app.add_flag("--no-bullet", options.m_noBullet, "skip Bullet's deformable world");
    app.add_option("--json", options.m_jsonFile, "write the results to this file");
    app.footer(
        "Example, one block in both engines: bulletfem_bench_contact --scenes block --contacts 100 --tets 1000\n"
        "Exit code 0 if all ran, another if an option is wrong or a file cannot be written.");
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Times contact: BulletFEM and Bullet's own deformable world", "bulletfem_bench_contact");
    addOptions(app, options);
    CLI11_PARSE(app, argc, argv);
    if (options.m_quick && app.count("--contacts") == 0) options.m_contacts = {10, 100};
    if (options.m_quick && app.count("--tets") == 0) options.m_tets = {1000};

    const auto runAll = [&]
    {
        JsonFile json(options.m_jsonFile);
        const MachineInfo machine = readMachineInfo(1);
        std::vector<ContactFigures> rows;
        for (const Job& job : makeJobs(options)) run(job, options, rows);
        std::cout << toText(machine)
                  << "\nUpholstery foam (E 5e4 Pa, nu .1, rho 40 kg/m3), beta .01 s, friction .5, h 1/60 s\n";
        printTables(std::cout, rows);
        std::cout << g_legend;
        json.write(machine, {{"coupled", options.m_coupled}, {"results", toJson(rows)}});
        return 0;
    };
    return runProgram("bulletfem_bench_contact", runAll);
}
