// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"
#include "python/core/world_state.h"

namespace bullet_fem::python
{
namespace
{

py::bytes saveState(World& world)
{
    world.guard().changing();
    std::vector<unsigned char> bytes;
    WorldState::save(world, bytes);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void restoreState(World& world, const py::object& state)
{
    world.guard().changing();
    if (!py::isinstance<py::bytes>(state))
        throw py::type_error("state is " + std::string(py::str(py::type::of(state))) +
                             ": it must be the bytes of save_state()");
    char* data = nullptr;
    py::ssize_t size = 0;
    if (PyBytes_AsStringAndSize(state.ptr(), &data, &size) != 0) throw py::error_already_set();
    WorldState::restore(world, reinterpret_cast<const unsigned char*>(data), std::size_t(size));
}

}  // namespace

void bindState(WorldClass& world)
{
    world
        .def("save_state", &saveState,
             "The state of the world as bytes: motion, contacts, sleep and whatever else the next step depends on.\n"
             "Settings that no step changes are not in it: materials, friction, gravity, motors and limits of joints.")
        .def(
            "restore_state", &restoreState, py::arg("state"),
            "Restores bytes of save_state(), in the world that they are of or in one that was built alike; it goes on\n"
            "with equal bits. Raises ValueError, and changes nothing, on other worlds and on damaged bytes.");
}

}  // namespace bullet_fem::python
