// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include "tools/bulletfem/commands.h"
#include "tools/bulletfem/figures.h"
#include "tools/bulletfem/run_output.h"
#include "tools/console/option_range.h"
#include "tools/console/progress_line.h"
#include "tools/scene/scene_reader.h"
#ifdef BULLETFEM_HAS_VIEWER
#include "tools/pictures/viewer.h"
#include "tools/scene/scene_simulation.h"
#endif

namespace bullet_fem
{
namespace
{

/// Cost and health of a run.
struct RunFigures
{
    std::vector<double> m_milliseconds;  // a step
    int m_flags = 0;
    int m_mostContacts = 0;

    void take(const SceneWorld& world, double milliseconds)
    {
        m_milliseconds.push_back(milliseconds);
        int contacts = 0;
        for (int i = 0; i < world.softCount(); ++i)
        {
            const btFemStepReport& report = world.fem().stepReport(&world.soft(i));
            m_flags |= report.m_flags;
            contacts += report.m_contacts;
        }
        m_mostContacts = std::max(m_mostContacts, contacts);
    }
};

struct SimulateCommand
{
    std::string m_scene;
    RunOutputSettings m_output;
    double m_seconds = 0;
    bool m_stress = false, m_window = false, m_quiet = false;
    Figures m_figures;

    void run()
    {
        SceneDescription scene = readScene(m_scene);
        if (m_seconds > 0) scene.m_seconds = m_seconds;
        if (m_stress) scene.m_pictures.m_stress = true;
        if (m_output.m_folder.empty()) m_output.m_folder = "out/" + std::filesystem::path(m_scene).stem().string();
        if (!m_output.m_glb && !m_output.m_png && m_output.m_films.empty()) m_output.m_pvd = true;
        SceneWorld world(scene);
        if (m_window) return show(world);
        simulate(world);
    }

    void simulate(SceneWorld& world)
    {
        const SceneDescription& scene = world.description();
        SceneFrames frames(world);
        RunOutput output(m_output, world, frames);
        const bool shown = !m_quiet && !m_figures.asJson();
        ProgressLine simulating, drawing;
        RunFigures figures;
        const long steps = std::lround(std::ceil(scene.m_seconds / scene.m_step - 1e-9));
        output.add();
        for (long k = 1; k <= steps; ++k)
        {
            const auto start = std::chrono::steady_clock::now();
            world.step();
            const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
            figures.take(world, taken.count());
            if (k == steps || world.time() * scene.m_framesPerSecond + 1e-9 >= output.frameCount())
            {
                frames.update();
                output.add();
            }
            if (shown) simulating.show(double(k) / double(steps), "simulating");
        }
        simulating.finish();
        const auto draw = [&](double share)
        {
            if (shown) drawing.show(share, "drawing");
        };
        const std::vector<std::string> files = output.finish(draw);
        drawing.finish();
        tell(world, figures, output.frameCount());
        m_figures.add("files", files);
        m_figures.print();
    }

    void tell(const SceneWorld& world, RunFigures& figures, int frames)
    {
        int tets = 0;
        for (int i = 0; i < world.softCount(); ++i) tets += world.fem().stepReport(&world.soft(i)).m_tets;
        std::vector<double>& cost = figures.m_milliseconds;
        std::sort(cost.begin(), cost.end());
        m_figures.add("steps", cost.size());
        m_figures.add("frames", frames);
        m_figures.add("tets", tets);
        m_figures.add("mostContacts", figures.m_mostContacts, "points");
        m_figures.add("medianStep", cost.empty() ? 0 : cost[cost.size() / 2], "ms");
        m_figures.add("worstStep", cost.empty() ? 0 : cost.back(), "ms");
        m_figures.add("notConverged", (figures.m_flags & BT_FEM_NOT_CONVERGED) != 0);
        m_figures.add("restored", (figures.m_flags & BT_FEM_RESTORED) != 0);
    }

#ifdef BULLETFEM_HAS_VIEWER
    static void show(SceneWorld& world)
    {
        SceneSimulation simulation(world);
        ViewerSettings settings;
        settings.m_title = world.description().m_title.empty() ? "BulletFEM" : world.description().m_title;
        settings.m_size = {world.description().m_pictures.m_width, world.description().m_pictures.m_height};
        Viewer(simulation, settings).run();
    }
#else
    static void show(SceneWorld&)
    {
        throw std::runtime_error(
            "this program was built without a window: install what docs/pictures.md names, and build it anew");
    }
#endif
};

}  // namespace

void addSimulateCommand(CLI::App& app)
{
    CLI::App* command = app.add_subcommand(
        "simulate",
        "Runs a scene (docs/scenes.md) and writes what you ask for; ParaView files if you ask for nothing.\n"
        "Or shows it in a window: drag bodies with the left button, turn with it beside them, space pauses.");
    const auto options = std::make_shared<SimulateCommand>();
    RunOutputSettings& output = options->m_output;
    command->add_option("scene", options->m_scene, "the scene's .json file")->required();
    command->add_option("-o,--out", output.m_folder, "folder of the files (default out/<scene>)");
    command->add_option("--seconds", options->m_seconds, "time to simulate (default: the scene's)")
        ->check(inRange(1e-6, 1e5));
    command->add_flag("--pvd", output.m_pvd,
                      "elements.pvd and surfaces.pvd for ParaView, with stress and contact forces");
    command->add_flag("--glb", output.m_glb, "run.glb, animated, for web viewers and Blender");
    command->add_flag("--png", output.m_png, "first.png, last.png and strip.png");
    command->add_option("--film", output.m_films, "a film of this name: .mp4 or .gif; may be given again")
        ->check(
            [](const std::string& name)
            {
                const std::string ending = std::filesystem::path(name).extension().string();
                return ending == ".mp4" || ending == ".gif" ? "" : name + " must end in .mp4 or .gif";
            })
        ->take_all()
        ->allow_extra_args(false);
    command->add_flag("--stress", options->m_stress, "colours are von Mises stress");
    command->add_flag("--quiet", options->m_quiet, "no progress");
    command->add_flag("--window", options->m_window, "show it; nothing is written");
    options->m_figures.addOption(*command);
    command->callback([options] { options->run(); });
}

}  // namespace bullet_fem
