// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Command-line tools for meshes, bodies and scenes.
#include <iostream>

#include "tools/bulletfem/commands.h"
#include "tools/console/option_range.h"
#include "tools/console/program.h"

int main(int argc, char** argv)
{
    using namespace bullet_fem;
    CLI::App app(
        "Makes finite-element bodies of meshes, and runs scenes of them. All lengths are metres, all values SI.\n"
        "Help on a command: bulletfem cage --help\n\n"
        "  bulletfem cage bunny.off --tets 4000 -o bunny.msh          tetrahedra around a surface\n"
        "  bulletfem bake bunny.off --material rubber -o bunny.bfem   a body that loads in milliseconds\n"
        "  bulletfem simulate scene.json --pvd --film run.mp4         a scene, to ParaView and to a film in "
        "out/scene\n\n"
        "Exit code: 0 if all is well, 1 on bad data, 2 on bad usage, 3 if a scene ends with a body inside out "
        "or inside another.");
    app.require_subcommand(0, 1);
    app.set_version_flag("--version", BULLETFEM_VERSION);
    addCageCommand(app);
    addBakeCommand(app);
    addInfoCommand(app);
    addConvertCommand(app);
    addSimulateCommand(app);
    const auto run = [&]
    {
        try
        {
            app.parse(argc, argv);
            if (!app.get_subcommands().empty()) return 0;
            std::cerr << app.help() << "\nA subcommand is required.\n";
            return kUsageError;
        }
        catch (const CLI::RuntimeError& error)  // thrown by a subcommand
        {
            return error.get_exit_code();
        }
        catch (const CLI::ParseError& error)
        {
            return app.exit(error) == 0 ? 0 : kUsageError;
        }
    };
    return runProgram("bulletfem", run);
}
