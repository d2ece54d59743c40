// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

constexpr double kLargestPressure = 1e8;  // [Pa]
constexpr double kLargestStress = 1e13;   // [Pa]
constexpr double kLargestTension = 1e9;   // [N]

btSoftBody& changed(const SoftHandle& self)
{
    return *self.changing().m_body;
}

int addChamber(const SoftHandle& self, const py::object& triangles, int cavity, py::handle pressure)
{
    btSoftBody& body = changed(self);
    btFemChamber chamber;
    if (triangles.is_none())
    {
        std::vector<btFemChamber> cavities;
        btFemChamber::find(&body, cavities);
        if (cavity < 0 || cavity >= int(cavities.size()))
            throw py::index_error("cavity is " + std::to_string(cavity) + ": the body has " +
                                  std::to_string(cavities.size()) + " cavities");
        chamber = cavities[std::size_t(cavity)];
    }
    else
        chamber.m_triangles = indexRowsOf(triangles, "triangles", 3, body.m_nodes.size());
    chamber.m_pressure = numberOf(pressure, "pressure", -kLargestPressure, kLargestPressure);
    return self.fem().addChamber(&body, chamber);
}

int addCable(const SoftHandle& self, py::handle nodes, py::handle tension, py::handle stiffness, py::handle restLength)
{
    btSoftBody& body = changed(self);
    btFemCable cable;
    for (const int node : indicesOf(nodes, "nodes", body.m_nodes.size())) cable.m_points.emplace_back(node);
    cable.m_tension = numberOf(tension, "tension", 0, kLargestTension);
    cable.m_stiffness = numberOf(stiffness, "stiffness", 0, kLargestStiffness);
    cable.m_restLength = numberOf(restLength, "rest_length", 0, kLargest);
    return self.fem().addCable(&body, cable);
}

std::vector<int> tetsOf(const btSoftBody& body, const py::object& tets)
{
    if (tets.is_none()) return {};
    const std::vector<int> chosen = indicesOf(tets, "tets", body.m_tetras.size());
    if (chosen.empty()) throw py::value_error("tets is empty: it must have an element, or be None for all");
    return chosen;
}

int addFibres(const SoftHandle& self, py::handle directions, const py::object& tets, py::handle activation)
{
    btSoftBody& body = changed(self);
    btFemFibres fibres;
    fibres.m_tets = tetsOf(body, tets);
    const py::array array = py::array::ensure(directions);
    if (array && array.ndim() == 1)
        fibres.m_directions.push_back(directionOf(directions, "directions"));
    else
        for (const Vec3& direction : vectorsOf(directions, "directions"))
            fibres.m_directions.emplace_back(direction.x, direction.y, direction.z);
    fibres.m_activation = numberOf(activation, "activation", -kLargestStress, kLargestStress);
    return self.fem().addFibres(&body, fibres);
}

int addExpansion(const SoftHandle& self, const py::object& tets, py::handle strain)
{
    btSoftBody& body = changed(self);
    btFemExpansion expansion;
    expansion.m_tets = tetsOf(body, tets);
    expansion.m_strain = numberOf(strain, "strain", -0.9, 9);
    return self.fem().addExpansion(&body, expansion);
}

py::list actuatorsOf(const SoftHandle& self)
{
    static const char* const kKinds[] = {"chamber", "cable", "fibres", "expansion"};
    btAlignedObjectArray<btFemActuatorReport> reports;
    self.fem().getActuators(&self.body(), reports);
    py::list list;
    for (int i = 0; i < reports.size(); ++i)
    {
        const btFemActuatorReport& from = reports[i];
        py::dict report;
        report["kind"] = kKinds[int(from.m_kind)];
        report["handle"] = from.m_actuator;
        report["volume"] = from.m_volume;
        report["pressure"] = from.m_pressure;
        report["length"] = from.m_length;
        report["tension"] = from.m_tension;
        report["activation"] = from.m_activation;
        report["strain"] = from.m_strain;
        list.append(report);
    }
    return list;
}

template <bool (btFemSoftBodySolver::*Set)(btSoftBody*, int, btScalar, std::string*)>
void addSetter(SoftClass& body, const char* name, const char* value, double low, double high, const char* text)
{
    body.def(
        name,
        [value, low, high](const SoftHandle& self, int handle, py::handle number)
        { (self.fem().*Set)(&changed(self), handle, btScalar(numberOf(number, value, low, high)), nullptr); },
        py::arg("handle"), py::arg(value), text);
}

}  // namespace

void bindActuators(SoftClass& body)
{
    using Solver = btFemSoftBodySolver;
    body.def("add_chamber", &addChamber, py::arg("triangles") = py::none(), py::kw_only(), py::arg("cavity") = 0,
             py::arg("pressure") = 0,
             "A gas chamber: triangles of nodes (k, 3), counter-clockwise from inside the wall, or the body's cavity "
             "of this\n"
             "number; gauge pressure [Pa]. Returns its handle.")
        .def("add_cable", &addCable, py::arg("nodes"), py::kw_only(), py::arg("tension") = 0, py::arg("stiffness") = 0,
             py::arg("rest_length") = 0,
             "A cable through nodes (k,), of constant tension [N], or elastic: stiffness [N/m] and rest length [m]. "
             "Returns\n"
             "its handle.")
        .def("add_fibres", &addFibres, py::arg("directions"), py::arg("tets") = py::none(), py::kw_only(),
             py::arg("activation") = 0,
             "Muscle fibres along a direction (3,), or one for each of the elements `tets` (k,), None for all; "
             "activation\n"
             "[Pa]. Returns their handle.")
        .def("add_expansion", &addExpansion, py::arg("tets") = py::none(), py::kw_only(), py::arg("strain") = 0,
             "Expansion of elements (k,), None for all, by a free strain [-], in [-0.9, 9]. Returns its handle.")
        .def(
            "seal_chamber", [](const SoftHandle& self, int handle) { self.fem().sealChamber(&changed(self), handle); },
            py::arg("handle"), "Seals a chamber with its present gas.")
        .def(
            "remove_actuator",
            [](const SoftHandle& self, int handle) { self.fem().removeActuator(&changed(self), handle); },
            py::arg("handle"), "Removes an actuator.")
        .def_property_readonly(
            "actuators", &actuatorsOf,
            "Present states, a list of dicts: kind, handle, volume [m3], pressure [Pa], length [m], tension\n"
            "[N], activation [Pa], strain [-].");
    addSetter<&Solver::setChamberPressure>(body, "set_chamber_pressure", "pressure", -kLargestPressure,
                                           kLargestPressure, "Opens a chamber and sets its gauge pressure [Pa].");
    addSetter<&Solver::setChamberGas>(body, "set_chamber_gas", "gas", 0, 1e12,
                                      "Seals a chamber with an amount of gas, pressure times volume [J].");
    addSetter<&Solver::setCableTension>(body, "set_cable_tension", "tension", 0, kLargestTension, "Tension [N].");
    addSetter<&Solver::setCableRestLength>(body, "set_cable_rest_length", "length", 0, kLargest, "Rest length [m].");
    addSetter<&Solver::setActivation>(body, "set_activation", "activation", -kLargestStress, kLargestStress,
                                      "Activation of fibres [Pa].");
    addSetter<&Solver::setExpansion>(body, "set_expansion", "strain", -0.9, 9, "Free strain of an expansion [-].");
}

}  // namespace bullet_fem::python
