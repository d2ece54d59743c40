// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/drop_options.h"

#include "tools/console/option_range.h"

namespace bullet_fem
{

std::optional<int> parseOptions(int argc, char** argv, DropOptions& options)
{
    CLI::App app(
        "Drops a finite-element body, made from a closed surface mesh, and rigid boxes on a tilted box and a plane.\n"
        "Writes ParaView series (body.pvd, rigid.pvd) and prints measurements. y is up.\n"
        "Exit code: 1 on a bad file or surface, 2 on a bad option, 3 if a check at the end of the table failed.");
    app.option_defaults()->take_last()->always_capture_default(false);
    app.add_option("--mesh", options.m_meshFile, "closed surface: OFF, OBJ, STL or PLY file")->required();
    app.add_option("--out", options.m_outputFolder, "folder of the series (default out/drop)");
    app.add_option("--scale", options.m_scale, "factor on the file's positions (default: the longest side becomes 1 m)")
        ->check(inRange(1e-9, 1e9));
    app.add_option("--cell", options.m_cellSize,
                   "edge of the cage's cells [m] after scaling (default: for about 5000 tets)")
        ->check(inRange(1e-6, 1e3));
    app.add_option("--young", options.m_youngModulus, "Young's modulus [Pa] (default 1e6)")->check(inRange(1, 1e13));
    app.add_option("--poisson", options.m_poissonRatio, "Poisson's ratio [-] (default 0.4)")->check(inRange(0, 0.499));
    app.add_option("--density", options.m_density, "density [kg/m3] (default 1000)")->check(inRange(1, 1e6));
    app.add_option("--seconds", options.m_seconds, "time to simulate [s] (default 4)")->check(inRange(1e-4, 3600));
    app.add_option("--step", options.m_step, "time step [s] (default 1/60)")->check(inRange(1e-4, 0.1));
    app.add_option("--frames-per-second", options.m_framesPerSecond, "frames written per simulated second (default 30)")
        ->check(inRange(0.01, 1e4));
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

}  // namespace bullet_fem
