// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <memory>

#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/tet_mesh_writer.h"
#include "tools/bulletfem/cage_options.h"
#include "tools/bulletfem/commands.h"
#include "tools/bulletfem/figures.h"
#include "tools/console/option_range.h"
#include "tools/scene/mesh_input.h"

namespace bullet_fem
{
namespace
{

struct CageCommand
{
    std::string m_surface, m_output;
    double m_scale = 1;
    CageOptions m_cage;
    Figures m_figures;

    void run()
    {
        if (!isSurfaceFile(m_surface))
            throw std::runtime_error("'" + m_surface + "' is no surface file; it must end in .off, .obj, .stl or .ply");
        if (!m_output.empty()) checkTetMeshOutput(m_output);
        const MeshInput input = MeshInput::read(m_surface, m_scale, m_cage.settings());
        if (!m_output.empty()) writeTetMeshFile(m_output, input.m_mesh);
        tell(input.m_cage->m_report);
        m_figures.print();
    }

    void tell(const CageReport& report)
    {
        m_figures.add("tets", report.m_tets);
        m_figures.add("nodes", report.m_nodes);
        m_figures.add("cell", report.m_cellSize, "m");
        if (m_cage.m_cellsAcross > 0) tellGrading(report);
        m_figures.add("leastQuality", report.m_leastQuality, "mean ratio, 1 is a regular tetrahedron");
        m_figures.add("qualityBound", report.m_qualityBound);
        m_figures.add("qualityHistogram", report.m_qualityHistogram, "tetrahedra in tenths from 0 to 1");
        m_figures.add("volume", report.m_surfaceVolume, "m3, of the solid");
        m_figures.add("volumeIsExact", report.m_volumeIsExact);
        m_figures.add("volumeRatio", report.m_volumeRatio, "cage over solid");
        m_figures.add("pieces", report.m_pieces);
        m_figures.add("insideOut", report.m_insideOut);
        m_figures.add("selfIntersecting", report.m_selfIntersecting);
        m_figures.add("openEdges", report.m_openEdges);
        m_figures.add("duplicates", report.m_duplicates, "triangles left out");
        m_figures.add("degenerate", report.m_degenerate, "triangles without area");
        m_figures.add("turned", report.m_turned, "triangles turned over");
    }

    void tellGrading(const CageReport& report)
    {
        m_figures.add("smallestCell", report.m_smallestCell, "m");
        m_figures.add("largestCell", report.m_largestCell, "m");
        m_figures.add("cellsAcross", report.m_cellsAcross,
                      "wanted in thin parts; fewer than asked for if --tets is low");
        m_figures.add("levels", report.m_levels, "halvings of cells");
        m_figures.add("levelTets", report.m_levelTets, "tetrahedra by halvings from 0 to 6");
    }
};

}  // namespace

void addCageCommand(CLI::App& app)
{
    CLI::App* command = app.add_subcommand(
        "cage",
        "Fills a surface with tetrahedra; it may be self-intersecting, inside out, of several parts or slightly "
        "open.\nThe tetrahedra extend up to a cell beyond it. Prints properties of the mesh and defects of the "
        "surface.");
    const auto options = std::make_shared<CageCommand>();
    command->add_option("surface", options->m_surface, "OFF, OBJ, STL or PLY file")->required();
    command->add_option("-o,--output", options->m_output, "mesh file: .msh, .vtk, .vtu, .mesh, or .node and .ele");
    command->add_option("--scale", options->m_scale, "factor on the file's positions (default 1)")
        ->check(inRange(1e-9, 1e9));
    options->m_cage.add(*command);
    options->m_figures.addOption(*command);
    command->callback([options] { options->run(); });
}

}  // namespace bullet_fem
