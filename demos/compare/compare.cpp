// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Equal meshes in equal scenes at 60 Hz: Bullet's own soft bodies on the left, BulletFEM on the right.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demos/compare/compared_film.h"
#include "tools/console/option_range.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

constexpr int kCheckFailed = 3;
constexpr double kStands = 0.8;  // minimum final height over the initial one

struct CompareOptions
{
    std::string m_meshFile, m_folder;
    double m_seconds = 0;  // 0: the scene's own duration
    CrateSettings m_crate;
    double m_jelly = 3e4;  // [Pa]
    int m_cells = 4;
    int m_clusters = -1;  // -1: the scene's own number
    SpringSettings m_springs;
};

std::optional<int> parse(int argc, char** argv, CompareOptions& options)
{
    CLI::App app(
        "Bullet's own soft bodies (left) and BulletFEM (right): a box falls on a stack, and a crate on a surface.\n"
        "Prints processor time per step and the final state of the bodies; --out draws a film.\n"
        "Exit code: 1 on a bad file, 2 on a bad option, 3 if a check of BulletFEM's side failed.");
    app.option_defaults()->take_last()->always_capture_default(true);
    app.add_option("--mesh", options.m_meshFile,
                   "closed surface: OFF, OBJ, STL or PLY file; only the stack without it");
    app.add_option("--out", options.m_folder, "folder for film.mp4 and a picture of each scene; none without it");
    app.add_option("--seconds", options.m_seconds, "time to simulate [s]; 0: as long as the scene lasts")
        ->check(inRange(0, 60));
    app.add_option("--young", options.m_crate.m_young, "BulletFEM: Young's modulus of the surface's body [Pa]")
        ->check(inRange(1, 1e9));
    app.add_option("--jelly", options.m_jelly, "BulletFEM: Young's modulus in the stack [Pa]")->check(inRange(1, 1e9));
    app.add_option("--tets", options.m_crate.m_tets, "desired number of elements of the surface's body")
        ->check(CLI::Range(100, 20000));
    app.add_option("--crate", options.m_crate.m_crateMass, "mass of the crate [kg]")->check(inRange(0.1, 1e4));
    app.add_option("--cells", options.m_cells, "cells along a cushion of the stack")->check(CLI::Range(2, 12));
    app.add_option("--stiffness", options.m_springs.m_linear, "Bullet: kLST of its springs [-]")->check(inRange(0, 1));
    app.add_option("--iterations", options.m_springs.m_iterations, "Bullet: position iterations")
        ->check(CLI::Range(1, 1000));
    app.add_option("--clusters", options.m_clusters,
                   "Bullet: clusters of a body that collide; 0: its nodes collide with distance fields; -1: 16 for the "
                   "surface's body, 0 in the stack, the best values for Bullet")
        ->check(CLI::Range(-1, 1000));
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return app.exit(error) == 0 ? 0 : kUsageError;
    }
    return std::nullopt;
}

std::string formatted(const char* format, double value)
{
    char text[80];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

void print(const char* what, double left, double right, const char* unit)
{
    std::printf("  %-34s %12.4g %12.4g  %s\n", what, left, right, unit);
}

/// Returns false if BulletFEM's side fails a check.
bool report(const ComparedScene& scene, const ComparedRun& left, const ComparedRun& right)
{
    std::printf("%-36s %12s %12s\n", scene.m_name.c_str(), "Bullet", "BulletFEM");
    print("elements", left.m_elements, right.m_elements, "");
    print("median of a step", left.medianMs(), right.medianMs(), "ms of processor time");
    print("worst step", left.worstMs(), right.worstMs(), "ms");
    print("deepest node below the ground", left.m_deepest, right.m_deepest, "m");
    print("deepest node in a box", left.m_inside, right.m_inside, "m");
    print("elements inside out, at most", 100 * left.m_inverted, 100 * right.m_inverted, "%");
    if (right.m_height == kNoStack) return true;
    print("height at the end / at the start", left.m_height, right.m_height, "");
    print("fastest body at the end", left.m_fastest, right.m_fastest, "m/s");
    return right.m_height > kStands;
}

ComparedText textOf(const char* title, const ComparedRun& run)
{
    const bool stack = run.m_height != kNoStack;
    return {title, formatted("%.1f ms a step", run.medianMs()) +
                       (stack ? formatted("\nheight kept: %.0f %%", 100 * run.m_height)
                              : formatted("\ncrate sinks in by %.1f cm", 100 * run.m_inside))};
}

int run(const CompareOptions& options)
{
    std::unique_ptr<ComparedFilm> film;
    if (!options.m_folder.empty()) film = std::make_unique<ComparedFilm>(options.m_folder);
    std::vector<ComparedScene> scenes;
    scenes.push_back(stackScene(options.m_jelly, options.m_cells));
    if (!options.m_meshFile.empty()) scenes.push_back(crateScene(options.m_meshFile, options.m_crate));
    bool good = true;
    for (const ComparedScene& scene : scenes)
    {
        const double seconds = options.m_seconds > 0 ? options.m_seconds : scene.m_seconds;
        SpringSettings springs = options.m_springs;
        springs.m_clusters = options.m_clusters < 0 ? scene.m_clusters : options.m_clusters;
        const ComparedRun left = play(scene, *makeBulletSide(springs), seconds);
        const ComparedRun right = play(scene, *makeFemSide(), seconds);
        good = report(scene, left, right) && good;
        if (film) film->add(scene, left, textOf("Bullet's soft body", left), right, textOf("BulletFEM", right));
    }
    if (film)
        for (const std::string& path : film->finish()) std::printf("written: %s\n", path.c_str());
    return good ? 0 : kCheckFailed;
}

}  // namespace

int main(int argc, char** argv)
{
    CompareOptions options;
    if (const auto exitCode = parse(argc, argv, options)) return *exitCode;
    return runProgram("bulletfem_demo_compare", [&] { return run(options); });
}
