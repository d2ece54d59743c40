// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/surface_writer.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "bullet_fem/io/tet_mesh_writer.h"
#include "fem/common/output_file.h"
#include "io/text/file_bytes.h"
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
        const Solid solid = readSolid();
        writeTetMeshFile(m_output, solid.m_mesh, solid.m_regions);
    }

    struct Solid
    {
        TetMesh m_mesh;
        std::vector<int> m_regions;  // labels of the elements; may be empty
    };

    Solid readSolid() const
    {
        if (lowerCaseEnding(m_input) == ".bfem") return readBaked();
        TetMeshFile file = readTetMeshFile(m_input, m_scale);
        for (const std::string& note : file.m_notes) std::fprintf(stderr, "%s: %s\n", m_input.c_str(), note.c_str());
        return {file.mesh(), std::move(file.m_regions)};
    }

    Solid readBaked() const
    {
        const BakedBody baked = readBakedBody(m_input);
        std::vector<Vec3> positions = baked.m_positions;
        for (Vec3& x : positions) x *= m_scale;
        Solid solid{TetMesh(positions, baked.m_model->mesh().tets(), LooseNodes::kept), {}};
        const auto& materials = baked.m_model->shape().m_materials;
        for (int e = 0; e < solid.m_mesh.tetCount() && materials.m_regions.size() > 1; ++e)
            solid.m_regions.push_back(materials.m_regions[materials.regionOf(e)].m_label);
        return solid;
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
            const TetMesh solid = readSolid().m_mesh;
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
    CLI::App* command =
        app.add_subcommand("convert",
                           "Rewrites tetrahedra as .msh, .vtk, .vtu, .mesh or .node and .ele; a surface, "
                           "or that of tetrahedra, as .obj or .ply.");
    const auto options = std::make_shared<ConvertCommand>();
    command->add_option("input", options->m_input, "tetrahedra, a surface or a .bfem file")->required();
    command->add_option("output", options->m_output, "the file to write; its extension selects the format")->required();
    command->add_option("--scale", options->m_scale, "factor on the file's positions (default 1)")
        ->check(inRange(1e-9, 1e9));
    command->callback([options] { options->run(); });
}

}  // namespace bullet_fem
