// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

/// A contact as a row of a structured array.
struct ContactRow
{
    int body, other;
    double point[3], normal[3], gap, impulse[3], normal_impulse, friction_impulse[3];
    int part, triangle, node_count, nodes[btFemContact::kMaxNodes];
    double weights[btFemContact::kMaxNodes];
};

struct TouchRow
{
    int body, other, state, points;
    double impulse[3], normal_impulse;
};

void copy(const btVector3& from, double (&to)[3])
{
    for (int i = 0; i < 3; ++i) to[i] = from[i];
}

ContactRow rowOf(const World& world, int body, const btFemContact& contact)
{
    ContactRow row{};
    row.body = body;
    row.other = world.bodies().indexOf(contact.m_other);
    copy(contact.m_point, row.point);
    copy(contact.m_normal, row.normal);
    row.gap = contact.m_gap;
    copy(contact.m_impulse, row.impulse);
    row.normal_impulse = contact.m_normalImpulse;
    copy(contact.m_frictionImpulse, row.friction_impulse);
    row.part = contact.m_part;
    row.triangle = contact.m_index;
    row.node_count = contact.m_nodeCount;
    std::copy_n(contact.m_nodes, contact.m_nodeCount, row.nodes);
    std::copy_n(contact.m_weights, contact.m_nodeCount, row.weights);
    return row;
}

void appendContacts(World& world, int body, std::vector<ContactRow>& rows)
{
    const auto& contacts = world.fem().contacts(world.bodies().soft(body).m_body);
    for (int i = 0; i < contacts.size(); ++i) rows.push_back(rowOf(world, body, contacts[i]));
}

void appendTouches(World& world, int body, std::vector<TouchRow>& rows)
{
    const auto& touches = world.fem().touches(world.bodies().soft(body).m_body);
    for (int i = 0; i < touches.size(); ++i)
    {
        TouchRow row{body, world.bodies().indexOf(touches[i].m_other), int(touches[i].m_state), touches[i].m_points, {},
                     0};
        copy(touches[i].m_impulse, row.impulse);
        row.normal_impulse = touches[i].m_normalImpulse;
        rows.push_back(row);
    }
}

template <class Row>
py::array_t<Row> rowsOf(const std::vector<Row>& rows)
{
    return py::array_t<Row>(py::ssize_t(rows.size()), rows.data());
}

template <class Row>
py::array_t<Row> ofBody(const SoftHandle& self, void (*append)(World&, int, std::vector<Row>&))
{
    self.reading();
    std::vector<Row> rows;
    append(self.world(), self.m_index, rows);
    return rowsOf(rows);
}

template <class Row>
py::array_t<Row> ofWorld(World& world, void (*append)(World&, int, std::vector<Row>&))
{
    world.guard().reading();
    std::vector<Row> rows;
    for (int i = 0; i < world.bodies().size(); ++i)
        if (world.bodies()[i].m_soft) append(world, i, rows);
    return rowsOf(rows);
}

template <class Other>
Doubles forceOf(const SoftHandle& self, const Other& other)
{
    self.mustShareWorld(other, "other");
    return arrayOf(self.fem().contactForce(&self.body(), &other.body()));
}

}  // namespace

void bindContacts(py::module_& module, SoftClass& body, WorldClass& world)
{
    PYBIND11_NUMPY_DTYPE(ContactRow, body, other, point, normal, gap, impulse, normal_impulse, friction_impulse, part,
                         triangle, node_count, nodes, weights);
    PYBIND11_NUMPY_DTYPE(TouchRow, body, other, state, points, impulse, normal_impulse);
    module.attr("contact_dtype") = py::dtype::of<ContactRow>();
    module.attr("touch_dtype") = py::dtype::of<TouchRow>();
    const char* contacts =
        "Contact points of the last step, a structured array of contact_dtype: indices of body and other body (-1: it "
        "was\n"
        "removed), point [m], normal to the body [-], gap [m], impulse on the body [N s], its normal component and "
        "its\n"
        "tangential part, part and triangle of a mesh, and the nodes with their weights.";
    const char* touches =
        "Contact pairs of the last step, a structured array of touch_dtype: indices, state (0 began, 1 lasts, 2 "
        "ended),\n"
        "number of points, impulse on the body and its normal sum [N s].";
    body.def_property_readonly(
            "contacts", [](const SoftHandle& self) { return ofBody<ContactRow>(self, &appendContacts); }, contacts)
        .def_property_readonly(
            "touches", [](const SoftHandle& self) { return ofBody<TouchRow>(self, &appendTouches); }, touches)
        .def("contact_force", &forceOf<RigidHandle>, py::arg("other"),
             "Mean force of another body on this one in the last step (3,) [N].")
        .def("contact_force", &forceOf<SoftHandle>, py::arg("other"));
    world
        .def_property_readonly(
            "contacts", [](World& self) { return ofWorld<ContactRow>(self, &appendContacts); }, contacts)
        .def_property_readonly(
            "touches", [](World& self) { return ofWorld<TouchRow>(self, &appendTouches); }, touches);
}

}  // namespace bullet_fem::python
