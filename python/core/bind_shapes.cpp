// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

double lengthOf(py::handle object, const char* name)
{
    return numberOf(object, name, 1e-9, kLargest);
}

RigidShape boxOf(py::handle size)
{
    SceneShape shape;
    const btVector3 edges = vectorOf(size, "size");
    for (int i = 0; i < 3; ++i)
        if (!(edges[i] > 0)) throw py::value_error("size has an edge that is not > 0");
    shape.m_size = {edges.x(), edges.y(), edges.z()};
    return RigidShape::primitive(shape);
}

RigidShape roundOf(SceneShape::Kind kind, py::handle radius, py::handle height)
{
    SceneShape shape;
    shape.m_kind = kind;
    shape.m_radius = lengthOf(radius, "radius");
    if (!height.is_none()) shape.m_height = lengthOf(height, "height");
    return RigidShape::primitive(shape);
}

RigidShape planeOf(py::handle normal)
{
    SceneShape shape;
    shape.m_kind = SceneShape::Kind::plane;
    const btVector3 direction = directionOf(normal, "normal");
    shape.m_size = {direction.x(), direction.y(), direction.z()};
    return RigidShape::primitive(shape);
}

RigidShape meshOf(py::handle vertices, py::handle triangles)
{
    SurfaceMesh surface;
    surface.m_vertices = vectorsOf(vertices, "vertices");
    const std::vector<int> indices = indexRowsOf(triangles, "triangles", 3, int(surface.m_vertices.size()));
    surface.m_triangles.resize(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); ++i) surface.m_triangles[i / 3][i % 3] = indices[i];
    return RigidShape::mesh(std::move(surface));
}

RigidShape compoundOf(const py::iterable& parts)
{
    std::vector<RigidShape::Part> all;
    for (const py::handle part : parts)
    {
        const auto values = py::reinterpret_borrow<py::sequence>(part);
        if (!PySequence_Check(part.ptr()) || py::len(part) != 3 || !py::isinstance<RigidShape>(values[0]))
            throw py::type_error("parts has " + std::string(py::repr(part)) +
                                 ": each must be a tuple (Shape, position, orientation)");
        all.push_back({values[0].cast<std::shared_ptr<RigidShape>>(), transformOf(values[1], values[2])});
    }
    return RigidShape::compound(std::move(all));
}

}  // namespace

void bindShapes(py::module_& module)
{
    py::class_<RigidShape, std::shared_ptr<RigidShape>>(module, "Shape", py::module_local(),
                                                        "A shape of rigid bodies around their origin.")
        .def_static("box", &boxOf, py::arg("size"), "A box with edges of `size` (3,) [m].")
        .def_static(
            "sphere", [](py::handle radius) { return roundOf(SceneShape::Kind::sphere, radius, py::none()); },
            py::arg("radius"), "A ball of `radius` [m].")
        .def_static(
            "cylinder",
            [](py::handle radius, py::handle height) { return roundOf(SceneShape::Kind::cylinder, radius, height); },
            py::arg("radius"), py::arg("height"), "A cylinder about y of `radius` and `height` [m].")
        .def_static(
            "capsule",
            [](py::handle radius, py::handle height) { return roundOf(SceneShape::Kind::capsule, radius, height); },
            py::arg("radius"), py::arg("height"),
            "A capsule about y of `radius`, with `height` between the centres of its caps [m].")
        .def_static("plane", &planeOf, py::arg("normal") = py::make_tuple(0, 1, 0),
                    "The half space below a plane through the body's origin; only for bodies of mass 0.")
        .def_static(
            "hull", [](py::handle points) { return RigidShape::hull(vectorsOf(points, "points")); }, py::arg("points"),
            "The convex hull of `points` (n, 3) [m].")
        .def_static("mesh", &meshOf, py::arg("vertices"), py::arg("triangles"),
                    "A surface of vertices (n, 3) [m] and triangles (k, 3); only for bodies of mass 0.")
        .def_static("compound", &compoundOf, py::arg("parts"),
                    "Parts, each a tuple of a Shape, its position (3,) [m] and its orientation (4,).");
}

}  // namespace bullet_fem::python
