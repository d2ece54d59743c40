// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

/// An anchor, attachment, joint or spring of the last step as a row of a structured array.
struct HoldRow
{
    int kind, node, handle, other;
    double point[3], impulse[3], error;
};

py::array_t<HoldRow> holdsOf(const SoftHandle& self)
{
    const auto& reports = self.fem().anchors(&self.body());
    py::array_t<HoldRow> rows(reports.size());
    for (int i = 0; i < reports.size(); ++i)
    {
        const btFemAnchorReport& from = reports[i];
        HoldRow& row = rows.mutable_at(i);
        row.kind = int(from.m_kind);
        row.node = from.m_node;
        row.handle = from.m_attachment;
        row.other = self.world().bodies().indexOf(from.m_object);
        row.error = from.m_error;
        for (int k = 0; k < 3; ++k) row.point[k] = from.m_point[k], row.impulse[k] = from.m_impulse[k];
    }
    return rows;
}

void anchor(const SoftHandle& self, py::handle nodes, const RigidHandle& rigid, py::handle influence, bool collide)
{
    self.mustShareWorld(rigid, "rigid");
    btSoftBody& body = *self.changing().m_body;
    btRigidBody& to = *rigid.changing().m_body;
    const std::vector<int> chosen = indicesOf(nodes, "nodes", body.m_nodes.size());
    const double share = numberOf(influence, "influence", 1e-6, 1);
    for (const int node : chosen)
        if (body.m_nodes[node].m_battach != 0)
            throw py::value_error("node " + std::to_string(node) + " has an anchor: remove it by unanchor()");
    for (const int node : chosen)
        if (body.m_nodes[node].m_battach == 0) body.appendAnchor(node, &to, !collide, btScalar(share));
    body.activate(true);
}

bool hasAnchorTo(const btSoftBody& body, const btCollisionObject* object)
{
    for (int i = 0; i < body.m_anchors.size(); ++i)
        if (body.m_anchors[i].m_body == object) return true;
    return false;
}

void unanchor(const SoftHandle& self, const py::object& nodes)
{
    btSoftBody& body = *self.changing().m_body;
    std::vector<bool> isChosen(std::size_t(body.m_nodes.size()), nodes.is_none());
    if (!nodes.is_none())
        for (const int node : indicesOf(nodes, "nodes", body.m_nodes.size())) isChosen[std::size_t(node)] = true;
    for (int i = body.m_anchors.size() - 1; i >= 0; --i)
    {
        btSoftBody::Node* node = body.m_anchors[i].m_node;
        if (!isChosen[std::size_t(node - &body.m_nodes[0])]) continue;
        node->m_battach = 0;
        body.m_anchors.removeAtIndex(i);
    }
    for (int i = body.m_collisionDisabledObjects.size() - 1; i >= 0; --i)
        if (!hasAnchorTo(body, body.m_collisionDisabledObjects[i]))
            body.m_collisionDisabledObjects.remove(body.m_collisionDisabledObjects[i]);
    body.activate(true);
}

py::tuple anchorReaction(const SoftHandle& self, const py::object& other, py::handle about)
{
    const btCollisionObject* object = nullptr;
    if (py::isinstance<RigidHandle>(other))
    {
        const auto rigid = other.cast<RigidHandle>();
        self.mustShareWorld(rigid, "other");
        object = &rigid.body();
    }
    else if (py::isinstance<SoftHandle>(other))
    {
        const auto soft = other.cast<SoftHandle>();
        self.mustShareWorld(soft, "other");
        object = &soft.body();
    }
    else if (!other.is_none())
        throw py::type_error("other is " + std::string(py::repr(other)) +
                             ": it must be a body, or None for springs to the world");
    const btFemReaction sum = self.fem().anchorReaction(&self.body(), object, vectorOf(about, "about"));
    return py::make_tuple(arrayOf(sum.m_force), arrayOf(sum.m_moment), sum.m_count);
}

int attach(const SoftHandle& self, int node, const SoftHandle& other, int otherNode)
{
    self.mustShareWorld(other, "other");
    return self.fem().attachNodes(self.changing().m_body, node, other.changing().m_body, otherNode);
}

int attachToTet(const SoftHandle& self, int node, const SoftHandle& other, int tet, py::handle weights)
{
    self.mustShareWorld(other, "other");
    const Doubles array = doublesOf(weights, "weights", {4});
    const btScalar values[4] = {array.at(0), array.at(1), array.at(2), array.at(3)};
    return self.fem().attachNodeToTet(self.changing().m_body, node, other.changing().m_body, tet, values);
}

int addSpring(const SoftHandle& self, py::handle nodes, py::handle target, py::handle weights, py::handle stiffness,
              py::handle damping, py::handle strongest)
{
    btSoftBody& body = *self.changing().m_body;
    const std::vector<int> chosen = indicesOf(nodes, "nodes", body.m_nodes.size());
    if (chosen.empty() || chosen.size() > 3)
        throw py::value_error("nodes has " + std::to_string(chosen.size()) + " indices: it must have one to three");
    btFemSpring spring;
    const auto count = py::ssize_t(chosen.size());
    const Doubles shares = weights.is_none() ? Doubles() : doublesOf(weights, "weights", {count});
    for (py::ssize_t i = 0; i < 3; ++i)
    {
        spring.m_nodes[i] = chosen[std::size_t(i < count ? i : 0)];
        spring.m_weights[i] = i >= count ? 0 : weights.is_none() ? 1.0 / double(count) : shares.at(i);
    }
    spring.m_target = vectorOf(target, "target");
    spring.m_stiffness = numberOf(stiffness, "stiffness", 0, kLargestStiffness);
    spring.m_damping = numberOf(damping, "damping", 0, kLargestStiffness);
    spring.m_maxForce = numberOf(strongest, "max_force", 0, kLargestStiffness);
    return self.fem().addSpring(&body, spring);
}

