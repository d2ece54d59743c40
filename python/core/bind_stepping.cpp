// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <limits>

#include "bullet_fem/btFemInterest.h"
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

/// A function of Python's that rates bodies. The world keeps its exceptions until the step is over.
class InterestCallback : public btFemInterest
{
public:
    InterestCallback(const WorldPointer& world, py::object function) : m_world(world), m_function(std::move(function))
    {
    }

    btScalar interest(const btSoftBody& body) override
    {
        const py::gil_scoped_acquire locked;
        const WorldPointer world = m_world.lock();
        try
        {
            constexpr double kInfinite = std::numeric_limits<double>::infinity();
            const py::object result = m_function(bodyOf(world, world->bodies().indexOf(&body)));
            return btScalar(numberOf(result, "interest", -kInfinite, kInfinite));
        }
        catch (...)
        {
            world->guard().keepException();
            return 1;
        }
    }

private:
    std::weak_ptr<World> m_world;
    py::object m_function;
};

void mustBeCallable(const py::object& function, const char* name)
{
    if (!function.is_none() && !PyCallable_Check(function.ptr()))
        throw py::type_error(std::string(name) + " is " + std::string(py::repr(function)) +
                             ": it must be None or a function");
}

/// Steps without Python's lock, and looks for signals such as Ctrl-C after each.
void step(const WorldPointer& world, int count, const py::object& after)
{
    if (count < 0) throw py::value_error("n is " + std::to_string(count) + ": it must be >= 0");
    mustBeCallable(after, "after");
    StepGuard::Step running(world->guard());
    for (int k = 0; k < count; ++k)
    {
        {
            const py::gil_scoped_release unlocked;
            world->step();
        }
        world->finishStep();
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (after.is_none()) continue;
        const StepGuard::Pause between(world->guard());
        after(world);
    }
}

void setInterest(const WorldPointer& world, const py::object& function)
{
    world->guard().changing();
    mustBeCallable(function, "function");
    std::unique_ptr<btFemInterest> interest;
    if (!function.is_none()) interest = std::make_unique<InterestCallback>(world, function);
    world->setInterest(std::move(interest));
}

}  // namespace

void bindStepping(WorldClass& world)
{
    world
        .def("step", &step, py::arg("n") = 1, py::arg("after") = py::none(),
             "Makes n steps, and calls after(world) behind each, which may change the world but not step it. Other "
             "threads\n"
             "of Python run meanwhile. Ctrl-C is raised after the step in which it comes, and an exception of a "
             "function\n"
             "after the step that called it.")
        .def("set_interest", &setInterest, py::arg("function"),
             "Sets a function of a SoftBody that returns the interest in it [-], in [0, 1]: 1 for full accuracy, 0 for "
             "a\n"
             "body that nobody sees. Called within steps, where it may only read; None removes it.");
}

}  // namespace bullet_fem::python
