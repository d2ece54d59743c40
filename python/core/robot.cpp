// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/robot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/io/surface_file.h"

namespace bullet_fem::python
{
namespace
{

btTransform poseOf(const UrdfPose& pose)
{
    btQuaternion turn;
    turn.setEulerZYX(pose.m_turn.z, pose.m_turn.y, pose.m_turn.x);
    return btTransform(turn, bulletVector(pose.m_position));
}

/// Principal moments of inertia [kg m2], and the frame in which they are.
struct Principal
{
    btVector3 m_moments;
    btTransform m_frame;
};

Principal principalOf(const UrdfLink& link, const btCollisionShape& shape)
{
    Principal principal{btVector3(0, 0, 0), poseOf(link.m_inertial)};
    const auto& i = link.m_inertia;
    btMatrix3x3 tensor(i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5]);
    if (tensor[0][0] + tensor[1][1] + tensor[2][2] > 0)
    {
        btMatrix3x3 turn;
        constexpr double kOffDiagonal = 1e-12;  // of the diagonal, where the rotations end
        constexpr int kRotations = 64;
        tensor.diagonalize(turn, btScalar(kOffDiagonal), kRotations);
        principal.m_moments.setValue(tensor[0][0], tensor[1][1], tensor[2][2]);
        principal.m_frame.setBasis(principal.m_frame.getBasis() * turn);
    }
    else if (link.m_mass > 0 && !link.m_collisions.empty())
        shape.calculateLocalInertia(btScalar(link.m_mass), principal.m_moments);
    return principal;
}

std::unique_ptr<btCollisionShape> primitiveOf(const UrdfShape& shape)
{
    const btScalar radius = btScalar(shape.m_radius), length = btScalar(shape.m_length);
    switch (shape.m_kind)
    {
        case UrdfShape::Kind::box:
            return std::make_unique<btBoxShape>(bulletVector(shape.m_size) / 2);
        case UrdfShape::Kind::sphere:
            return std::make_unique<btSphereShape>(radius);
        case UrdfShape::Kind::capsule:
            return std::make_unique<btCapsuleShapeZ>(radius, length);
        default:
            return std::make_unique<btCylinderShapeZ>(btVector3(radius, radius, length / 2));
    }
}

std::shared_ptr<RigidShape> hullOf(const UrdfShape& shape)
{
    const SurfaceMesh surface = readSurfaceFile(shape.m_meshPath);
    std::vector<Vec3> points;
    for (const Vec3& v : surface.m_vertices)
        points.push_back({v.x * shape.m_size.x, v.y * shape.m_size.y, v.z * shape.m_size.z});
    return std::make_shared<RigidShape>(RigidShape::hull(points));
}

// A link moves only if something of mass hangs on its joint.
void mustHaveMass(const UrdfRobot& robot)
{
    std::vector<double> masses;
    for (const UrdfLink& link : robot.m_links) masses.push_back(link.m_mass);
    for (std::size_t k = robot.m_joints.size(); k-- > 0;)
    {
        const UrdfJoint& joint = robot.m_joints[k];
        const double mass = masses[std::size_t(joint.m_child)];
        if (joint.m_kind != UrdfJoint::Kind::fixed && !(mass > 0))
            throw std::invalid_argument("joint '" + joint.m_name + "' moves links without mass: give link '" +
                                        robot.m_links[std::size_t(joint.m_child)].m_name + "' an <inertial>");
        masses[std::size_t(joint.m_parent)] += mass;
    }
}

int placeOf(const std::vector<std::string>& names, const std::string& name, const char* kind)
{
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw std::out_of_range(std::string("there is no ") + kind + " '" + name + "'");
    return int(at - names.begin());
}

// Mass that a joint moves with all others locked [kg], or its moment of inertia about the axis [kg m2].
double inertiaOf(Robot& robot, int joint)
{
    const bool isSlider = robot.description().m_joints[std::size_t(joint)].m_kind == UrdfJoint::Kind::prismatic;
    const btTransform frame = robot.frameOf(joint + 1);
    const btVector3 axis = frame.getBasis() * bulletVector(robot.description().m_joints[std::size_t(joint)].m_axis);
    std::vector<bool> moves(std::size_t(robot.linkCount()), false);
    moves[std::size_t(joint + 1)] = true;
    double inertia = 0;
    for (std::size_t k = std::size_t(joint + 1); k < std::size_t(robot.linkCount()); ++k)
    {
        moves[k] = moves[k] || moves[std::size_t(robot.description().m_joints[k - 1].m_parent)];
        if (!moves[k]) continue;
        const btTransform& place = robot.collider(int(k)).getWorldTransform();
        const btVector3 arm = (place.getOrigin() - frame.getOrigin()).cross(axis);
        const btVector3 own = place.getBasis().transpose() * axis;
        const double mass = robot.description().m_links[k].m_mass;
        inertia += isSlider ? mass : mass * arm.length2() + (own * own).dot(robot.body().getLinkInertia(int(k) - 1));
    }
    return inertia;
}

}  // namespace

