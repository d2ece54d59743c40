// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Scenes typical of games: time by stage with errors, for both coupling methods.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/figures.h"
#include "benchmarks/games/game_report.h"
#include "benchmarks/games/game_scene.h"
#include "benchmarks/json_file.h"
#include "benchmarks/machine_info.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

const char* const g_legend = R"(
Processor times of frames of 1/60 s [ms], one thread; all bodies are factored before the first frame
free      median of the elastic solves without contact, all bodies
contact   median of search, sweeps and corrective solves, and joints
points    median number of contact points; those between soft bodies count twice
closing   largest speed at which a contact point closes beyond what its gap allows
deepest   largest penetration
bullet    Bullet alone: its finite elements in PinchFriction, its clusters in TetraBunny
force     |held - weight| / weight, mean over the last second, if all soft bodies rest on other bodies
)";

struct Options
{
    std::vector<std::string> m_scenes;
    double m_contactTolerance = btFemSolverInfo().m_contactTolerance;
    double m_share = 1;
    std::string m_bulletSource = BULLETFEM_BULLET_SOURCE;
    std::string m_jsonFile;
};

double ofRank(std::vector<double> values, double share)
{
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * double(values.size())))];
}

const char* nameOf(BenchmarkLine line)
{
    if (line == BenchmarkLine::bullet) return "bullet";
    return line == BenchmarkLine::coupled ? "coupled" : "swap";
}

GameRow run(const GameScene& scene, BenchmarkLine line, const Options& options)
{
    GameSettings settings;
    settings.m_line = line;
    settings.m_contactTolerance = options.m_contactTolerance;
    settings.m_subSteps = scene.m_subSteps;
    const std::unique_ptr<Game> world = scene.m_start(settings);
    std::vector<double> total, free, contact, points, sweeps, iterations;
    GameRow row;
    row.m_scene = scene.m_name;
    row.m_coupling = nameOf(line);
    row.m_isOfBullet = line == BenchmarkLine::bullet;
    row.m_tets = world->tetCount();
    const int frames = std::max(2, static_cast<int>(options.m_share * scene.m_frames));
    double held = 0;
    int heldFrames = 0;
    for (int k = 0; k < frames; ++k)
    {
        const GameFrame frame = world->step();
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
    row.m_outcome = world->outcome();
    if (scene.m_carriesItsWeight && line != BenchmarkLine::bullet && heldFrames > 0)
        row.m_force = std::abs(held / heldFrames / world->softWeight() - 1);
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

bool isChosen(const GameScene& scene, const Options& options)
{
    return options.m_scenes.empty() ||
           std::any_of(options.m_scenes.begin(), options.m_scenes.end(),
                       [&](const std::string& begin) { return scene.m_name.rfind(begin, 0) == 0; });
}

void runScene(const GameScene& scene, const Options& options, std::vector<GameRow>& rows)
{
    if (!scene.m_missing.empty())
    {
        std::cerr << scene.m_name << " is left out: " << scene.m_missing << std::endl;
        return;
    }
    for (const BenchmarkLine line : {BenchmarkLine::swap, BenchmarkLine::coupled, BenchmarkLine::bullet})
    {
        if (line == BenchmarkLine::bullet && !scene.m_isOfBullet) continue;
        std::cerr << scene.m_name << ", " << nameOf(line) << " ..." << std::endl;
        rows.push_back(run(scene, line, options));
    }
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Times scenes typical of games", "bulletfem_bench_games");
    std::string names;
    for (const GameScene& scene : gameScenes({})) names += (names.empty() ? "" : ", ") + scene.m_name;
    app.add_option("--scenes", options.m_scenes, "scenes whose names begin with these; default all: " + names)
        ->delimiter(',');
    app.add_option("--contact-tolerance", options.m_contactTolerance, "btFemSolverInfo::m_contactTolerance")
        ->check(CLI::Range(1e-7, 0.1))
        ->capture_default_str();
    app.add_option("--share", options.m_share, "fraction of each scene's frames to run")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    app.add_option("--bullet-source", options.m_bulletSource,
                   "Bullet's source tree, with the meshes of PinchFriction and TetraBunny in examples; these scenes "
                   "are skipped without it")
        ->envname("BULLETFEM_BULLET_SOURCE")
        ->capture_default_str();
    app.add_option("--json", options.m_jsonFile, "write the results to this file");
    CLI11_PARSE(app, argc, argv);
    const auto runAll = [&]
    {
        JsonFile json(options.m_jsonFile);
        const MachineInfo machine = readMachineInfo(1);
        std::vector<GameRow> rows;
        bool isAny = false;
        for (const GameScene& scene : gameScenes(options.m_bulletSource))
        {
            if (!isChosen(scene, options)) continue;
            isAny = true;
            runScene(scene, options, rows);
        }
        if (!isAny) throw std::invalid_argument("no scene has such a name; the scenes are: " + names);
        std::cout << toText(machine) << "\nContact tolerance " << options.m_contactTolerance << "\n";
        printTable(std::cout, rows);
        std::cout << g_legend;
        json.write(machine, {{"results", toJson(rows)}});
        return 0;
    };
    return runProgram("bulletfem_bench_games", runAll);
}
