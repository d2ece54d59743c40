// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/cage/cage_report.h"
#include "bullet_fem/fem/laws/law_table.h"
#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "io/text/file_bytes.h"
#include "tools/bulletfem/commands.h"
#include "tools/bulletfem/figures.h"
#include "tools/scene/mesh_input.h"
#include "tools/scene/scene_reader.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kMaxLabels = 20;  // listed labels of a surface: photographs have thousands of colours

struct InfoCommand
{
    std::string m_file;
    Figures m_figures;

    void run()
    {
        const std::string ending = lowerCaseEnding(m_file);
        m_figures.add("file", m_file);
        if (ending == ".bfem")
            tellBaked();
        else if (ending == ".json")
            tellScene(readScene(m_file));
        else if (isSurfaceFile(m_file))
            tellSurface(readSurfaceFile(m_file));
        else
            tellMesh(readTetMeshFile(m_file));
        m_figures.print();
    }

    void tellBaked()
    {
        const BakedFileInfo info = inspectBakedBody(m_file);
        m_figures.add("kind", "baked body");
        m_figures.add("version", info.m_version);
        m_figures.add("bytes", info.m_fileBytes);
        m_figures.add("factorBytes", info.m_factorBytes);
        m_figures.add("ordering", info.m_factor.m_ordering, "of " + info.m_factor.m_backend);
        m_figures.add("nodes", info.m_nodes);
        m_figures.add("tets", info.m_tets);
        m_figures.add("pinned", info.m_nodes - info.m_freeNodes, "nodes");
        m_figures.add("embeddedVertices", info.m_embeddedVertices);
        if (info.m_embeddedVertices > 0) m_figures.add("collides", info.m_surfaceCollides ? "surface" : "cage");
        if (info.m_regions == 1 && info.m_material.isOrthotropic()) tellOrthotropic(info.m_material.m_orthotropic);
        if (info.m_regions == 1 && !info.m_material.isOrthotropic())
        {
            m_figures.add("young", info.m_material.m_youngModulus, "Pa");
            m_figures.add("poisson", info.m_material.m_poissonRatio);
        }
        if (info.m_regions == 1) m_figures.add("density", info.m_material.m_density, "kg/m3");
        m_figures.add("massDamping", info.m_material.m_massDamping, "1/s");
        m_figures.add("stiffnessDamping", info.m_material.m_stiffnessDamping, "s");
        if (info.m_regions == 1) tellElement(info.m_material);
        if (info.m_regions == 1 && info.m_material.m_law != ElasticLaw::hooke && !info.m_material.isOrthotropic())
            tellLaw(info.m_material);
        if (info.m_regions == 1 && info.m_material.yields())
            m_figures.add("yieldStress", info.m_material.m_yieldStress, "Pa");
        m_figures.add("step", info.m_step, "s");
        m_figures.add("precision", info.m_singlePrecision ? "single" : "double");
        if (info.m_regions > 1) tellRegions(readBakedBody(m_file));
    }

    void tellElement(Material material)
    {
        if (material.m_bending == Bending::automatic)
            material = readBakedBody(m_file).m_model->shape().chosenMaterials().first();
        m_figures.add("meanDilatation", material.usesMeanDilatation() ? "on" : "off");
        m_figures.add("bending", material.m_bending == Bending::accurate ? "accurate" : "plain");
    }

    void tellLaw(const Material& material)
    {
        m_figures.add("law", nameOf(material.m_law));
        const std::vector<LawConstant>& constants = constantsOf(material.m_law);
        for (std::size_t k = 0; k < constants.size(); ++k)
            m_figures.add(constants[k].m_name, material.m_lawConstants[k], constants[k].m_unit);
    }

    void tellOrthotropic(const Orthotropic& m)
    {
        m_figures.add("law", "orthotropic");
        m_figures.add("young", {m.m_young[0], m.m_young[1], m.m_young[2]}, "Pa, along axes 1, 2, 3");
        m_figures.add("poisson", {m.m_poisson[0], m.m_poisson[1], m.m_poisson[2]}, "12, 13, 23");
        m_figures.add("shear", {m.m_shear[0], m.m_shear[1], m.m_shear[2]}, "Pa, 12, 13, 23");
        const Mat3 axes = m.axes();
        m_figures.add("axis 1", {axes(0, 0), axes(1, 0), axes(2, 0)});
        m_figures.add("axis 2", {axes(0, 1), axes(1, 1), axes(2, 1)});
    }

    // With a field of directions each element is a region.
    static constexpr std::size_t kMaxRegions = 20;

    // Volumes are those that elements fill.
    void tellRegions(const BakedBody& body)
    {
        const RestShape& shape = body.m_model->shape();
        if (shape.isOrthotropic() && shape.m_materials.m_regions.size() > kMaxRegions)
        {
            m_figures.add("law", "orthotropic");
            m_figures.add("regions", shape.m_materials.m_regions.size());
            return;
        }
        const ElementMaterials materials = shape.chosenMaterials();
        for (std::size_t r = 0; r < materials.m_regions.size(); ++r)
        {
            const auto& [label, material] = materials.m_regions[r];
            int tets = 0;
            double volume = 0;
            for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
                if (materials.regionOf(e) == r)
                {
                    ++tets;
                    volume += shape.m_elements[e].m_volume;
                }
            const double density = material.m_density > 0 ? material.m_density : 1000;  // as baked
            m_figures.add("region " + std::to_string(label),
                          {{"tets", tets},
                           {"volume", volume},
                           {"young", youngOf(material)},
                           {"poisson", poissonOf(material)},
                           {"density", material.m_density},
                           {"mass", density * body.m_massScale * volume},
                           {"meanDilatation", material.usesMeanDilatation() ? "on" : "off"}},
                          "m3, Pa, kg/m3, kg");
        }
    }

