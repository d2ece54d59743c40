// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemHelpers.h"
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

using Node = btSoftBody::Node;

/// Keeps the world of an array that shares the memory of a body's nodes, and counts it.
struct NodeView
{
    WorldPointer m_world;
    SoftEntry& m_entry;

    NodeView(WorldPointer world, SoftEntry& entry) : m_world(std::move(world)), m_entry(entry) { ++m_entry.m_views; }
    ~NodeView() { --m_entry.m_views; }
};

void deleteView(PyObject* capsule)
{
    delete static_cast<NodeView*>(PyCapsule_GetPointer(capsule, nullptr));
}

template <btVector3 Node::*Member>
py::array viewOf(const SoftHandle& self)
{
    SoftEntry& entry = self.changing();
    if (entry.m_mayBreak)
        throw py::value_error(
            "the body has a strength, and its nodes move in memory when it splits: a view is refused, "
            "take a copy");
    const py::capsule owner(new NodeView(self.m_world, entry), nullptr, &deleteView);
    btSoftBody& body = *entry.m_body;
    btVector3& first = body.m_nodes[0].*Member;
    return py::array(py::dtype::of<double>(), Dims{body.m_nodes.size(), 3}, Dims{sizeof(Node), sizeof(double)},
                     &first[0], owner);
}

template <btVector3 Node::*Member>
Doubles copyOf(const SoftHandle& self, py::handle out)
{
    const btSoftBody& body = self.body();
    const int count = body.m_nodes.size();
    Doubles array = arrayToFill(out, {count, 3});
    double* at = array.mutable_data();
    for (int i = 0; i < count; ++i, at += 3)
    {
        const btVector3& value = body.m_nodes[i].*Member;
        at[0] = value[0], at[1] = value[1], at[2] = value[2];
    }
    return array;
}

template <btVector3 Node::*Member>
void write(const SoftHandle& self, py::handle values, const char* name)
{
    btSoftBody& body = *self.changing().m_body;
    const std::vector<Vec3> vectors = vectorsOf(values, name, body.m_nodes.size());
    for (int i = 0; i < body.m_nodes.size(); ++i)
        body.m_nodes[i].*Member =
            btVector3(vectors[std::size_t(i)].x, vectors[std::size_t(i)].y, vectors[std::size_t(i)].z);
    body.activate(true);
}

void addForces(const SoftHandle& self, py::handle forces)
{
    btSoftBody& body = *self.changing().m_body;
    const std::vector<Vec3> values = vectorsOf(forces, "forces", body.m_nodes.size(), 1e15);
    for (int i = 0; i < body.m_nodes.size(); ++i)
        body.m_nodes[i].m_f += btVector3(values[std::size_t(i)].x, values[std::size_t(i)].y, values[std::size_t(i)].z);
    body.activate(true);
}

Doubles massesOf(const SoftHandle& self)
{
    const btSoftBody& body = self.body();
    Doubles array(body.m_nodes.size());
    for (int i = 0; i < body.m_nodes.size(); ++i) array.mutable_at(i) = body.getMass(i);
    return array;
}

Doubles embeddedPositions(const SoftHandle& self, py::handle out)
{
    const btSoftBody& body = self.body();
    Doubles array = arrayToFill(out, {body.m_renderNodes.size(), 3});
    double* at = array.mutable_data();
    for (int i = 0; i < body.m_renderNodes.size(); ++i)
        for (int k = 0; k < 3; ++k) *at++ = body.m_renderNodes[i].m_x[k];
    return array;
}

py::array_t<int> embeddedTriangles(const SoftHandle& self)
{
    const btSoftBody& body = self.body();
    py::array_t<int> array(Dims{body.m_renderFaces.size(), 3});
    int* at = array.mutable_data();
    for (int i = 0; i < body.m_renderFaces.size(); ++i)
        for (const btSoftBody::RenderNode* node : body.m_renderFaces[i].m_n) *at++ = int(node - &body.m_renderNodes[0]);
    return array;
}

}  // namespace

void bindNodes(SoftClass& body)
{
    body.def_property(
            "positions", [](const SoftHandle& self) { return copyOf<&Node::m_x>(self, py::none()); },
            [](const SoftHandle& self, py::handle values) { write<&Node::m_x>(self, values, "positions"); },
            "Positions of the nodes, a copy, float64 (n, 3) [m]. Setting them moves the nodes.")
        .def("get_positions", &copyOf<&Node::m_x>, py::arg("out") = py::none(),
             "Positions of the nodes (n, 3) [m], in `out` if it is given.")
        .def_property_readonly(
            "positions_view", &viewOf<&Node::m_x>,
            "Positions of the nodes (n, 3) [m] in Bullet's own memory, writable. While such an array\n"
            "exists, the body cannot be removed, cut or given a strength.")
        .def_property(
            "velocities", [](const SoftHandle& self) { return copyOf<&Node::m_v>(self, py::none()); },
            [](const SoftHandle& self, py::handle values) { write<&Node::m_v>(self, values, "velocities"); },
            "Velocities of the nodes, a copy, float64 (n, 3) [m/s]. Setting them changes the motion.")
        .def("get_velocities", &copyOf<&Node::m_v>, py::arg("out") = py::none(),
             "Velocities of the nodes (n, 3) [m/s], in `out` if it is given.")
        .def_property_readonly("velocities_view", &viewOf<&Node::m_v>,
                               "Velocities of the nodes (n, 3) [m/s] in Bullet's own memory, as positions_view.")
        .def_property_readonly("masses", &massesOf, "Masses of the nodes (n,) [kg]; 0 for pinned ones.")
        .def("add_forces", &addForces, py::arg("forces"), "Adds forces (n, 3) [N] on the nodes for the next step.")
        .def("get_embedded_positions", &embeddedPositions, py::arg("out") = py::none(),
             "Vertices of the surface in a cage (v, 3) [m], in `out` if it is given; v is 0 without a cage.")
        .def_property_readonly("embedded_triangles", &embeddedTriangles, "Triangles of that surface, int32 (k, 3).");
}

}  // namespace bullet_fem::python
