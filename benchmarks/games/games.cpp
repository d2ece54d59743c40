// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Scenes as games have them: time by stage beside errors, in both couplings.
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/figures.h"
#include "benchmarks/games/game_scene.h"
#include "benchmarks/json_file.h"
#include "benchmarks/machine_info.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
Processor times of frames of 1/60 s [ms], one thread; all bodies factored before the first
free      median of the elastic solves without contact, all bodies
contact   median of search, sweeps and corrective solves, and joints
points    median contact points; between soft bodies they count for both
closing   worst speed at which a contact point still closes faster than its gap allows
deepest   worst penetration
force     |held - weight| / weight, mean over the last second, where all soft bodies rest on what is not soft
)";

struct Options
{
    std::vector<std::string> m_scenes;
    double m_contactTolerance = btFemSolverInfo().m_contactTolerance;
    double m_share = 1;
    std::string m_jsonFile;
};

struct Row
{
    std::string m_scene, m_coupling;
    int m_tets = 0;
    double m_median = 0, m_late = 0, m_worst = 0, m_free = 0, m_contact = 0, m_points = 0;
    double m_sweeps = 0, m_iterations = 0, m_closing = 0, m_deepest = 0, m_force = -1;
    int m_asleep = 0;
};

double ofRank(std::vector<double> values, double share)
{
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * double(values.size())))];
}

Row run(const GameScene& scene, bool coupled, const Options& options)
{
    GameSettings settings;
    settings.m_coupled = coupled;
    settings.m_contactTolerance = options.m_contactTolerance;
    settings.m_subSteps = scene.m_subSteps;
    GameWorld world(settings);
    scene.m_build(world);
    std::vector<double> total, free, contact, points, sweeps, iterations;
    Row row;
    row.m_scene = scene.m_name;
    row.m_coupling = coupled ? "coupled" : "swap";
    row.m_tets = world.world().tetCount();
    const int frames = std::max(2, static_cast<int>(options.m_share * scene.m_frames));
    double held = 0;
    int heldFrames = 0;
    for (int k = 0; k < frames; ++k)
    {
        if (scene.m_drive) scene.m_drive(world, k / 60.0);
        const GameFrame frame = world.step();
        total.push_back(frame.m_milliseconds);
        free.push_back(frame.m_freeMilliseconds);
        contact.push_back(frame.m_contactMilliseconds);
        points.push_back(frame.m_contacts);
        sweeps.push_back(frame.m_sweeps);
        iterations.push_back(frame.m_correctiveIterations);
        row.m_closing = std::max(row.m_closing, frame.m_closingSpeed);
        row.m_deepest = std::max(row.m_deepest, frame.m_deepest);
        row.m_asleep = frame.m_asleep;
        if (k < frames - 60 || frame.m_asleep > 0) continue;
        held += frame.m_held;
        ++heldFrames;
    }
    if (scene.m_carriesItsWeight && heldFrames > 0) row.m_force = std::abs(held / heldFrames / world.softWeight() - 1);
    row.m_median = median(total);
    row.m_late = ofRank(total, 0.95);
    row.m_worst = largest(total);
    row.m_free = median(free);
    row.m_contact = median(contact);
    row.m_points = median(points);
    row.m_sweeps = median(sweeps);
    row.m_iterations = median(iterations);
    return row;
}

void printTable(std::ostream& out, const std::vector<Row>& rows)
{
    print(out, "\n%-16s %-8s %6s %8s %8s %8s %7s %8s %7s %7s %6s %9s %9s %8s\n", "scene", "coupling", "tets", "median",
          "95 %", "worst", "free", "contact", "points", "sweeps", "c.it.", "closing", "deepest", "force");
    print(out, "%-16s %-8s %6s %8s %8s %8s %7s %8s %7s %7s %6s %9s %9s %8s\n", "", "", "", "[ms]", "[ms]", "[ms]",
          "[ms]", "[ms]", "", "", "", "[mm/s]", "[mm]", "[-]");
    for (const Row& r : rows)
    {
        print(out, "%-16s %-8s %6d %8.2f %8.2f %8.2f %7.2f %8.2f %7.0f %7.0f %6.0f %9.3f %9.3f ", r.m_scene.c_str(),
              r.m_coupling.c_str(), r.m_tets, r.m_median, r.m_late, r.m_worst, r.m_free, r.m_contact, r.m_points,
              r.m_sweeps, r.m_iterations, 1e3 * r.m_closing, 1e3 * r.m_deepest);
        if (r.m_force >= 0)
            print(out, "%8.1e\n", r.m_force);
        else
            print(out, "%8s\n", "-");
    }
}

nlohmann::json toJson(const std::vector<Row>& rows)
{
    nlohmann::json all = nlohmann::json::array();
    for (const Row& r : rows)
        all.push_back({{"scene", r.m_scene},
                       {"coupling", r.m_coupling},
                       {"tets", r.m_tets},
                       {"median_ms", r.m_median},
                       {"percentile95_ms", r.m_late},
                       {"worst_ms", r.m_worst},
                       {"free_ms", r.m_free},
                       {"contact_ms", r.m_contact},
                       {"points", r.m_points},
                       {"sweeps", r.m_sweeps},
                       {"corrective", r.m_iterations},
                       {"closing", r.m_closing},
                       {"deepest", r.m_deepest},
                       {"force_error", r.m_force}});
    return all;
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Times scenes as games have them", "bulletfem_bench_games");
    std::string names;
    for (const GameScene& scene : gameScenes()) names += (names.empty() ? "" : ", ") + scene.m_name;
    app.add_option("--scenes", options.m_scenes, "those whose names begin so; all unless given: " + names)
        ->delimiter(',');
    app.add_option("--contact-tolerance", options.m_contactTolerance, "btFemSolverInfo::m_contactTolerance")
        ->check(CLI::Range(1e-7, 0.1))
        ->capture_default_str();
    app.add_option("--share", options.m_share, "of the frames of every scene")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    app.add_option("--json", options.m_jsonFile, "write the same figures to this file");
    CLI11_PARSE(app, argc, argv);
    const auto isChosen = [&](const GameScene& scene)
    {
        return options.m_scenes.empty() ||
               std::any_of(options.m_scenes.begin(), options.m_scenes.end(),
                           [&](const std::string& begin) { return scene.m_name.rfind(begin, 0) == 0; });
    };
    const auto runAll = [&]
    {
        JsonFile json(options.m_jsonFile);
        const MachineInfo machine = readMachineInfo(1);
        std::vector<Row> rows;
        for (const GameScene& scene : gameScenes())
            for (const bool coupled : {false, true})
            {
                if (!isChosen(scene)) continue;
                std::cerr << scene.m_name << (coupled ? ", coupled ..." : ", swap ...") << std::endl;
                rows.push_back(run(scene, coupled, options));
            }
        if (rows.empty()) throw std::invalid_argument("no scene has such a name; those that there are: " + names);
        std::cout << toText(machine) << "\nContact tolerance " << options.m_contactTolerance << "\n";
        printTable(std::cout, rows);
        std::cout << g_legend;
        json.write(machine, {{"results", toJson(rows)}});
        return 0;
    };
    return runProgram("bulletfem_bench_games", runAll);
}
