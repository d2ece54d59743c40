// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

constexpr double kLargestAngle = 3.14159265358979323846;
constexpr double kLargestForce = 1e15;

/// The two bodies of a joint, the second of which may be the world.
struct JointBodies
{
    btRigidBody& m_a;
    btRigidBody& m_b;
    int m_indexA, m_indexB;
};

JointBodies bodiesOf(const RigidHandle& a, const py::object& b)
{
    btRigidBody& first = *a.changing().m_body;
    if (b.is_none()) return {first, btTypedConstraint::getFixedBody(), a.m_index, -1};
    if (!py::isinstance<RigidHandle>(b))
        throw py::type_error("b is " + std::string(py::repr(b)) + ": it must be a RigidBody, or None for the world");
    const auto second = b.cast<RigidHandle>();
    a.mustShareWorld(second, "b");
    if (second == a) throw py::value_error("a and b are one body: a joint needs two");
    return {first, *second.changing().m_body, a.m_index, second.m_index};
}

const RigidHandle& mine(const WorldPointer& world, const RigidHandle& a)
{
    if (a.m_world != world) throw py::value_error("a belongs to another world");
    return a;
}

/// A frame at the pivot with its x axis along the joint's axis.
btTransform frameOf(const btVector3& pivot, const btVector3& x)
{
    btVector3 y, z;
    btPlaneSpace1(x, y, z);
    return btTransform(btMatrix3x3(x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]), pivot);
}

JointHandle add(const RigidHandle& a, const JointBodies& bodies, std::unique_ptr<btTypedConstraint> joint, bool collide)
{
    const int index = a.world().add({std::move(joint), bodies.m_indexA, bodies.m_indexB}, collide);
    return {{a.m_world, index}};
}

JointHandle addBall(const RigidHandle& a, const py::object& b, py::handle pivot, bool collide)
{
    const JointBodies bodies = bodiesOf(a, b);
    const btVector3 at = vectorOf(pivot, "pivot");
    return add(
        a, bodies,
        std::make_unique<btPoint2PointConstraint>(bodies.m_a, bodies.m_b, bodies.m_a.getWorldTransform().inverse() * at,
                                                  bodies.m_b.getWorldTransform().inverse() * at),
        collide);
}

JointHandle addFixed(const RigidHandle& a, const py::object& b, bool collide)
{
    const JointBodies bodies = bodiesOf(a, b);
    const btTransform inB = bodies.m_b.getWorldTransform().inverse() * bodies.m_a.getWorldTransform();
    return add(a, bodies, std::make_unique<btFixedConstraint>(bodies.m_a, bodies.m_b, btTransform::getIdentity(), inB),
               collide);
}

JointHandle addHinge(const RigidHandle& a, const py::object& b, py::handle pivot, py::handle axis, bool collide)
{
    const JointBodies bodies = bodiesOf(a, b);
    const btTransform intoA = bodies.m_a.getWorldTransform().inverse(),
                      intoB = bodies.m_b.getWorldTransform().inverse();
    const btVector3 at = vectorOf(pivot, "pivot"), along = directionOf(axis, "axis");
    btVector3 inA = intoA.getBasis() * along, inB = intoB.getBasis() * along;
    return add(a, bodies, std::make_unique<btHingeConstraint>(bodies.m_a, bodies.m_b, intoA * at, intoB * at, inA, inB),
               collide);
}

JointHandle addSlider(const RigidHandle& a, const py::object& b, py::handle axis, bool collide)
{
    const JointBodies bodies = bodiesOf(a, b);
    const btTransform frame = frameOf(bodies.m_a.getCenterOfMassPosition(), directionOf(axis, "axis"));
    auto slider =
        std::make_unique<btSliderConstraint>(bodies.m_b, bodies.m_a, bodies.m_b.getWorldTransform().inverse() * frame,
                                             bodies.m_a.getWorldTransform().inverse() * frame, true);
    slider->setLowerLinLimit(1);  // lower above upper: free
    slider->setUpperLinLimit(-1);
    return add(a, bodies, std::move(slider), collide);
}

template <class Constraint>
Constraint* as(const JointEntry& joint)
{
    return dynamic_cast<Constraint*>(joint.m_constraint.get());
}

[[noreturn]] void failKind()
{
    throw py::value_error("the joint is neither a hinge nor a slider");
}

