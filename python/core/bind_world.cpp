// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <pybind11/stl/filesystem.h>

#include "python/core/handles.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem::python
{
namespace
{

WorldKind kindOf(const std::string& text)
{
    if (text == "coupled") return WorldKind::coupled;
    if (text == "swap") return WorldKind::swap;
    if (text == "multibody") return WorldKind::multibody;
    throw py::value_error("kind is '" + text + "': it must be 'coupled', 'swap' or 'multibody'");
}

btFemRefactoring refactoringOf(const std::string& text)
{
    if (text == "on_request") return btFemRefactoring::onRequest;
    if (text == "synchronous") return btFemRefactoring::synchronous;
    if (text == "background") return btFemRefactoring::background;
    throw py::value_error("refactoring is '" + text + "': it must be 'on_request', 'synchronous' or 'background'");
}

WorldPointer newWorld(const std::string& kind, py::handle step, py::handle gravity, py::handle tolerance,
                      py::handle contactTolerance, py::handle numericalDamping, py::handle contactDamping,
                      int maxContacts, int threads, const std::string& refactoring)
{
    checkSharedBullet();
    btFemSolverInfo info;
    info.m_tolerance = numberOf(tolerance, "tolerance", 1e-8, 0.5);
    info.m_contactTolerance = numberOf(contactTolerance, "contact_tolerance", 1e-7, 0.1);
    info.m_numericalDamping = numberOf(numericalDamping, "numerical_damping", 0, 1);
    info.m_contactDamping = numberOf(contactDamping, "contact_damping", 0, 1);
    info.m_maxContacts = maxContacts;
    info.m_threads = threads;
    info.m_refactoring = refactoringOf(refactoring);
    const double size = numberOf(step, "step", 1e-6, 1);
    auto world = std::make_shared<World>(makeWorld(kindOf(kind), info), size,
                                         info.m_refactoring == btFemRefactoring::background);
    world->setGravity(vectorOf(gravity, "gravity"));
    return world;
}

WorldPointer fromScene(const std::filesystem::path& path)
{
    checkSharedBullet();
    std::unique_ptr<BulletWorld> bullet = readSceneWorld(path.string());
    const double step = bullet->scene()->description().m_step;
    return std::make_shared<World>(std::move(bullet), step, false);
}

/// Remembers how the world is made again when it is unpickled (bulletfem/_recipe.py).
py::object fromRememberedScene(const std::filesystem::path& path)
{
    py::object world = py::cast(fromScene(path));
    world.attr("_recipe") = py::make_tuple(py::none(), std::filesystem::absolute(path).string());
    return world;
}

py::list bodiesOf(const WorldPointer& world, bool soft)
{
    if (!world) throw py::type_error("self is None: it must be a World");
    world->guard().reading();
    py::list list;
    for (int i = 0; i < world->bodies().size(); ++i)
        if (soft ? world->bodies()[i].m_soft != nullptr : world->bodies()[i].m_rigid != nullptr)
            list.append(bodyOf(world, i));
    return list;
}

py::object bodyCalled(const WorldPointer& world, const std::string& name)
{
    world->guard().reading();
    for (int i = 0; i < world->bodies().size(); ++i)
    {
        const BodyEntry& body = world->bodies()[i];
        if (body.m_name == name && (body.m_soft || body.m_rigid)) return bodyOf(world, i);
    }
    throw py::key_error("there is no body '" + name + "'");
}

template <class Body>
void removeBody(const WorldPointer& self, const Body& body)
{
    body.changing();
    if (body.m_world != self) throw py::value_error("the body belongs to another world");
    self->removeBody(body.m_index);
}

void addLists(WorldClass& world)
{
    world
        .def_property_readonly(
            "soft_bodies", [](const WorldPointer& self) { return bodiesOf(self, true); }, "A list of the soft bodies.")
        .def_property_readonly(
            "rigid_bodies", [](const WorldPointer& self) { return bodiesOf(self, false); },
            "A list of the rigid bodies.")
        .def("__getitem__", &bodyCalled, py::arg("name"), "The body of that name; raises KeyError.")
        .def(
            "body",
            [](const WorldPointer& self, int index)
            {
                self->guard().reading();
                if (index < 0 || index >= self->bodies().size())
                    throw py::index_error("there is no body of index " + std::to_string(index));
                return bodyOf(self, index);
            },
            py::arg("index"), "The body of an index, as contacts have it; None if it was removed.")
        .def("remove", &removeBody<SoftHandle>, py::arg("body"), "Removes a body, and its joints and anchors.")
        .def("remove", &removeBody<RigidHandle>, py::arg("body"));
}

}  // namespace

py::object bodyOf(const WorldPointer& world, int index)
{
    if (index < 0) return py::none();
    const BodyEntry& entry = world->bodies()[index];
    if (entry.m_soft) return py::cast(SoftHandle{{world, index}});
    if (entry.m_rigid) return py::cast(RigidHandle{{world, index}});
    return py::none();
}

WorldClass bindWorld(py::module_& module)
{
    WorldClass world(
        module, "World", py::module_local(), py::dynamic_attr(),
        "A world of soft and rigid bodies that is stepped by a constant time step. Use it from one thread at a\n"
        "time; step() releases Python's lock.");
    world
        .def(py::init(&newWorld), py::arg("kind") = "coupled", py::kw_only(), py::arg("step") = 1.0 / 60,
             py::arg("gravity") = py::make_tuple(0, -9.81, 0), py::arg("tolerance") = 1e-3,
             py::arg("contact_tolerance") = 3e-3, py::arg("numerical_damping") = 0, py::arg("contact_damping") = 1,
             py::arg("max_contacts") = 2000, py::arg("threads") = 1, py::arg("refactoring") = "on_request",
             "kind: 'coupled' solves rigid and soft bodies together; 'swap' moves rigid bodies first; 'multibody' is\n"
             "coupled, in Bullet's world of multibodies. step [s], gravity (3,) [m/s2]; threads: 0 takes all of the\n"
             "machine's. The others are those of btFemSolverInfo.")
        .def_static(
            "from_scene", &fromRememberedScene, py::arg("path"),
            "The world of a JSON scene (docs/scenes.md), which moves its kinematic bodies, forces and actuators.")
        .def_property(
            "gravity",
            [](World& self)
            {
                self.guard().reading();
                return arrayOf(self.bullet().info().m_gravity);
            },
            [](World& self, py::handle gravity)
            {
                self.guard().changing();
                self.setGravity(vectorOf(gravity, "gravity"));
            },
            "Gravity (3,) [m/s2]; setting it wakes all bodies.")
        .def_property_readonly(
            "step_size", [](const World& self) { return self.stepSize(); }, "Time step [s].")
        .def_property_readonly(
            "steps", [](World& self) { return self.steps(); }, "Number of steps made.")
        .def_property_readonly(
            "time", [](World& self) { return double(self.steps()) * self.stepSize(); }, "Simulated time [s].")
        .def("__repr__",
             [](World& self)
             {
                 return py::str("<World: {} bodies, {} steps of {} s>")
                     .format(self.bodies().size(), self.steps(), self.stepSize());
             });
    addLists(world);
    return world;
}

}  // namespace bullet_fem::python
