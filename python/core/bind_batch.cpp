// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <pybind11/stl.h>

#include <memory>
#include <vector>

#include "python/core/batch.h"
#include "python/core/handles.h"
#include "python/core/shared_bodies.h"

namespace bullet_fem::python
{
namespace
{

using BatchPointer = std::shared_ptr<Batch>;
using BatchClass = py::class_<Batch, BatchPointer>;

constexpr double kLargestAcceleration = 1e6;  // [m/s2]
constexpr double kLargestNodeForce = 1e15;    // [N]

std::shared_ptr<Batch> newBatch(const std::vector<WorldPointer>& worlds, int threads)
{
    if (threads < 0) throw py::value_error("threads is " + std::to_string(threads) + ": it must be >= 0");
    for (const WorldPointer& world : worlds)
        if (!world) throw py::type_error("worlds has None: each must be a World");
    return std::make_shared<Batch>(worlds, threads);
}

void mustBeIdle(const Batch& batch)
{
    for (const WorldPointer& world : batch.worlds()) world->guard().changing();
}

/// Steps of all worlds, without Python's lock.
void step(Batch& self, int count)
{
    if (count < 0) throw py::value_error("n is " + std::to_string(count) + ": it must be >= 0");
    std::vector<std::unique_ptr<StepGuard::Step>> running;
    for (const WorldPointer& world : self.worlds())
        running.push_back(std::make_unique<StepGuard::Step>(world->guard()));
    for (int k = 0; k < count; ++k)
    {
        {
            const py::gil_scoped_release unlocked;
            self.step();
        }
        self.finish();
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
}

int indexOf(const Batch& self, py::handle body)
{
    if (py::isinstance<py::str>(body))
    {
        const auto name = body.cast<std::string>();
        const BodyTable& bodies = self.worlds()[0]->bodies();
        for (int k = 0; k < bodies.size(); ++k)
            if (bodies[k].m_name == name && (bodies[k].m_soft || bodies[k].m_rigid)) return k;
        throw py::key_error("there is no body '" + name + "'");
    }
    if (!py::isinstance<py::int_>(body))
        throw py::type_error("body is " + std::string(py::repr(body)) + ": it must be a name or an index");
    return body.cast<int>();
}

py::array view(const BatchPointer& self, py::handle body, BatchValue kind, bool ofNodes)
{
    mustBeIdle(*self);
    const int index = indexOf(*self, body);
    const std::vector<double>& values = self->values(index, kind);
    const Dims shape = ofNodes ? Dims{self->size(), self->nodeCount(index), 3} : Dims{self->size(), 3};
    py::array array(py::dtype::of<double>(), shape, values.data(), py::cast(self));
    array.attr("flags").attr("writeable") = false;
    return array;
}

void setGravity(Batch& self, py::handle gravity)
{
    mustBeIdle(self);
    const std::vector<Vec3> values = vectorsOf(gravity, "gravity", self.size(), kLargestAcceleration);
    for (int k = 0; k < self.size(); ++k)
    {
        const Vec3& g = values[std::size_t(k)];
        self.worlds()[std::size_t(k)]->setGravity(btVector3(g.x, g.y, g.z));
    }
}

void addForces(Batch& self, py::handle body, py::handle forces)
{
    mustBeIdle(self);
    const int index = indexOf(self, body), nodes = self.nodeCount(index);
    const Doubles array = doublesOf(forces, "forces", {self.size(), nodes, 3});
    const double* at = array.data();
    for (py::ssize_t k = 0; k < array.size(); ++k)
        if (!(std::abs(at[k]) <= kLargestNodeForce)) throw py::value_error("forces has values above 1e15 N");
    for (const WorldPointer& world : self.worlds())
    {
        btSoftBody& soft = *world->bodies().soft(index).m_body;
        for (int i = 0; i < nodes; ++i, at += 3) soft.m_nodes[i].m_f += btVector3(at[0], at[1], at[2]);
        soft.activate(true);
    }
}

void move(Batch& self, py::handle body, py::handle positions)
{
    mustBeIdle(self);
    const int index = indexOf(self, body);
    const std::vector<Vec3> values = vectorsOf(positions, "positions", self.size());
    for (int k = 0; k < self.size(); ++k)
    {
        btRigidBody& rigid = *self.worlds()[std::size_t(k)]->bodies().rigid(index).m_body;
        if (!rigid.isKinematicObject()) throw py::value_error("the body is not kinematic: only such bodies are moved");
        const Vec3& p = values[std::size_t(k)];
        rigid.setWorldTransform(btTransform(rigid.getWorldTransform().getBasis(), btVector3(p.x, p.y, p.z)));
    }
}

Doubles contactForces(Batch& self, py::handle soft, py::handle other)
{
    mustBeIdle(self);
    const int a = indexOf(self, soft), b = indexOf(self, other);
    Doubles forces(Dims{self.size(), 3});
    double* at = forces.mutable_data();
    for (const WorldPointer& world : self.worlds())
    {
        const btVector3 force =
            world->fem().contactForce(world->bodies().soft(a).m_body, world->bodies().rigid(b).m_body);
        for (int c = 0; c < 3; ++c) *at++ = force[c];
    }
    return forces;
}

py::list saveStates(Batch& self)
{
    mustBeIdle(self);
    py::list list;
    for (const std::vector<unsigned char>& state : self.states())
        list.append(py::bytes(reinterpret_cast<const char*>(state.data()), state.size()));
    return list;
}

void restoreStates(Batch& self, const py::list& states)
{
    mustBeIdle(self);
    if (int(states.size()) != self.size())
        throw py::value_error("states has " + std::to_string(states.size()) + " items: the batch has " +
                              std::to_string(self.size()) + " worlds");
    std::vector<std::vector<unsigned char>> bytes;
    for (const py::handle state : states)
    {
        bytes.emplace_back();
        if (state.is_none()) continue;
        if (!py::isinstance<py::bytes>(state)) throw py::type_error("states must be a list of bytes and None");
        const auto text = state.cast<std::string>();
        if (text.empty()) throw py::value_error("a state is empty");
        bytes.back().assign(text.begin(), text.end());
    }
    const py::gil_scoped_release unlocked;
    self.restore(bytes);
}

void addArrays(BatchClass& batch)
{
    const auto array = [&batch](const char* name, BatchValue kind, bool ofNodes, const char* text)
    {
        batch.def(
            name,
            [kind, ofNodes](const BatchPointer& self, py::handle body) { return view(self, body, kind, ofNodes); },
            py::arg("body"), text);
    };
    array("node_positions", BatchValue::nodePositions, true,
          "Positions of a soft body's nodes in all worlds, (worlds, n, 3) [m]: memory of the batch that each step "
          "renews,\nread-only. `body` is a name or an index.");
    array("node_velocities", BatchValue::nodeVelocities, true,
          "Velocities of a soft body's nodes in all worlds, (worlds, n, 3) [m/s], as node_positions().");
    array("rigid_positions", BatchValue::positions, false,
          "Positions of a rigid body in all worlds, (worlds, 3) [m], as node_positions().");
    array("rigid_velocities", BatchValue::velocities, false,
          "Velocities of a rigid body in all worlds, (worlds, 3) [m/s], as node_positions().");
}

}  // namespace

void bindBatch(py::module_& module)
{
    py::class_<SharedBodies>(module, "_SharedBodies", py::module_local()).def(py::init<>());
    BatchClass batch(module, "_Batch", py::module_local(), "Worlds of equal bodies that threads step together.");
    batch.def(py::init(&newBatch), py::arg("worlds"), py::arg("threads") = 0)
        .def("__len__", [](const Batch& self) { return self.size(); })
        .def_property_readonly(
            "worlds", [](const Batch& self) { return self.worlds(); }, "The worlds, a list.")
        .def_property_readonly(
            "threads", [](const Batch& self) { return self.threads(); }, "Threads that step the worlds.")
        .def("step", &step, py::arg("n") = 1, "Makes n steps of every world, and renews the arrays after each.")
        .def(
            "refresh", [](Batch& self) { mustBeIdle(self), self.refresh(); },
            "Renews the arrays after changes of single worlds.")
        .def("set_gravity", &setGravity, py::arg("gravity"), "Sets gravity (worlds, 3) [m/s2].")
        .def("add_forces", &addForces, py::arg("body"), py::arg("forces"),
             "Adds forces (worlds, n, 3) [N] on a soft body's nodes for the next step.")
        .def("move", &move, py::arg("body"), py::arg("positions"),
             "Moves a kinematic rigid body to positions (worlds, 3) [m] within the next step.")
        .def("contact_forces", &contactForces, py::arg("body"), py::arg("other"),
             "Forces of a rigid body on a soft one in the last step (worlds, 3) [N].")
        .def("save_states", &saveStates, "World.save_state() of every world, a list.")
        .def("restore_states", &restoreStates, py::arg("states"),
             "Restores the worlds to a list of states; None leaves a world as it is.");
    addArrays(batch);
}

}  // namespace bullet_fem::python