void setMotor(const JointHandle& self, py::handle speed, py::handle strongest)
{
    const JointEntry& joint = self.changing();
    const double target = numberOf(speed, "speed", -1e6, 1e6),
                 most = numberOf(strongest, "max_force", 0, kLargestForce);
    if (auto* hinge = as<btHingeConstraint>(joint))
        hinge->enableAngularMotor(most > 0, btScalar(target), btScalar(most * self.world().stepSize()));
    else if (auto* slider = as<btSliderConstraint>(joint))
    {
        slider->setPoweredLinMotor(most > 0);
        slider->setMaxLinMotorForce(btScalar(most));
        slider->setTargetLinMotorVelocity(btScalar(target));
    }
    else
        failKind();
    joint.m_constraint->getRigidBodyA().activate();
    joint.m_constraint->getRigidBodyB().activate();
}

void setLimits(const JointHandle& self, py::handle lower, py::handle upper)
{
    const JointEntry& joint = self.changing();
    auto* hinge = as<btHingeConstraint>(joint);
    auto* slider = as<btSliderConstraint>(joint);
    if (!hinge && !slider) failKind();
    const double largest = hinge ? kLargestAngle : kLargest;
    const double low = numberOf(lower, "lower", -largest, largest), high = numberOf(upper, "upper", low, largest);
    if (hinge)
        hinge->setLimit(btScalar(low), btScalar(high));
    else
    {
        slider->setLowerLinLimit(btScalar(low));
        slider->setUpperLinLimit(btScalar(high));
    }
}

double positionOf(const JointHandle& self)
{
    const JointEntry& joint = self.reading();
    if (auto* hinge = as<btHingeConstraint>(joint)) return hinge->getHingeAngle();
    auto* slider = as<btSliderConstraint>(joint);
    if (!slider) failKind();
    slider->calculateTransforms(slider->getRigidBodyA().getWorldTransform(),
                                slider->getRigidBodyB().getWorldTransform());
    return slider->getLinearPos();
}

void addMakers(WorldClass& world)
{
    world
        .def(
            "add_ball_joint",
            [](const WorldPointer& self, const RigidHandle& a, const py::object& b, py::handle pivot, bool collide)
            { return addBall(mine(self, a), b, pivot, collide); },
            py::arg("a"), py::arg("b"), py::arg("pivot"), py::arg("collide") = false,
            "Joins a point of two rigid bodies, or of one and the world (None): pivot (3,) [m] in the world.")
        .def(
            "add_fixed_joint",
            [](const WorldPointer& self, const RigidHandle& a, const py::object& b, bool collide)
            { return addFixed(mine(self, a), b, collide); },
            py::arg("a"), py::arg("b"), py::arg("collide") = false, "Holds a as it is to b, or to the world (None).")
        .def(
            "add_hinge",
            [](const WorldPointer& self, const RigidHandle& a, const py::object& b, py::handle pivot, py::handle axis,
               bool collide) { return addHinge(mine(self, a), b, pivot, axis, collide); },
            py::arg("a"), py::arg("b"), py::arg("pivot"), py::arg("axis"), py::arg("collide") = false,
            "a turns about `axis` (3,) through `pivot` (3,) [m], both in the world, relative to b or the world (None).")
        .def(
            "add_slider",
            [](const WorldPointer& self, const RigidHandle& a, const py::object& b, py::handle axis, bool collide)
            { return addSlider(mine(self, a), b, axis, collide); },
            py::arg("a"), py::arg("b"), py::arg("axis"), py::arg("collide") = false,
            "a slides along `axis` (3,) in the world, relative to b or the world (None), and does not turn.");
}

}  // namespace

void bindJoints(py::module_& module, WorldClass& world)
{
    addMakers(world);
    py::class_<JointHandle>(module, "Joint", py::module_local(),
                            "A joint of two rigid bodies, or of one and the world.")
        .def("set_motor", &setMotor, py::arg("speed"), py::arg("max_force"),
             "Drives a hinge [rad/s] or slider [m/s] with at most this torque [N m] or force [N]; 0 switches it off.")
        .def("set_limits", &setLimits, py::arg("lower"), py::arg("upper"),
             "Limits the angle of a hinge [rad] or the way of a slider [m].")
        .def_property_readonly("position", &positionOf, "Angle of a hinge [rad] or way of a slider [m] from its start.")
        .def_property_readonly(
            "exists",
            [](const JointHandle& self)
            {
                self.world().guard().reading();
                return self.world().joints()[std::size_t(self.m_index)].m_constraint != nullptr;
            },
            "False after remove(), and after one of its bodies was removed.")
        .def(
            "remove",
            [](const JointHandle& self)
            {
                self.changing();
                self.world().removeJoint(self.m_index);
            },
            "Removes the joint.");
}

}  // namespace bullet_fem::python
