// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <cmath>

#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

using Stresses = btAlignedObjectArray<btFemStress>;
using Scalars = btAlignedObjectArray<btScalar>;
using Vectors = btAlignedObjectArray<btVector3>;

constexpr double kLargestStress = 1e13;  // [Pa]

[[noreturn]] void failUnknown()
{
    throw std::runtime_error("the body is not stepped by BulletFEM, or its mesh has changed: step the world first");
}

template <bool (btFemSoftBodySolver::*Get)(const btSoftBody*, Stresses&) const>
Doubles tensors(const SoftHandle& self, py::handle out)
{
    Stresses stresses;
    if (!(self.fem().*Get)(&self.body(), stresses)) failUnknown();
    Doubles array = arrayToFill(out, {stresses.size(), 3, 3});
    double* at = array.mutable_data();
    for (int i = 0; i < stresses.size(); ++i, at += 9)
    {
        const btFemStress& s = stresses[i];
        const double rows[9] = {s.m_xx, s.m_xy, s.m_xz, s.m_xy, s.m_yy, s.m_yz, s.m_xz, s.m_yz, s.m_zz};
        std::copy_n(rows, 9, at);
    }
    return array;
}

/// Scalars of elements or nodes; zeros if there are none and `count` is not -1.
template <bool (btFemSoftBodySolver::*Get)(const btSoftBody*, Scalars&) const>
Doubles scalars(const SoftHandle& self, py::handle out, int count)
{
    Scalars values;
    if (!(self.fem().*Get)(&self.body(), values))
    {
        if (count < 0) failUnknown();
        values.resize(count, 0);
    }
    Doubles array = arrayToFill(out, {values.size()});
    if (values.size() > 0) std::copy_n(&values[0], values.size(), array.mutable_data());
    return array;
}

template <bool (btFemSoftBodySolver::*Get)(const btSoftBody*, Vectors&) const>
Doubles vectors(const SoftHandle& self, py::handle out)
{
    Vectors values;
    if (!(self.fem().*Get)(&self.body(), values)) values.resize(self.nodeCount(), btVector3(0, 0, 0));
    Doubles array = arrayToFill(out, {values.size(), 3});
    double* at = array.mutable_data();
    for (int i = 0; i < values.size(); ++i)
        for (int k = 0; k < 3; ++k) *at++ = values[i][k];
    return array;
}

void setInitialStress(const SoftHandle& self, py::handle stress)
{
    btSoftBody& body = *self.changing().m_body;
    Stresses stresses;
    if (!stress.is_none())
    {
        const Doubles array = doublesOf(stress, "stress", {body.m_tetras.size(), 3, 3});
        stresses.resize(body.m_tetras.size());
        const double* at = array.data();
        for (int i = 0; i < stresses.size(); ++i, at += 9)
        {
            for (const auto& [a, b] : {std::pair(1, 3), std::pair(2, 6), std::pair(5, 7)})
                if (std::abs(at[a] - at[b]) > 1e-9 * (std::abs(at[a]) + std::abs(at[b])))
                    throw py::value_error("stress of element " + std::to_string(i) + " is not symmetric");
            stresses[i] = {at[0], at[4], at[8], at[1], at[5], at[2]};
        }
    }
    self.fem().setInitialStress(&body, stresses);
}

py::tuple reaction(const SoftHandle& self, py::handle about, const py::object& nodes)
{
    const btSoftBody& body = self.body();
    const btVector3 point = vectorOf(about, "about");
    btFemReaction sum;
    if (nodes.is_none())
        sum = self.fem().reaction(&body, point);
    else
    {
        const std::vector<int> chosen = indicesOf(nodes, "nodes", body.m_nodes.size());
        sum = self.fem().reaction(&body, chosen.data(), int(chosen.size()), point);
    }
    return py::make_tuple(arrayOf(sum.m_force), arrayOf(sum.m_moment), sum.m_count);
}

void addStress(SoftClass& body)
{
    using Solver = btFemSoftBodySolver;
    body.def("get_stress", &tensors<&Solver::getStress>, py::arg("out") = py::none(),
             "Stress of the elements in the world's axes, (m, 3, 3) [Pa], tension positive.")
        .def("get_node_stress", &tensors<&Solver::getNodeStress>, py::arg("out") = py::none(),
             "Stress at the nodes, the mean over their elements, (n, 3, 3) [Pa].")
        .def(
            "get_von_mises",
            [](const SoftHandle& self, py::handle out) { return scalars<&Solver::getVonMises>(self, out, -1); },
            py::arg("out") = py::none(), "Von Mises stress of the elements (m,) [Pa].")
        .def(
            "get_node_von_mises",
            [](const SoftHandle& self, py::handle out) { return scalars<&Solver::getNodeVonMises>(self, out, -1); },
            py::arg("out") = py::none(), "Von Mises stress at the nodes (n,) [Pa].")
        .def(
            "get_plastic_strain",
            [](const SoftHandle& self, py::handle out)
            { return scalars<&Solver::getPlasticStrain>(self, out, self.tetCount()); },
            py::arg("out") = py::none(), "Equivalent plastic strain of the elements (m,) [-].")
        .def(
            "get_activation",
            [](const SoftHandle& self, py::handle out)
            { return scalars<&Solver::getActivation>(self, out, self.tetCount()); },
            py::arg("out") = py::none(), "Activation of muscle fibres in the elements (m,) [Pa].")
        .def("set_initial_stress", &setInitialStress, py::arg("stress"),
             "Adds a stress (m, 3, 3) [Pa], symmetric, in the axes of the rest shape; None removes it.");
}

}  // namespace

void bindStress(SoftClass& body)
{
    using Solver = btFemSoftBodySolver;
    addStress(body);
    body.def_property_readonly(
            "stress", [](const SoftHandle& self) { return tensors<&Solver::getStress>(self, py::none()); },
            "Stress of the elements in the world's axes, (m, 3, 3) [Pa], tension positive.")
        .def_property_readonly(
            "von_mises", [](const SoftHandle& self) { return scalars<&Solver::getVonMises>(self, py::none(), -1); },
            "Von Mises stress of the elements (m,) [Pa].")
        .def("get_contact_forces", &vectors<&Solver::getContactForces>, py::arg("out") = py::none(),
             "Contact forces on the nodes, means over the last step, (n, 3) [N].")
        .def("get_reaction_forces", &vectors<&Solver::getReactionForces>, py::arg("out") = py::none(),
             "Forces that hold pinned and led nodes (n, 3) [N]; 0 at the others.")
        .def("reaction", &reaction, py::arg("about") = py::make_tuple(0, 0, 0), py::arg("nodes") = py::none(),
             "Force (3,) [N], moment (3,) [N m] about a point (3,) [m], and number of held nodes: of all, or of "
             "`nodes`.");
}

}  // namespace bullet_fem::python
