// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <limits>

#include "python/core/handles.h"
#include "python/core/world_robots.h"

namespace bullet_fem::python
{
namespace
{

constexpr double kLargestSpeed = 1e6;        // [rad/s], [m/s]
constexpr double kLargestMotorForce = 1e12;  // [N m], [N]
constexpr double kUsualGain = 0.2;           // of motors that hold a position: within some ten steps

struct RobotHandle : Handle
{
    std::vector<int> m_softBodies;

    Robot& reading() const
    {
        m_world->guard().reading();
        return WorldRobots::robot(*m_world, m_index);
    }
    Robot& changing() const
    {
        m_world->guard().changing();
        return WorldRobots::robot(*m_world, m_index);
    }
};

using RobotClass = py::class_<RobotHandle>;

RobotHandle addRobot(const WorldPointer& world, const std::filesystem::path& path, py::handle position,
                     py::handle orientation, bool isFixed, const py::object& name)
{
    world->guard().changing();
    const UrdfRobot robot = readUrdfRobot(path.string());
    const std::string called = name.is_none() ? robot.m_name : name.cast<std::string>();
    const WorldRobots::Added added =
        WorldRobots::add(*world, robot, transformOf(position, orientation), isFixed, called);
    return {{world, added.m_robot}, added.m_softBodies};
}

template <class Value>
Doubles ofJoints(const RobotHandle& self, const Value& value)
{
    Robot& robot = self.reading();
    Doubles array(py::ssize_t(robot.joints().size()));
    for (py::ssize_t k = 0; k < array.size(); ++k) array.mutable_at(k) = value(robot, int(k));
    return array;
}

void setJointPositions(const RobotHandle& self, py::handle positions)
{
    Robot& robot = self.changing();
    const Doubles values = doublesOf(positions, "joint_positions", {py::ssize_t(robot.joints().size())});
    robot.setPositions({values.data(), values.data() + values.size()});
}

void setMotor(const RobotHandle& self, const std::string& joint, const py::object& velocity, const py::object& position,
              const py::object& maxForce, const py::object& maxVelocity, py::handle gain)
{
    Robot& robot = self.changing();
    const int k = robot.jointCalled(joint);
    const UrdfJoint& from = robot.description().m_joints[std::size_t(robot.joints()[std::size_t(k)])];
    Robot::Motor motor;
    motor.m_largestForce = maxForce.is_none() ? from.m_effort : numberOf(maxForce, "max_force", 0, kLargestMotorForce);
    if (maxForce.is_none() && !(from.m_effort > 0))
        throw py::value_error("max_force is None, and the file gives no effort for joint '" + joint + "'");
    if (!velocity.is_none()) motor.m_velocity = numberOf(velocity, "velocity", -kLargestSpeed, kLargestSpeed);
    if (!position.is_none())
    {
        motor.m_position = numberOf(position, "position", -kLargest, kLargest);
        motor.m_gain = numberOf(gain, "gain", 1e-6, 1);
    }
    motor.m_largestVelocity = !maxVelocity.is_none() ? numberOf(maxVelocity, "max_velocity", 0, kLargestSpeed)
                              : from.m_velocity > 0  ? from.m_velocity
                                                     : kLargestSpeed;
    robot.setMotor(k, motor);
}

py::tuple poseOf(const RobotHandle& self, const std::string& link)
{
    Robot& robot = self.reading();
    const btTransform frame = robot.frameOf(robot.linkCalled(link));
    return py::make_tuple(arrayOf(frame.getOrigin()), arrayOf(frame.getRotation()));
}

Doubles contactForce(const RobotHandle& self, const std::string& link, const SoftHandle& soft)
{
    self.mustShareWorld(soft, "soft");
    Robot& robot = self.reading();
    return arrayOf(self.world().fem().contactForce(&soft.body(), &robot.collider(robot.linkCalled(link))));
}

py::list softBodiesOf(const RobotHandle& self)
{
    self.reading();
    py::list list;
    for (const int index : self.m_softBodies) list.append(bodyOf(self.m_world, index));
    return list;
}

void addLists(RobotClass& robot)
{
    robot.def_readonly("world", &RobotHandle::m_world, "The robot's world.")
        .def_property_readonly("soft_bodies", &softBodiesOf, "The soft bodies of its file; None for removed ones.")
        .def_property_readonly(
            "notes", [](const RobotHandle& self) { return self.reading().description().m_notes; },
            "What its file has and was left out, a list of sentences.")
        .def_property_readonly(
            "links",
            [](const RobotHandle& self)
            {
                std::vector<std::string> names;
                for (const UrdfLink& link : self.reading().description().m_links) names.push_back(link.m_name);
                return names;
            },
            "Names of the links, the base first.")
        .def_property_readonly(
            "joints",
            [](const RobotHandle& self)
            {
                std::vector<std::string> names;
                Robot& own = self.reading();
                for (const int k : own.joints()) names.push_back(own.description().m_joints[std::size_t(k)].m_name);
                return names;
            },
            "Names of the joints that move (j,).");
}

}  // namespace

void bindRobots(py::module_& module, WorldClass& world)
{
    RobotClass robot(module, "Robot", py::module_local(),
                     "A multibody of a URDF file. World.add_robot() makes it. Joint quantities are in [rad] or [m].");
    addLists(robot);
    robot
        .def_property(
            "joint_positions",
            [](const RobotHandle& self)
            {
                return ofJoints(self, [](Robot& own, int k)
                                { return double(own.body().getJointPos(own.joints()[std::size_t(k)])); });
            },
            &setJointPositions, "Positions of the joints (j,) [rad] or [m]. Setting them moves the links at once.")
        .def_property_readonly(
            "joint_velocities",
            [](const RobotHandle& self)
            {
                return ofJoints(self, [](Robot& own, int k)
                                { return double(own.body().getJointVel(own.joints()[std::size_t(k)])); });
            },
            "Velocities of the joints (j,) [rad/s] or [m/s].")
        .def_property_readonly(
            "motor_forces",
            [](const RobotHandle& self) { return ofJoints(self, [](Robot& own, int k) { return own.motorForce(k); }); },
            "Forces of the motors in the last step (j,) [N] or [N m].")
        .def("set_motor", &setMotor, py::arg("joint"), py::kw_only(), py::arg("velocity") = py::none(),
             py::arg("position") = py::none(), py::arg("max_force") = py::none(), py::arg("max_velocity") = py::none(),
             py::arg("gain") = kUsualGain,
             "Drives a joint at a velocity [rad/s] or [m/s], or to a position [rad] or [m], by at most `max_force` [N "
             "m] or\n[N], by default the file's effort. With a position, `gain` [-] is the share of its error that a "
             "step removes,\nat `max_velocity` at most.")
        .def("link_pose", &poseOf, py::arg("link"), "Position (3,) [m] and orientation (x, y, z, w) of a link's frame.")
        .def("contact_force", &contactForce, py::arg("link"), py::arg("soft"),
             "Force of a link on a soft body in the last step (3,) [N].");
    world.def("add_robot", &addRobot, py::arg("path"), py::kw_only(), py::arg("position") = py::make_tuple(0, 0, 0),
              py::arg("orientation") = py::make_tuple(0, 0, 0, 1), py::arg("fixed_base") = true,
              py::arg("name") = py::none(),
              "Adds a Robot of a URDF file to a world of kind 'multibody', its base link at `position` (3,) [m] with\n"
              "`orientation` (x, y, z, w). Its <deformable>s become soft bodies, called '<name>.<deformable>'.");
}

}  // namespace bullet_fem::python