Robot::Robot(btMultiBodyDynamicsWorld& world, const UrdfRobot& description, const btTransform& base, bool isFixed,
             double step)
    : m_world(world), m_description(description), m_step(step)
{
    mustHaveMass(m_description);
    if (!isFixed && !(m_description.m_links[0].m_mass > 0))
        throw std::invalid_argument("the base has no mass: give it an <inertial>, or fix it");
    for (const UrdfLink& link : m_description.m_links)
    {
        auto compound = std::make_unique<btCompoundShape>();
        for (const UrdfShape& shape : link.m_collisions)
            if (shape.m_kind == UrdfShape::Kind::hull)
            {
                m_hulls.push_back(hullOf(shape));
                compound->addChildShape(poseOf(shape.m_pose), m_hulls.back()->shape());
            }
            else
            {
                m_shapes.push_back(primitiveOf(shape));
                compound->addChildShape(poseOf(shape.m_pose), m_shapes.back().get());
            }
        m_colliders.push_back(nullptr);
        m_colliders.back() = std::make_unique<btMultiBodyLinkCollider>(nullptr, int(m_colliders.size()) - 2);
        m_colliders.back()->setCollisionShape(compound.get());
        m_shapes.push_back(std::move(compound));
    }
    setUpLinks(base, isFixed);
    m_world.addMultiBody(m_body.get());
    moveColliders();
    for (int link = 0; link < linkCount(); ++link) addCollider(link, isFixed);
    addLimitsAndMotors();
}

Robot::~Robot()
{
    for (const auto& motor : m_motors) m_world.removeMultiBodyConstraint(motor.get());
    for (const auto& limit : m_limits) m_world.removeMultiBodyConstraint(limit.get());
    for (const auto& collider : m_colliders) m_world.removeCollisionObject(collider.get());
    m_world.removeMultiBody(m_body.get());
}

void Robot::setUpLinks(const btTransform& base, bool isFixed)
{
    std::vector<btVector3> moments;
    for (int k = 0; k < linkCount(); ++k)
    {
        const Principal principal =
            principalOf(m_description.m_links[std::size_t(k)], *collider(k).getCollisionShape());
        m_inertial.push_back(principal.m_frame);
        moments.push_back(principal.m_moments);
        auto& compound = static_cast<btCompoundShape&>(*collider(k).getCollisionShape());
        for (int child = 0; child < compound.getNumChildShapes(); ++child)
            compound.updateChildTransform(child, principal.m_frame.inverse() * compound.getChildTransform(child));
    }
    const auto& links = m_description.m_links;
    m_body = std::make_unique<btMultiBody>(linkCount() - 1, btScalar(links[0].m_mass), moments[0], isFixed, false);
    m_body->setBaseWorldTransform(base * m_inertial[0]);
    for (std::size_t k = 0; k < m_description.m_joints.size(); ++k)
    {
        const UrdfJoint& joint = m_description.m_joints[k];
        const btTransform& inertial = m_inertial[k + 1];
        const btTransform pivot = m_inertial[std::size_t(joint.m_parent)].inverse() * poseOf(joint.m_pose);
        const btQuaternion turn = (pivot * inertial).getRotation().inverse();
        const btVector3 axis = inertial.getBasis().transpose() * bulletVector(joint.m_axis);
        const btVector3 toCentre = inertial.getBasis().transpose() * inertial.getOrigin();
        const btScalar mass = btScalar(links[k + 1].m_mass);
        const int parent = joint.m_parent - 1;
        if (joint.m_kind == UrdfJoint::Kind::fixed)
            m_body->setupFixed(int(k), mass, moments[k + 1], parent, turn, pivot.getOrigin(), toCentre);
        else if (joint.m_kind == UrdfJoint::Kind::prismatic)
            m_body->setupPrismatic(int(k), mass, moments[k + 1], parent, turn, axis, pivot.getOrigin(), toCentre, true);
        else
            m_body->setupRevolute(int(k), mass, moments[k + 1], parent, turn, axis, pivot.getOrigin(), toCentre, true);
        if (joint.m_kind != UrdfJoint::Kind::fixed) m_moving.push_back(int(k));
    }
    m_body->finalizeMultiDof();
    m_body->setLinearDamping(0);
    m_body->setAngularDamping(0);
    m_body->setHasSelfCollision(false);
}

