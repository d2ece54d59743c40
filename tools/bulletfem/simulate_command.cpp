// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include "tools/bulletfem/cage_options.h"
#include "tools/bulletfem/commands.h"
#include "tools/bulletfem/figures.h"
#include "tools/bulletfem/material_options.h"
#include "tools/bulletfem/run_health.h"
#include "tools/bulletfem/run_output.h"
#include "tools/bulletfem/sensor_table.h"
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

std::string windowHelp()
{
#ifdef BULLETFEM_HAS_VIEWER
    return viewerHelpText();
#else
    return "(this program was built without a window)";
#endif
}

constexpr std::size_t kMaxFactorBytes = std::size_t(4) << 30u;  // limit for meshes opened in the window

/// Cost and final state of a run.
struct RunFigures
{
    std::vector<double> m_milliseconds;  // per step
    SceneFlags m_flags;
    int m_mostContacts = 0;

    void take(const SceneWorld& world, double milliseconds)
    {
        m_milliseconds.push_back(milliseconds);
        m_flags.look(world);
        int contacts = 0;
        for (int i = 0; i < world.softCount(); ++i) contacts += world.fem().stepReport(&world.soft(i)).m_contacts;
        m_mostContacts = std::max(m_mostContacts, contacts);
    }
};

struct SimulateCommand
{
    std::string m_scene;
    RunOutputSettings m_output;
    double m_seconds = 0;
    bool m_stress = false, m_window = false, m_quiet = false;
    std::vector<std::string> m_meshes;  // opened in the window at the start
    double m_scale = 1;
    CageOptions m_cage;
    MaterialOptions m_material;
    int m_historySteps = 10, m_historyMegabytes = 256;
    Figures m_figures;

    void run()
    {
        if (m_window) return show();
        if (m_scene.empty()) throw CLI::ValidationError("simulate", "a scene is required, but with --window");
        simulate();
    }

    SceneDescription read() const
    {
        SceneDescription scene = readScene(m_scene);
        if (m_seconds > 0) scene.m_seconds = m_seconds;
        if (m_stress) scene.m_pictures.m_stress = true;
        return scene;
    }

    std::string folder() const
    {
        if (!m_output.m_folder.empty()) return m_output.m_folder;
        return "out/" + (m_scene.empty() ? "window" : std::filesystem::path(m_scene).stem().string());
    }

    void simulate()
    {
        SceneWorld world(read());
        m_output.m_folder = folder();
        if (!m_output.m_glb && !m_output.m_png && m_output.m_films.empty()) m_output.m_pvd = true;
        const SceneDescription& scene = world.description();
        SceneFrames frames(world);
        RunOutput output(m_output, world, frames);
        SensorTable sensors(world, m_output.m_folder);
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
            sensors.take();
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
        std::vector<std::string> files = output.finish(draw);
        sensors.finish(files);
        drawing.finish();
        tell(world, figures, output.frameCount());
        sensors.tell(m_figures);
        const std::vector<SceneFault> faults = findFaults(world, frames);
        tellFlags(m_figures, figures.m_flags.all());
        tellFaults(m_figures, faults);
        m_figures.add("files", files);
        m_figures.print();
        if (!faults.empty()) throw CLI::RuntimeError(kFaultyEnd);
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
        if (!world.fractures().bodies().empty())
        {
            int parts = 0;
            for (const SceneSplits& body : world.fractures().bodies()) parts += body.m_parts;
            m_figures.add("splits", world.fractures().count());
            m_figures.add("parts", parts);
        }
    }

#ifdef BULLETFEM_HAS_VIEWER
    void show() const
    {
        SceneWorld world(m_scene.empty() ? emptyScene() : read());
        SceneSimulationSettings how;
        how.m_meshes.m_scale = m_scale;
        how.m_meshes.m_cage = m_cage.settings();
        how.m_meshes.m_bake.m_material = m_material.material();
        how.m_meshes.m_bake.m_regionMaterials = m_material.regions();
        how.m_meshes.m_bake.m_maxBytes = kMaxFactorBytes;
        how.m_history = {m_historySteps, static_cast<std::size_t>(m_historyMegabytes) << 20u};
        SceneSimulation simulation(world, how);
        for (const std::string& mesh : m_meshes) simulation.open(mesh);
        ViewerSettings settings;
        settings.m_filmFolder = folder();
        settings.m_title = world.description().m_title.empty() ? "BulletFEM" : world.description().m_title;
        settings.m_size = {world.description().m_pictures.m_width, world.description().m_pictures.m_height};
        Viewer(simulation, settings).run();
    }
#else
    void show() const
    {
        throw std::runtime_error(
            "this program was built without a window: install what docs/pictures.md names, and build it anew");
    }
#endif
};

}  // namespace

