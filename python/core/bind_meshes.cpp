// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <pybind11/stl/filesystem.h>

#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/io/surface_file.h"
#include "python/core/handles.h"
#include "python/core/materials.h"
#include "python/core/mesh.h"

namespace bullet_fem::python
{
namespace
{

using MeshClass = py::class_<Mesh, std::shared_ptr<Mesh>>;
using BakedClass = py::class_<BakedBody, std::shared_ptr<BakedBody>>;

constexpr double kMaxScale = 1e9;

std::array<int, 3> cellsOf(py::handle object)
{
    const std::vector<int> cells = labelsOf(object, "cells");
    if (cells.size() != 3) throw py::value_error("cells has not three values: it must have those along x, y and z");
    return {cells[0], cells[1], cells[2]};
}

Vec3 vec3Of(const btVector3& vector)
{
    return {vector.x(), vector.y(), vector.z()};
}

template <std::size_t Count>
py::array_t<int> rowsOf(const std::vector<std::array<int, Count>>& rows)
{
    py::array_t<int> array(Dims{py::ssize_t(rows.size()), py::ssize_t(Count)});
    std::copy_n(rows.empty() ? nullptr : rows[0].data(), rows.size() * Count, array.mutable_data());
    return array;
}

Mesh meshOf(py::handle positions, py::handle tets)
{
    std::vector<Vec3> places = vectorsOf(positions, "positions");
    const std::vector<int> indices = indexRowsOf(tets, "tets", 4, int(places.size()));
    std::vector<Tet> elements(indices.size() / 4);
    for (std::size_t i = 0; i < indices.size(); ++i) elements[i / 4][i % 4] = indices[i];
    return Mesh::ofTets(TetMesh(std::move(places), std::move(elements)));
}

SurfaceMesh surfaceOf(py::handle vertices, py::handle triangles)
{
    SurfaceMesh surface;
    surface.m_vertices = vectorsOf(vertices, "vertices");
    const std::vector<int> indices = indexRowsOf(triangles, "triangles", 3, int(surface.m_vertices.size()));
    surface.m_triangles.resize(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); ++i) surface.m_triangles[i / 3][i % 3] = indices[i];
    return surface;
}

CageSettings cageSettings(py::handle cellSize, int tets, py::handle cellsAcross, bool surfaceCollides)
{
    CageSettings settings;
    if (!cellSize.is_none()) settings.m_cellSize = numberOf(cellSize, "cell_size", 0, kLargest);
    settings.m_targetTets = tets;
    settings.m_cellsAcross = numberOf(cellsAcross, "cells_across", 0, 8);
    settings.m_surfaceCollides = surfaceCollides;
    return settings;
}

void bindGenerators(MeshClass& mesh)
{
    mesh.def_static(
            "box",
            [](py::handle size, py::handle cells, py::handle origin) {
                return Mesh::ofTets(
                    makeBox(vec3Of(vectorOf(size, "size")), cellsOf(cells), vec3Of(vectorOf(origin, "origin"))));
            },
            py::arg("size"), py::arg("cells"), py::arg("origin") = py::make_tuple(0, 0, 0),
            "A box of `size` (3,) [m] with `cells` (3,) along x, y, z, each of five elements, and its lowest corner "
            "at\n"
            "`origin` (3,) [m].")
        .def_static(
            "sphere",
            [](py::handle radius, int cells)
            { return Mesh::ofTets(makeSphere(numberOf(radius, "radius", 0, kLargest), cells)); },
            py::arg("radius"), py::arg("cells"),
            "A ball of `radius` [m] around the origin, `cells` along its diameter.")
        .def_static(
            "cylinder",
            [](py::handle radius, py::handle height, int cells, int layers)
            {
                return Mesh::ofTets(makeCylinder(numberOf(radius, "radius", 0, kLargest),
                                                 numberOf(height, "height", 0, kLargest), cells, layers));
            },
            py::arg("radius"), py::arg("height"), py::arg("cells"), py::arg("layers"),
            "A cylinder about the z axis, around the origin [m]: `cells` (even) across, `layers` along.")
        .def_static(
            "read",
            [](const std::filesystem::path& path, py::handle scale)
            { return Mesh::ofFile(path.string(), numberOf(scale, "scale", 0, kMaxScale)); },
            py::arg("path"), py::arg("scale") = 1,
            "The tetrahedra of a Gmsh, TetGen, VTK or Medit file, with its regions; `scale` [-] multiplies positions.");
}

void bindCages(MeshClass& mesh)
{
    mesh.def_static(
            "cage",
            [](py::handle vertices, py::handle triangles, py::handle cellSize, int tets, py::handle cellsAcross,
               bool surfaceCollides) {
                return Mesh::ofSurface(surfaceOf(vertices, triangles),
                                       cageSettings(cellSize, tets, cellsAcross, surfaceCollides));
            },
            py::arg("vertices"), py::arg("triangles"), py::kw_only(), py::arg("cell_size") = py::none(),
            py::arg("tets") = 0, py::arg("cells_across") = 0, py::arg("surface_collides") = false,
            "The inside of a surface of vertices (n, 3) [m] and triangles (k, 3), by cells of `cell_size` [m] or "
            "about\n"
            "`tets` elements; `cells_across` [-] in thin parts. The surface may be open or intersect itself.")
        .def_static(
            "read_surface",
            [](const std::filesystem::path& path, py::handle scale, py::handle cellSize, int tets,
               py::handle cellsAcross, bool surfaceCollides)
            {
                return Mesh::ofSurface(readSurfaceFile(path.string(), numberOf(scale, "scale", 0, kMaxScale)),
                                       cageSettings(cellSize, tets, cellsAcross, surfaceCollides));
            },
            py::arg("path"), py::arg("scale") = 1, py::kw_only(), py::arg("cell_size") = py::none(),
            py::arg("tets") = 0, py::arg("cells_across") = 0, py::arg("surface_collides") = false,
            "As cage(), of the surface of an OFF, OBJ, STL or PLY file; `scale` [-] multiplies positions.");
}

BakedBody bake(const Mesh& mesh, const ElementMaterials& materials, py::handle step, py::handle pins)
{
    if (!materials.isOne() && materials.m_labels.empty())
        throw py::value_error("materials differ between elements by arrays: baking takes a Material, or of_regions()");
    BakeSettings settings;
    settings.m_material = materials.m_base;
    settings.m_labels = materials.m_labels;
    settings.m_regionMaterials = materials.m_ofLabel;
    settings.m_step = numberOf(step, "step", 1e-6, 1);
    settings.m_pins = indicesOf(pins, "pins", mesh.m_tets.nodeCount());
    settings.m_singlePrecision = false;
    return mesh.m_cage ? bakeBody(*mesh.m_cage, mesh.m_surface, settings) : bakeBody(mesh.m_tets, settings);
}

void bindBaked(py::module_& module)
{
    BakedClass baked(module, "BakedBody", py::module_local(),
                     "A body with its material, pins and factor, which needs no factoring when it is added.");
    const char* text = "Bakes a mesh with a material for worlds of this step [s]; pins (p,) are fixed nodes.";
    baked
        .def_static(
            "bake",
            [](const Mesh& mesh, const Material& material, py::handle step, py::handle pins)
            {
                ElementMaterials materials;
                materials.m_base = material;
                return bake(mesh, materials, step, pins);
            },
            py::arg("mesh"), py::arg("material"), py::kw_only(), py::arg("step") = 1.0 / 60,
            py::arg("pins") = py::make_tuple(), text)
        .def_static("bake", &bake, py::arg("mesh"), py::arg("material"), py::kw_only(), py::arg("step") = 1.0 / 60,
                    py::arg("pins") = py::make_tuple(), text)
        .def_static(
            "read", [](const std::filesystem::path& path) { return readBakedBody(path.string()); }, py::arg("path"),
            "Reads a .bfem file. The factor stays in the file, which must not be changed meanwhile.")
        .def(
            "write",
            [](const BakedBody& self, const std::filesystem::path& path) { writeBakedBody(path.string(), self); },
            py::arg("path"), "Writes a .bfem file.")
        .def_property_readonly(
            "node_count", [](const BakedBody& self) { return self.m_positions.size(); }, "Number of nodes n.")
        .def_property_readonly(
            "tet_count", [](const BakedBody& self) { return self.m_model->mesh().tetCount(); },
            "Number of elements m.");
}

}  // namespace