void setTargets(const SoftHandle& self, py::handle nodes, py::handle positions)
{
    btSoftBody& body = *self.changing().m_body;
    const std::vector<int> chosen = indicesOf(nodes, "nodes", body.m_nodes.size());
    const std::vector<Vec3> places = vectorsOf(positions, "positions", py::ssize_t(chosen.size()));
    std::vector<btVector3> targets;
    for (const Vec3& place : places) targets.emplace_back(place.x, place.y, place.z);
    self.fem().setNodeTargets(&body, chosen.data(), int(chosen.size()), targets.data());
    body.activate(true);
}

void moveTargets(const SoftHandle& self, py::handle nodes, py::handle position, py::handle orientation)
{
    btSoftBody& body = *self.changing().m_body;
    const std::vector<int> chosen = indicesOf(nodes, "nodes", body.m_nodes.size());
    const btTransform fromRest = transformOf(position, orientation);
    self.fem().setNodeTargets(&body, chosen.data(), int(chosen.size()), fromRest);
    body.activate(true);
}

void addTargets(SoftClass& body)
{
    body.def("set_targets", &setTargets, py::arg("nodes"), py::arg("positions"),
             "Leads nodes (k,) to positions (k, 3) [m] within the next step, where they stay.")
        .def("move_targets", &moveTargets, py::arg("nodes"), py::arg("position"),
             py::arg("orientation") = py::make_tuple(0, 0, 0, 1),
             "Leads nodes (k,) to their places at rest in the world, turned about its origin by a quaternion (x, y, z, "
             "w)\n"
             "and shifted by (3,) [m].")
        .def(
            "clear_targets",
            [](const SoftHandle& self, py::handle nodes)
            {
                const std::vector<int> chosen = indicesOf(nodes, "nodes", self.nodeCount());
                self.fem().clearNodeTargets(self.changing().m_body, chosen.data(), int(chosen.size()));
            },
            py::arg("nodes"), "Frees nodes (k,) from their targets.");
}

void addSprings(SoftClass& body)
{
    body.def("add_spring", &addSpring, py::arg("nodes"), py::arg("target"), py::kw_only(),
             py::arg("weights") = py::none(), py::arg("stiffness") = 1000, py::arg("damping") = 0,
             py::arg("max_force") = 0,
             "A spring from the weighted mean of one to three nodes to a target (3,) [m]: stiffness [N/m], damping [N "
             "s/m],\n"
             "largest force [N], 0 for no limit. Returns its handle.")
        .def(
            "set_spring_target",
            [](const SoftHandle& self, int spring, py::handle target)
            { self.fem().setSpringTarget(self.changing().m_body, spring, vectorOf(target, "target")); },
            py::arg("spring"), py::arg("target"), "Moves the target of a spring (3,) [m].")
        .def(
            "remove_spring",
            [](const SoftHandle& self, int spring) { self.fem().removeSpring(self.changing().m_body, spring); },
            py::arg("spring"), "Removes a spring.");
}

}  // namespace

void bindHolds(SoftClass& body)
{
    PYBIND11_NUMPY_DTYPE(HoldRow, kind, node, handle, other, point, impulse, error);
    body.def("anchor", &anchor, py::arg("nodes"), py::arg("rigid"), py::kw_only(), py::arg("influence") = 1,
             py::arg("collide") = false, "Holds nodes (k,) to a rigid body where they are; influence [-], in (0, 1].")
        .def("unanchor", &unanchor, py::arg("nodes") = py::none(), "Removes the anchors of nodes (k,), or all.")
        .def("attach", &attach, py::arg("node"), py::arg("other"), py::arg("other_node"),
             "Ties a node to one of another soft body, or of this one. Returns a handle.")
        .def("attach_to_tet", &attachToTet, py::arg("node"), py::arg("other"), py::arg("tet"), py::arg("weights"),
             "Ties a node to a point of an element of another soft body, by weights (4,) [-] of sum 1. Returns a "
             "handle.")
        .def(
            "detach", [](const SoftHandle& self, int handle) { self.fem().detach(self.changing().m_body, handle); },
            py::arg("handle"), "Removes an attachment or a weld that this body owns.")
        .def_property_readonly("holds", &holdsOf,
                               "Anchors, attachments, joints and springs of the last step, a structured array: kind (0 "
                               "anchor, 2 attachment,\n"
                               "5 spring), node (-1: a point), handle, index of the other body (-1: the world), point "
                               "[m], impulse on the body\n"
                               "[N s] and error [m].")
        .def("anchor_reaction", &anchorReaction, py::arg("other") = py::none(),
             py::arg("about") = py::make_tuple(0, 0, 0),
             "Force (3,) [N] and moment (3,) [N m] about a point (3,) [m] of anchors, attachments and springs to "
             "another\n"
             "body, or to the world (None), and their number.");
    addTargets(body);
    addSprings(body);
}

}  // namespace bullet_fem::python