namespace
{

void addWindowOptions(CLI::App& command, SimulateCommand& options)
{
    CLI::Option* window =
        command.add_flag("--window", options.m_window, "show the scene in a window; writes only films made there");
    const std::size_t others = command.get_options().size();
    CLI::Option* mesh = command.add_option(
        "--mesh", options.m_meshes,
        "in the window: opens a surface (.off, .obj, .stl, .ply), tetrahedra (.msh, .vtk, .vtu, .mesh, .node) or a "
        "baked body (.bfem), as if dropped onto it; may be repeated");
    mesh->take_all()->allow_extra_args(false);
    command.add_option("--scale", options.m_scale, "in the window: factor on the positions of meshes (default 1)")
        ->check(inRange(1e-9, 1e9));
    options.m_cage.add(command);
    options.m_material.add(command);
    command
        .add_option("--history-steps", options.m_historySteps,
                    "in the window: steps between stored states (default 10)")
        ->check(inRange(1, 100000));
    command
        .add_option("--history-memory", options.m_historyMegabytes,
                    "in the window: maximum memory for stored states [MiB]; the oldest are dropped (default 256)")
        ->check(inRange(1, 65536));
    const std::vector<CLI::Option*> all = command.get_options();
    for (std::size_t k = others; k < all.size(); ++k) all[k]->needs(window);
}

}  // namespace

void addSimulateCommand(CLI::App& app)
{
    CLI::App* command =
        app.add_subcommand("simulate",
                           "Runs a scene (docs/scenes.md) and writes the selected outputs; ParaView files if none is "
                           "selected. Reports all\n"
                           "flags that were raised. Or shows the scene in a window, onto which meshes can be dropped.");
    command->footer("Exit code 3 if a body ends inside out or inside another.\n\nThe window:\n\n" + windowHelp());
    const auto options = std::make_shared<SimulateCommand>();
    RunOutputSettings& output = options->m_output;
    command->add_option("scene", options->m_scene, "the scene's .json file; optional with --window");
    command->add_option("-o,--out", output.m_folder, "folder of the files (default out/<scene>)");
    command->add_option("--seconds", options->m_seconds, "time to simulate (default: the scene's)")
        ->check(inRange(1e-6, 1e5));
    command->add_flag("--pvd", output.m_pvd,
                      "elements.pvd and surfaces.pvd for ParaView, with stress and contact forces");
    command->add_flag("--glb", output.m_glb, "run.glb, animated, for web viewers and Blender");
    command->add_flag("--png", output.m_png, "first.png, last.png and strip.png");
    command->add_option("--film", output.m_films, "a film with this name: .mp4 or .gif; may be repeated")
        ->check(
            [](const std::string& name)
            {
                const std::string ending = std::filesystem::path(name).extension().string();
                return ending == ".mp4" || ending == ".gif" ? "" : name + " must end in .mp4 or .gif";
            })
        ->take_all()
        ->allow_extra_args(false);
    command->add_flag("--stress", options->m_stress, "colours show von Mises stress");
    command->add_flag("--quiet", options->m_quiet, "do not show progress");
    addWindowOptions(*command, *options);
    options->m_figures.addOption(*command);
    command->callback([options] { options->run(); });
}

}  // namespace bullet_fem
