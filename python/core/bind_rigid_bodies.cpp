// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

using RigidClass = py::class_<RigidHandle>;

constexpr double kLargestForce = 1e15;

bool moves(const btRigidBody& body)
{
    return !body.isStaticOrKinematicObject();
}

void setPose(const RigidHandle& self, const btTransform& pose)
{
    btRigidBody& body = *self.changing().m_body;
    if (body.isKinematicObject())
    {
        body.setWorldTransform(pose);  // Bullet derives the velocity from the change
        return;
    }
    body.setCenterOfMassTransform(pose);
    body.setInterpolationWorldTransform(pose);
    body.activate(true);
    self.world().bullet().world().updateSingleAabb(&body);
}

btRigidBody& moving(const RigidHandle& self)
{
    btRigidBody& body = *self.changing().m_body;
    if (!moves(body)) throw py::value_error("the body has mass 0: forces and velocities do not move it");
    body.activate(true);
    return body;
}

void applyForce(const RigidHandle& self, py::handle force, const py::object& at, bool impulse)
{
    btRigidBody& body = moving(self);
    const btVector3 value = vectorOf(force, impulse ? "impulse" : "force", kLargestForce);
    const btVector3 arm =
        at.is_none() ? btVector3(0, 0, 0) : btVector3(vectorOf(at, "at") - body.getCenterOfMassPosition());
    if (impulse)
        body.applyImpulse(value, arm);
    else
        body.applyForce(value, arm);
}

void addPose(RigidClass& rigid)
{
    rigid
        .def_property(
            "position", [](const RigidHandle& self) { return arrayOf(self.body().getWorldTransform().getOrigin()); },
            [](const RigidHandle& self, py::handle position)
            {
                const btQuaternion orientation = self.body().getWorldTransform().getRotation();
                setPose(self, btTransform(orientation, vectorOf(position, "position")));
            },
            "Position of the centre of mass (3,) [m]. A kinematic body moves there within the next step.")
        .def_property(
            "orientation",
            [](const RigidHandle& self) { return arrayOf(self.body().getWorldTransform().getRotation()); },
            [](const RigidHandle& self, py::handle orientation)
            {
                const btVector3 position = self.body().getWorldTransform().getOrigin();
                setPose(self, btTransform(quaternionOf(orientation, "orientation"), position));
            },
            "Orientation, a quaternion (x, y, z, w).")
        .def_property(
            "velocity", [](const RigidHandle& self) { return arrayOf(self.body().getLinearVelocity()); },
            [](const RigidHandle& self, py::handle velocity)
            {
                const btVector3 value = vectorOf(velocity, "velocity");
                moving(self).setLinearVelocity(value);
            },
            "Velocity of the centre of mass (3,) [m/s].")
        .def_property(
            "angular_velocity", [](const RigidHandle& self) { return arrayOf(self.body().getAngularVelocity()); },
            [](const RigidHandle& self, py::handle velocity)
            {
                const btVector3 value = vectorOf(velocity, "angular_velocity");
                moving(self).setAngularVelocity(value);
            },
            "Angular velocity (3,) [rad/s].");
}

void addForces(RigidClass& rigid)
{
    rigid
        .def(
            "apply_force",
            [](const RigidHandle& self, py::handle force, const py::object& at) { applyForce(self, force, at, false); },
            py::arg("force"), py::arg("at") = py::none(),
            "Adds a force (3,) [N] for the next step, at a point of the world (3,) [m] or at the centre of mass.")
        .def(
            "apply_impulse",
            [](const RigidHandle& self, py::handle impulse, const py::object& at)
            { applyForce(self, impulse, at, true); },
            py::arg("impulse"), py::arg("at") = py::none(),
            "Changes the velocity by an impulse (3,) [N s], as apply_force().")
        .def(
            "apply_torque",
            [](const RigidHandle& self, py::handle torque)
            {
                const btVector3 value = vectorOf(torque, "torque", kLargestForce);
                moving(self).applyTorque(value);
            },
            py::arg("torque"), "Adds a torque (3,) [N m] for the next step.");
}

void addValues(RigidClass& rigid)
{
    rigid.def_readonly("index", &RigidHandle::m_index, "Index of the body in its world, as contacts have it.")
        .def_readonly("world", &RigidHandle::m_world, "The body's world.")
        .def_property_readonly(
            "name", [](const RigidHandle& self) { return self.reading(), self.world().bodies()[self.m_index].m_name; },
            "Name of the body.")
        .def_property_readonly(
            "mass", [](const RigidHandle& self) { return self.body().getMass(); }, "Mass [kg]; 0 is fixed.")
        .def_property_readonly(
            "is_kinematic", [](const RigidHandle& self) { return self.body().isKinematicObject(); },
            "Whether the program moves it.")
        .def_property_readonly(
            "is_active", [](const RigidHandle& self) { return self.body().isActive(); }, "False while it sleeps.")
        .def(
            "wake", [](const RigidHandle& self) { self.changing().m_body->activate(true); }, "Wakes the body.")
        .def_property(
            "friction", [](const RigidHandle& self) { return self.body().getFriction(); },
            [](const RigidHandle& self, py::handle value)
            { self.changing().m_body->setFriction(btScalar(numberOf(value, "friction", 0, kLargest))); },
            "Coefficient of friction [-], multiplied by the other body's.")
        .def_property(
            "restitution", [](const RigidHandle& self) { return self.body().getRestitution(); },
            [](const RigidHandle& self, py::handle value)
            { self.changing().m_body->setRestitution(btScalar(numberOf(value, "restitution", 0, 1))); },
            "Coefficient of restitution [-], in [0, 1], multiplied by the other body's.")
        .def(
            "__eq__", [](const RigidHandle& a, const RigidHandle& b) { return a == b; }, py::is_operator())
        .def("__hash__", [](const RigidHandle& self)
             { return std::hash<const void*>()(self.m_world.get()) ^ std::size_t(self.m_index); })
        .def("__repr__", [](const RigidHandle& self) { return py::str("<RigidBody {}>").format(self.m_index); });
}

}  // namespace

void bindRigidBodies(py::module_& module)
{
    RigidClass rigid(module, "RigidBody", py::module_local(),
                     "A rigid body of a world; made by World.add_rigid_body().");
    addPose(rigid);
    addForces(rigid);
    addValues(rigid);
}

}  // namespace bullet_fem::python
