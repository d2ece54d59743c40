// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemHelpers.h"
#include "python/core/handles.h"
#include "python/core/soft_maker.h"

namespace bullet_fem::python
{
namespace
{

/// Rows of node indices of triangles or elements.
template <class Items, class NodeOf>
py::array_t<int> nodesOf(const btSoftBody& body, const Items& items, int columns, const NodeOf& nodeOf)
{
    py::array_t<int> array(Dims{items.size(), columns});
    int* at = array.mutable_data();
    for (int i = 0; i < items.size(); ++i)
        for (int k = 0; k < columns; ++k) *at++ = int(nodeOf(items[i], k) - &body.m_nodes[0]);
    return array;
}

void setMaterial(const SoftHandle& self, const py::object& material)
{
    SoftEntry& entry = self.changing();
    ElementMaterials materials;
    if (py::isinstance<ElementMaterials>(material))
        materials = material.cast<ElementMaterials>();
    else if (py::isinstance<Material>(material))
        materials.m_base = material.cast<Material>();
    else
        throw py::type_error("material is " + std::string(py::repr(material)) +
                             ": it must be a Material or ElementMaterials");
    setMaterials(self.world(), entry, materials);
}

void unpin(const SoftHandle& self, py::handle nodes)
{
    SoftEntry& entry = self.changing();
    for (const int node : indicesOf(nodes, "nodes", self.nodeCount()))
    {
        if (entry.m_body->m_nodes[node].m_im > 0) continue;
        const auto mass = entry.m_pinned.find(node);
        if (mass == entry.m_pinned.end())
            throw py::value_error("node " + std::to_string(node) +
                                  " was pinned by a scene, which did not keep its mass");
        entry.m_body->setMass(node, mass->second);
        entry.m_pinned.erase(mass);
    }
    entry.m_body->activate(true);
}

void transform(const SoftHandle& self, py::handle position, py::handle orientation)
{
    const btTransform change = transformOf(position, orientation);
    btSoftBody& body = *self.changing().m_body;
    body.transform(change);
    btFemHelpers::updateEmbeddedSurface(&body);
    body.activate(true);
}

void addState(SoftClass& body)
{
    body.def_property_readonly(
            "is_active", [](const SoftHandle& self) { return self.body().isActive(); }, "False while it sleeps.")
        .def(
            "wake", [](const SoftHandle& self) { self.changing().m_body->activate(true); }, "Wakes the body.")
        .def_property_readonly(
            "pins",
            [](const SoftHandle& self)
            {
                std::vector<int> pins;
                for (int i = 0; i < self.nodeCount(); ++i)
                    if (self.body().m_nodes[i].m_im == 0) pins.push_back(i);
                return arrayOf(pins);
            },
            "Nodes that are fixed, int32 (p,).")
        .def(
            "pin",
            [](const SoftHandle& self, py::handle nodes)
            {
                SoftEntry& entry = self.changing();
                setPins(entry, indicesOf(nodes, "nodes", self.nodeCount()));
                entry.m_body->activate(true);
            },
            py::arg("nodes"), "Fixes nodes (p,) at their positions.")
        .def_property_readonly(
            "report",
            [](const SoftHandle& self)
            {
                btFemStepReport report = self.fem().stepReport(&self.body());
                return report;
            },
            "StepReport of the last step, a copy.")
        .def("unpin", &unpin, py::arg("nodes"), "Frees nodes (p,), which get their masses back.")
        .def(
            "refactor", [](const SoftHandle& self) { self.fem().refactor(self.changing().m_body); },
            "Factors anew after pins, masses or steps have changed.")
        .def("transform", &transform, py::arg("position"), py::arg("orientation") = py::make_tuple(0, 0, 0, 1),
             "Moves the body: turns about the world's origin by a quaternion (x, y, z, w), then shifts by (3,) [m].");
}

void addSettings(SoftClass& body)
{
    body.def("set_material", &setMaterial, py::arg("material"), "Sets a Material or ElementMaterials.")
        .def_property(
            "friction", [](const SoftHandle& self) { return self.body().m_cfg.kDF; },
            [](const SoftHandle& self, py::handle value)
            { self.changing().m_body->m_cfg.kDF = btScalar(numberOf(value, "friction", 0, kLargest)); },
            "Coefficient of friction [-], multiplied by the other body's.")
        .def_property(
            "restitution", [](const SoftHandle& self) { return self.body().getRestitution(); },
            [](const SoftHandle& self, py::handle value)
            { self.changing().m_body->setRestitution(btScalar(numberOf(value, "restitution", 0, 1))); },
            "Coefficient of restitution [-], in [0, 1], multiplied by the other body's.")
        .def(
            "set_contact_offset",
            [](const SoftHandle& self, py::handle metres)
            {
                const double offset = numberOf(metres, "metres", 0, 1e3);
                self.fem().setContactOffset(self.changing().m_body, btScalar(offset));
            },
            py::arg("metres"), "Sets the distance that the surface keeps from others [m].")
        .def_property(
            "self_contact",
            [](const SoftHandle& self)
            { return (self.body().m_cfg.collisions & btSoftBody::fCollision::CL_SELF) != 0; },
            [](const SoftHandle& self, bool on)
            {
                int& flags = self.changing().m_body->m_cfg.collisions;
                flags = on ? flags | btSoftBody::fCollision::CL_SELF : flags & ~btSoftBody::fCollision::CL_SELF;
            },
            "Whether parts of the body meet each other.");
}

void addMesh(SoftClass& body)
{
    body.def_property_readonly(
            "node_count", [](const SoftHandle& self) { return self.nodeCount(); }, "Number of nodes n.")
        .def_property_readonly(
            "tet_count", [](const SoftHandle& self) { return self.tetCount(); }, "Number of elements m.")
        .def_property_readonly(
            "tets",
            [](const SoftHandle& self)
            {
                const btSoftBody& soft = self.body();
                return nodesOf(soft, soft.m_tetras, 4, [](const btSoftBody::Tetra& t, int k) { return t.m_n[k]; });
            },
            "Nodes of the elements, int32 (m, 4).")
        .def_property_readonly(
            "faces",
            [](const SoftHandle& self)
            {
                const btSoftBody& soft = self.body();
                return nodesOf(soft, soft.m_faces, 3, [](const btSoftBody::Face& f, int k) { return f.m_n[k]; });
            },
            "Nodes of the boundary triangles, int32 (k, 3), counter-clockwise from outside.")
        .def_property_readonly(
            "mass", [](const SoftHandle& self) { return self.body().getTotalMass(); },
            "Mass of the nodes that are not pinned [kg].")
        .def_property_readonly(
            "aabb",
            [](const SoftHandle& self)
            {
                btVector3 low, high;
                self.body().getAabb(low, high);
                Doubles box(Dims{2, 3});
                for (int i = 0; i < 3; ++i) box.mutable_at(0, i) = low[i], box.mutable_at(1, i) = high[i];
                return box;
            },
            "Lowest and highest corner of a box around the body, (2, 3) [m].");
}

}  // namespace

SoftClass bindSoftBodies(py::module_& module)
{
    SoftClass body(module, "SoftBody", py::module_local(),
                   "A soft body of n nodes and m tetrahedra in a world; made by World.add_soft_body().");
    body.def_readonly("index", &SoftHandle::m_index, "Index of the body in its world, as contacts have it.")
        .def_readonly("world", &SoftHandle::m_world, "The body's world.")
        .def_property_readonly(
            "name", [](const SoftHandle& self) { return self.reading(), self.world().bodies()[self.m_index].m_name; },
            "Name of the body.")
        .def(
            "__eq__", [](const SoftHandle& a, const SoftHandle& b) { return a == b; }, py::is_operator())
        .def("__hash__", [](const SoftHandle& self)
             { return std::hash<const void*>()(self.m_world.get()) ^ std::size_t(self.m_index); })
        .def("__repr__", [](const SoftHandle& self) { return py::str("<SoftBody {}>").format(self.m_index); });
    addMesh(body);
    addState(body);
    addSettings(body);
    return body;
}

}  // namespace bullet_fem::python