void bindMeshes(py::module_& module)
{
    MeshClass mesh(module, "Mesh", py::module_local(), "An immutable mesh of n nodes and m tetrahedra.");
    mesh.def(py::init(&meshOf), py::arg("positions"), py::arg("tets"),
             "Positions (n, 3) [m] and node indices of the tetrahedra, integers (m, 4).");
    bindGenerators(mesh);
    bindCages(mesh);
    mesh.def_property_readonly(
            "positions", [](const Mesh& self) { return arrayOf(self.m_tets.restPositions()); }, "Nodes, (n, 3) [m].")
        .def_property_readonly(
            "tets", [](const Mesh& self) { return rowsOf(self.m_tets.tets()); }, "Node indices, int32 (m, 4).")
        .def_property_readonly(
            "surface", [](const Mesh& self) { return rowsOf(self.m_tets.surface()); },
            "Boundary triangles, int32 (k, 3), counter-clockwise from outside.")
        .def_property_readonly(
            "regions", [](const Mesh& self) { return arrayOf(self.m_regions); },
            "Label of each element, int32 (m,); of length 0 if the file has none.")
        .def_property_readonly(
            "volume", [](const Mesh& self) { return self.m_tets.volume(); }, "Volume of the elements [m3].")
        .def_property_readonly(
            "is_cage", [](const Mesh& self) { return self.m_cage != nullptr; }, "Made of a surface.")
        .def("__repr__", [](const Mesh& self)
             { return py::str("<Mesh: {} nodes, {} tets>").format(self.m_tets.nodeCount(), self.m_tets.tetCount()); });
    bindBaked(module);
}

}  // namespace bullet_fem::python