    static nlohmann::json youngOf(const Material& material)
    {
        return material.isOrthotropic() ? nlohmann::json(material.m_orthotropic.m_young)
                                        : nlohmann::json(material.m_youngModulus);
    }

    static nlohmann::json poissonOf(const Material& material)
    {
        return material.isOrthotropic() ? nlohmann::json(material.m_orthotropic.m_poisson)
                                        : nlohmann::json(material.m_poissonRatio);
    }

    void tellLabels(const TetMesh& mesh, const std::vector<int>& labels)
    {
        std::map<int, std::pair<int, double>> regions;  // elements and volume by label
        for (int e = 0; e < mesh.tetCount() && !labels.empty(); ++e)
        {
            ++regions[labels[e]].first;
            regions[labels[e]].second += mesh.tetVolume(e);
        }
        for (const auto& [label, found] : regions)
            m_figures.add("region " + std::to_string(label), {{"tets", found.first}, {"volume", found.second}}, "m3");
    }

    void tellScene(const SceneDescription& scene)
    {
        m_figures.add("kind", "scene");
        m_figures.add("title", scene.m_title);
        m_figures.add("step", scene.m_step, "s");
        m_figures.add("seconds", scene.m_seconds, "s");
        m_figures.add("softBodies", scene.m_softBodies.size());
        m_figures.add("rigidBodies", scene.m_rigidBodies.size());
        m_figures.add("constraints", scene.m_constraints.size());
        m_figures.add("welds", scene.m_welds.size());
        m_figures.add("forces", scene.m_forces.size());
        m_figures.add("springs", scene.m_springs.size());
        m_figures.add("actuators", scene.m_actuators.size());
    }

    void tellSurface(const SurfaceMesh& surface)
    {
        m_figures.add("kind", "surface");
        m_figures.add("vertices", surface.m_vertices.size());
        m_figures.add("triangles", surface.m_triangles.size());
        m_figures.add("signedVolume", signedVolume(surface), "m3, negative if inside out");
        const std::set<int> labels(surface.m_labels.begin(), surface.m_labels.end());
        m_figures.add("painted", labels.size(), "regions");
        if (labels.size() <= kMaxLabels)
            for (const int label : labels)
                m_figures.add("region " + std::to_string(label),
                              {{"vertices", std::count(surface.m_labels.begin(), surface.m_labels.end(), label)}});
        tellBounds(surface.m_vertices);
    }

    void tellMesh(const TetMeshFile& file)
    {
        const TetMesh mesh = file.mesh();
        double least = 1;
        for (const Tet& t : mesh.tets())
        {
            const std::vector<Vec3>& x = mesh.restPositions();
            least = std::min(least, meanRatio({x[t[0]], x[t[1]], x[t[2]], x[t[3]]}));
        }
        m_figures.add("kind", "tetrahedra");
        m_figures.add("format", file.m_format + " " + file.m_version);
        for (std::size_t i = 0; i < file.m_notes.size(); ++i)
            m_figures.add(i == 0 ? "note" : "note " + std::to_string(i + 1), file.m_notes[i]);
        m_figures.add("nodes", mesh.nodeCount());
        m_figures.add("tets", mesh.tetCount());
        m_figures.add("pieces", mesh.componentCount());
        m_figures.add("turned", mesh.turnedCount(), "tetrahedra of negative orientation");
        m_figures.add("unusedNodes", file.m_unusedNodes);
        m_figures.add("skippedFaces", file.m_skippedFaces);
        m_figures.add("volume", mesh.volume(), "m3");
        m_figures.add("meanEdge", mesh.meanEdgeLength(), "m");
        m_figures.add("leastQuality", least, "mean ratio, 1 is a regular tetrahedron");
        tellBounds(mesh.restPositions());
        tellLabels(mesh, file.m_regions);
    }

    void tellBounds(const std::vector<Vec3>& positions)
    {
        constexpr double inf = std::numeric_limits<double>::infinity();
        Vec3 low{inf, inf, inf}, high{-inf, -inf, -inf};
        for (const Vec3& x : positions)
            for (int c = 0; c < 3; ++c)
            {
                low[c] = std::min(low[c], x[c]);
                high[c] = std::max(high[c], x[c]);
            }
        m_figures.add("low", {low.x, low.y, low.z}, "m");
        m_figures.add("high", {high.x, high.y, high.z}, "m");
    }
};

}  // namespace

void addInfoCommand(CLI::App& app)
{
    CLI::App* command =
        app.add_subcommand("info", "Describes a file: tetrahedra, a surface, a baked body (.bfem) or a scene (.json).");
    const auto options = std::make_shared<InfoCommand>();
    command->add_option("file", options->m_file, "the file")->required();
    options->m_figures.addOption(*command);
    command->callback([options] { options->run(); });
}

}  // namespace bullet_fem