void Robot::addCollider(int link, bool isFixed)
{
    btMultiBodyLinkCollider& own = collider(link);
    own.m_multiBody = m_body.get();
    own.setFriction(btScalar(m_description.m_links[std::size_t(link)].m_friction));
    own.setActivationState(DISABLE_DEACTIVATION);
    if (link == 0)
        m_body->setBaseCollider(&own);
    else
        m_body->getLink(link - 1).m_collider = &own;
    if (link == 0 && isFixed) own.setCollisionFlags(own.getCollisionFlags() | btCollisionObject::CF_STATIC_OBJECT);
    moveColliders();
    // A link without shape has a collider, too, by which Bullet finds the island of its motor.
    const bool hasShape = !m_description.m_links[std::size_t(link)].m_collisions.empty();
    m_world.addCollisionObject(&own, hasShape ? int(btBroadphaseProxy::DefaultFilter) : 0,
                               hasShape ? int(btBroadphaseProxy::AllFilter) : 0);
}

void Robot::addLimitsAndMotors()
{
    for (const int k : m_moving)
    {
        const UrdfJoint& joint = m_description.m_joints[std::size_t(k)];
        if (std::isfinite(joint.m_lower) && std::isfinite(joint.m_upper))
        {
            m_limits.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(
                m_body.get(), k, btScalar(joint.m_lower), btScalar(joint.m_upper)));
            m_limits.back()->finalizeMultiDof();
            m_world.addMultiBodyConstraint(m_limits.back().get());
        }
        m_motors.push_back(std::make_unique<btMultiBodyJointMotor>(m_body.get(), k, btScalar(0), btScalar(0)));
        m_motors.back()->finalizeMultiDof();
        m_world.addMultiBodyConstraint(m_motors.back().get());
    }
}

void Robot::moveColliders()
{
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> places;
    m_body->forwardKinematics(turns, places);
    m_body->updateCollisionObjectWorldTransforms(turns, places);
    m_body->updateCollisionObjectInterpolationWorldTransforms(turns, places);
}

int Robot::linkCalled(const std::string& name) const
{
    std::vector<std::string> names;
    for (const UrdfLink& link : m_description.m_links) names.push_back(link.m_name);
    return placeOf(names, name, "link");
}

int Robot::jointCalled(const std::string& name) const
{
    std::vector<std::string> names;
    for (const int k : m_moving) names.push_back(m_description.m_joints[std::size_t(k)].m_name);
    return placeOf(names, name, "joint that moves, called");
}

btTransform Robot::frameOf(int link) const
{
    return m_colliders[std::size_t(link)]->getWorldTransform() * m_inertial[std::size_t(link)].inverse();
}

void Robot::setPositions(const std::vector<double>& positions)
{
    for (std::size_t k = 0; k < m_moving.size(); ++k) m_body->setJointPos(m_moving[k], btScalar(positions[k]));
    moveColliders();
    for (const auto& collider : m_colliders) m_world.updateSingleAabb(collider.get());
}

void Robot::setMotor(int k, const Motor& motor)
{
    btMultiBodyJointMotor& row = *m_motors[std::size_t(k)];
    row.setPositionTarget(btScalar(motor.m_position), btScalar(motor.m_gain));
    row.setVelocityTarget(btScalar(motor.m_velocity));
    row.setRhsClamp(btScalar(motor.m_largestVelocity));
    row.setMaxAppliedImpulse(btScalar(motor.m_largestForce * m_step));
}

// Implicit in the joint's own velocity, so that strong damping does not swing.
void Robot::addDamping()
{
    for (const int k : m_moving)
    {
        const double damping = m_description.m_joints[std::size_t(k)].m_damping;
        if (!(damping > 0)) continue;
        const double share = 1 + m_step * damping / inertiaOf(*this, k);
        m_body->addJointTorque(k, btScalar(-damping * m_body->getJointVel(k) / share));
    }
}

double Robot::motorForce(int k) const
{
    return double(m_motors[std::size_t(k)]->getAppliedImpulse(0)) / m_step;
}

}  // namespace bullet_fem::python
