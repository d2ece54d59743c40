// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/rigid_pivot.h"

#include <algorithm>
#include <cmath>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kLargestTurn = 0.785398163397448;  // largest rotation of a rigid body in a step by Bullet [rad]

// Rodrigues' formula: v rotated by the rotation vector w, at most by kLargestTurn.
Vec3 turned(const Vec3& v, const Vec3& w)
{
    const double angle = norm(w);
    if (angle < 1e-12) return v + cross(w, v);
    const Vec3 axis = (1 / angle) * w;
    const double used = std::min(angle, kLargestTurn);
    return std::cos(used) * v + std::sin(used) * cross(axis, v) + (1 - std::cos(used)) * dot(axis, v) * axis;
}

// True if the object is at its pose of the end of the step; kinematic objects always are.
bool hasMoved(const btCollisionObject& object, const JointScene& scene)
{
    return scene.m_rigid.phase() == RigidPhase::moved || object.isStaticOrKinematicObject();
}

}  // namespace

Vec3 RigidPivot::wantedVelocity(const Vec3& at, const Vec3& correction, double step) const
{
    const Vec3 tangent = m_linearVelocity + cross(m_angularVelocity, at - m_center);
    return (1 / step) * (correction + m_way) - tangent;
}

RigidPivot rigidPivot(const btCollisionObject* object, const Vec3& local, const JointScene& scene)
{
    RigidPivot pivot;
    pivot.m_start = pivot.m_now = local;
    if (!object) return pivot;
    pivot.m_rigidProxy = scene.m_rigid.indexForJoint(*object, scene.m_step);
    const LinkMotion motion = scene.m_rigid.motionNow(pivot.m_rigidProxy);
    pivot.m_linearVelocity = motion.m_linear;
    pivot.m_angularVelocity = motion.m_angular;
    // Uses the angular velocity before this step's torques: with them, a light body would be predicted to rotate much
    // farther than it does.
    const btRigidBody* body = btRigidBody::upcast(object);
    if (body && !hasMoved(*object, scene)) pivot.m_angularVelocity = vec3(body->getAngularVelocity());
    const btTransform& pose = object->getWorldTransform();
    pivot.m_rotation = mat3(pose.getBasis());
    pivot.m_center = vec3(pose.getOrigin());
    const Vec3 arm = pivot.m_rotation * local, now = pivot.m_center + arm;
    pivot.m_now = now;
    const double sign = hasMoved(*object, scene) ? -1 : 1;
    const Vec3 turn = sign * scene.m_step * pivot.m_angularVelocity;
    const Vec3 other = pivot.m_center + sign * scene.m_step * pivot.m_linearVelocity + turned(arm, turn);
    pivot.m_start = sign < 0 ? other : now;
    pivot.m_way = sign < 0 ? now - other : other - now;
    if (sign > 0) return pivot;
    if (scene.m_rigid.isRewound(pivot.m_rigidProxy))
    {
        pivot.m_center = scene.m_rigid.rigidProxies()[pivot.m_rigidProxy].m_center;
        pivot.m_now = pivot.m_start;
    }
    const Mat3 R = pivot.m_rotation;
    pivot.m_rotation =
        Mat3::fromColumns(turned(R.column(0), turn), turned(R.column(1), turn), turned(R.column(2), turn));
    return pivot;
}

Vec3 shortened(const Vec3& a, double longest)
{
    const double length = norm(a);
    return length > longest ? (longest / length) * a : a;
}

}  // namespace bullet_fem
