// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <memory>
#include <stdexcept>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/surface_writer.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "bullet_fem/io/tet_mesh_writer.h"
#include "fem/common/output_file.h"
#include "io/file_bytes.h"
#include "tools/bulletfem/commands.h"
#include "tools/console/option_range.h"
#include "tools/scene/mesh_input.h"

namespace bullet_fem
{
namespace
{

struct ConvertCommand
{
    std::string m_input, m_output;
    double m_scale = 1;

    void run() const
    {
        if (isSurfaceFile(m_output)) return writeSurface();
        if (isSurfaceFile(m_input))
            throw std::runtime_error("'" + m_input + "' is a surface, '" + m_output +
                                     "' is for tetrahedra: bulletfem cage makes them");
        checkTetMeshOutput(m_output);
        writeTetMeshFile(m_output, mesh());
    }

    TetMesh mesh() const
    {
        if (lowerCaseEnding(m_input) != ".bfem") return readTetMeshFile(m_input, m_scale).mesh();
        const BakedBody baked = readBakedBody(m_input);
        std::vector<Vec3> positions = baked.m_positions;
        for (Vec3& x : positions) x *= m_scale;
        return TetMesh(positions, baked.m_model->mesh().tets(), LooseNodes::kept);
    }

    void writeSurface() const
    {
        const std::string ending = lowerCaseEnding(m_output);
        if (ending != ".obj" && ending != ".ply")
            throw std::runtime_error("cannot write '" + m_output + "': surfaces are written as .obj or .ply");
        checkWritable(m_output);
        BodyFrame frame;
        if (isSurfaceFile(m_input))
        {
            SurfaceMesh surface = readSurfaceFile(m_input, m_scale);
            frame.m_positions = std::move(surface.m_vertices);
            frame.m_triangles = std::move(surface.m_triangles);
        }
        else
        {
            const TetMesh solid = mesh();
            frame.m_positions = solid.restPositions();
            frame.m_triangles = solid.surface();
        }
        if (ending == ".obj")
            writeObj(m_output, {frame});
        else
            writePly(m_output, {frame});
    }
};

}  // namespace

void addConvertCommand(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("convert",
                                           "Rewrites tetrahedra as .msh, .vtk, .mesh or .node and .ele; a surface, or "
                                           "that of tetrahedra, as .obj or .ply.");
    const auto options = std::make_shared<ConvertCommand>();
    command->add_option("input", options->m_input, "tetrahedra, a surface or a .bfem file")->required();
    command->add_option("output", options->m_output, "the file to write; its ending says how")->required();
    command->add_option("--scale", options->m_scale, "times the file's positions (default 1)")
        ->check(inRange(1e-9, 1e9));
    command->callback([options] { options->run(); });
}

}  // namespace bullet_fem
