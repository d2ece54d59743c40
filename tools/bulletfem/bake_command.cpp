// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <array>
#include <cstdlib>
#include <memory>

#include "bullet_fem/fem/baked/baked_body.h"
#include "fem/common/output_file.h"
#include "tools/bulletfem/cage_options.h"
#include "tools/bulletfem/commands.h"
#include "tools/bulletfem/figures.h"
#include "tools/bulletfem/material_options.h"
#include "tools/console/option_range.h"
#include "tools/scene/mesh_input.h"

namespace bullet_fem
{
namespace
{

/// A number, or a quotient such as 1/60.
double numberOf(const std::string& text)
{
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (*end != '/') return *end == 0 ? value : std::nan("");
    const double below = std::strtod(end + 1, &end);
    return *end == 0 ? value / below : std::nan("");
}

struct BakeCommand
{
    std::string m_mesh, m_output, m_step = "1/60";
    double m_scale = 1;
    bool m_double = false, m_lowMemory = false;
    std::vector<std::array<double, 6>> m_pinBoxes;  // minimum and maximum corner [m]
    MaterialOptions m_material;
    CageOptions m_cage;
    Figures m_figures;

    void run()
    {
        checkWritable(m_output);
        const MeshInput input = MeshInput::read(m_mesh, m_scale, m_cage.settings());
        const BakeSettings wanted = settings(input);
        const BakedBody body =
            input.m_cage ? bakeBody(*input.m_cage, input.m_surface, wanted) : bakeBody(input.m_mesh, wanted);
        writeBakedBody(m_output, body);
        const BakedFileInfo info = inspectBakedBody(m_output);
        m_figures.add("file", m_output);
        m_figures.add("bytes", info.m_fileBytes);
        m_figures.add("factorBytes", info.m_factorBytes);
        m_figures.add("ordering", info.m_factor.m_ordering, "of " + info.m_factor.m_backend);
        m_figures.add("nodes", info.m_nodes);
        m_figures.add("tets", info.m_tets);
        m_figures.add("pinned", info.m_nodes - info.m_freeNodes, "nodes");
        m_figures.add("factorSeconds", body.m_model->factorReport().m_seconds, "s, which loading saves");
        m_figures.print();
    }

    BakeSettings settings(const MeshInput& input) const
    {
        BakeSettings settings;
        settings.m_material = m_material.material();
        settings.m_regionMaterials = m_material.regions();
        if (!settings.m_regionMaterials.empty()) settings.m_labels = input.m_labels;
        if (!settings.m_regionMaterials.empty() && settings.m_labels.empty())
            throw std::runtime_error("--region is given, and '" + m_mesh +
                                     "' has no regions and is not painted; leave it out");
        settings.m_step = numberOf(m_step);
        settings.m_singlePrecision = !m_double;
        if (m_lowMemory) settings.m_choice = FactorChoice::lowMemory;
        for (const auto& box : m_pinBoxes) pin(input.m_mesh, box, settings.m_pins);
        return settings;
    }

    static void pin(const TetMesh& mesh, const std::array<double, 6>& box, std::vector<int>& pins)
    {
        const std::size_t before = pins.size();
        for (int i = 0; i < mesh.nodeCount(); ++i)
        {
            bool inside = true;
            for (int c = 0; c < 3; ++c)
            {
                const double x = mesh.restPositions()[i][c];
                inside = inside && x >= box[c] && x <= box[c + 3];
            }
            if (inside) pins.push_back(i);
        }
        if (pins.size() == before)
            throw std::runtime_error("a --pin box holds no node; look at the mesh's bounds with info");
    }
};

}  // namespace

void addBakeCommand(CLI::App& app)
{
    CLI::App* command = app.add_subcommand(
        "bake",
        "Writes mesh, material, pins and factor of a body to one .bfem file, which a game loads in milliseconds.");
    const auto options = std::make_shared<BakeCommand>();
    command
        ->add_option("mesh", options->m_mesh,
                     "tetrahedra (.msh, .vtk, .vtu, .mesh, .node) or a surface (.off, .obj, .stl, .ply)")
        ->required();
    command->add_option("-o,--output", options->m_output, "the .bfem file")->required();
    command->add_option("--scale", options->m_scale, "factor on the file's positions (default 1)")
        ->check(inRange(1e-9, 1e9));
    command->add_option("--step", options->m_step, "fixed time step of the game [s], as 0.01 or 1/60 (default 1/60)")
        ->check(
            [](const std::string& text)
            {
                const double step = numberOf(text);
                return step >= 1e-6 && step <= 1 ? "" : "is " + text + ", must be in [1e-6, 1] s, as 0.01 or 1/60";
            });
    command
        ->add_option("--pin", options->m_pinBoxes,
                     "fixes the nodes in a box: x y z of its minimum, then of its maximum corner [m]; may be repeated")
        ->type_name("x y z x y z")
        ->allow_extra_args(false)
        ->check(inRange(-1e6, 1e6));
    command->add_flag("--double", options->m_double, "for Bullet in double precision");
    command->add_flag("--low-memory", options->m_lowMemory,
                      "low-memory factor: about a ninth of the memory, slower steps");
    options->m_material.add(*command);
    options->m_cage.add(*command);
    command->add_flag("--surface-collides", options->m_cage.m_surfaceCollides,
                      "for a surface: the surface collides instead of its cage");
    options->m_figures.addOption(*command);
    command->callback([options] { options->run(); });
}

}  // namespace bullet_fem
