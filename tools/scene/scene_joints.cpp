// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_joints.h"

#include <limits>

#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

// A frame at the pivot with its x axis along the joint's axis.
btTransform frameOf(const SceneConstraint& from)
{
    const btVector3 x = bulletVector(from.m_axis).normalized();
    btVector3 y, z;
    btPlaneSpace1(x, y, z);
    return btTransform(btMatrix3x3(x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]), bulletVector(from.m_pivot));
}

std::unique_ptr<btTypedConstraint> makeHinge(const SceneConstraint& from, btRigidBody& body, btRigidBody& to,
                                             double step)
{
    const btTransform intoBody = body.getWorldTransform().inverse(), intoTo = to.getWorldTransform().inverse();
    const btVector3 pivot = bulletVector(from.m_pivot), axis = bulletVector(from.m_axis).normalized();
    btVector3 inBody = intoBody.getBasis() * axis, inTo = intoTo.getBasis() * axis;
    auto hinge = std::make_unique<btHingeConstraint>(body, to, intoBody * pivot, intoTo * pivot, inBody, inTo);
    if (from.m_max > 0) hinge->enableAngularMotor(true, 0, btScalar(from.m_max * step));  // maximum impulse per step
    return hinge;
}

// Bullet's slider moves its second body along the x axis of the first body's frame.
std::unique_ptr<btTypedConstraint> makeSlider(const SceneConstraint& from, btRigidBody& body, btRigidBody& to)
{
    const btTransform frame = frameOf(from);
    auto slider = std::make_unique<btSliderConstraint>(to, body, to.getWorldTransform().inverse() * frame,
                                                       body.getWorldTransform().inverse() * frame, true);
    slider->setPoweredLinMotor(from.m_max > 0);
    slider->setMaxLinMotorForce(btScalar(from.m_max));
    return slider;
}

void setSpeed(btTypedConstraint& joint, SceneConstraint::Kind kind, double speed)
{
    if (kind == SceneConstraint::Kind::hinge)
        static_cast<btHingeConstraint&>(joint).setMotorTargetVelocity(btScalar(speed));
    else
        static_cast<btSliderConstraint&>(joint).setTargetLinMotorVelocity(btScalar(speed));
    joint.getRigidBodyA().activate();
    joint.getRigidBodyB().activate();
}

}  // namespace

void SceneJoints::add(btDynamicsWorld& world, const SceneConstraint& from, btRigidBody& body, btRigidBody& to,
                      double step)
{
    Joint joint{nullptr, &from, std::numeric_limits<double>::quiet_NaN()};
    if (from.m_kind == SceneConstraint::Kind::hinge)
        joint.m_joint = makeHinge(from, body, to, step);
    else if (from.m_kind == SceneConstraint::Kind::slider)
        joint.m_joint = makeSlider(from, body, to);
    else
    {
        const btVector3 pivot = bulletVector(from.m_pivot);
        joint.m_joint = std::make_unique<btPoint2PointConstraint>(body, to, body.getWorldTransform().inverse() * pivot,
                                                                  to.getWorldTransform().inverse() * pivot);
    }
    world.addConstraint(joint.m_joint.get(), true);
    m_joints.push_back(std::move(joint));
}

void SceneJoints::removeFrom(btDynamicsWorld& world)
{
    for (const Joint& joint : m_joints) world.removeConstraint(joint.m_joint.get());
    m_joints.clear();
}

void SceneJoints::apply(double middle)
{
    for (Joint& joint : m_joints)
    {
        const double speed = joint.m_from->m_speed.at(middle);
        if (joint.m_from->m_max == 0 || speed == joint.m_speed) continue;  // bodies may sleep on
        setSpeed(*joint.m_joint, joint.m_from->m_kind, speed);
        joint.m_speed = speed;
    }
}

}  // namespace bullet_fem
