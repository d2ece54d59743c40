// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/cluster_joint_maker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/joints/cluster_motion.h"
#include "bullet_bridge/joints/soft_anchors.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

using BulletJoint = btSoftBody::Joint;
using Control = btSoftBody::AJoint::IControl;

constexpr double kLargestCorrection = 0.19634954084936207;  // largest correction of an angle in a step: pi / 16, as in
                                                            // Bullet [rad]

Control*& controlOf(BulletJoint& joint)
{
    return static_cast<btSoftBody::AJoint&>(joint).m_icontrol;
}

bool isAngular(const BulletJoint& joint)
{
    return joint.Type() == BulletJoint::eType::Angular;
}

double erpOf(const BulletJoint& joint)
{
    return std::min(1.0, std::max(0.0, double(joint.m_erp)));
}

double softnessOf(const BulletJoint& joint)
{
    return joint.m_cfm < 1 ? 1 / double(joint.m_cfm) - 1 : 0;
}

}  // namespace

bool holdsCluster(const btSoftBody& soft, const btSoftBody::Cluster* cluster)
{
    return cluster && soft.m_clusters.findLinearSearch2(const_cast<btSoftBody::Cluster*>(cluster)) >= 0;
}

void swapEnds(HiddenJoint& hidden)
{
    std::swap(hidden.m_joint->m_bodies[0], hidden.m_bodies[0]);
    std::swap(hidden.m_joint->m_bodies[1], hidden.m_bodies[1]);
    if (isAngular(*hidden.m_joint)) std::swap(controlOf(*hidden.m_joint), hidden.m_control);
}

ClusterJointMaker::End ClusterJointMaker::resolve(const btSoftBody::Body& body) const
{
    End end;
    if (!body.m_soft)
    {
        end.m_object = body.m_collisionObject ? body.m_collisionObject : body.m_rigid;
        end.m_kind = !end.m_object || m_scene.m_world.holds(*m_fem.m_softBody, end.m_object) ? End::Kind::rigid
                                                                                             : End::Kind::lost;
        return end;
    }
    end.m_cluster = body.m_soft;
    end.m_kind = m_scene.m_world.holdsCluster(*m_fem.m_softBody, body.m_soft) ? End::Kind::bad : End::Kind::lost;
    for (std::size_t b = 0; b < m_scene.m_bodies.size() && !end.m_fem; ++b)
        if (holdsCluster(*m_scene.m_bodies[b]->m_softBody, body.m_soft))
            end.m_fem = m_scene.m_bodies[b], end.m_body = static_cast<int>(b), end.m_kind = End::Kind::cluster;
    for (FemSoftBody* fem : m_scene.m_outside)
        if (!end.m_fem && holdsCluster(*fem->m_softBody, body.m_soft)) end.m_fem = fem, end.m_kind = End::Kind::unmoved;
    if (end.m_fem && !isClusterOf(*end.m_fem, *body.m_soft)) end.m_kind = End::Kind::bad;
    return end;
}

JointFlags ClusterJointMaker::append(HiddenJoint& hidden)
{
    BulletJoint& joint = *hidden.m_joint;
    JointFlags flags;
    const End ends[2] = {resolve(hidden.m_bodies[0]), resolve(hidden.m_bodies[1])};
    if (ends[0].m_kind == End::Kind::lost || ends[1].m_kind == End::Kind::lost)
    {
        m_fem.m_softBody->m_joints.remove(&joint);
        btAlignedFree(&joint);
        hidden.m_joint = nullptr;
        flags.m_lost = true;
        return flags;
    }
    const bool usable = joint.m_cfm > 0 && std::isfinite(joint.m_erp) && isFinite(vec3(joint.m_refs[0])) &&
                        isFinite(vec3(joint.m_refs[1]));
    flags.m_bad =
        !usable || ends[0].m_kind == End::Kind::bad || ends[1].m_kind == End::Kind::bad || &m_fem != ends[0].m_fem;
    if (flags.m_bad) return flags;
    flags.m_outside = ends[1].m_kind == End::Kind::unmoved && ends[1].m_fem->m_softBody->isActive();
    HeldJoint held;
    held.m_kind = isAngular(joint) ? HeldJoint::Kind::angularJoint : HeldJoint::Kind::linearJoint;
    held.m_object = ends[1].m_fem ? ends[1].m_fem->m_softBody : ends[1].m_object;
    held.m_objectId = held.m_object ? broadphaseId(*held.m_object) : -1;
    held.m_source = &joint;
    if (isAngular(joint))
        appendAngular(hidden, ends, held);
    else
        appendLinear(static_cast<const btSoftBody::LJoint&>(joint), ends, held);
    return flags;
}

ClusterJointMaker::Place ClusterJointMaker::placeOf(const End& end, const Vec3& reference, bool angular) const
{
    Place place;
    if (!end.m_cluster)
    {
        place.m_pivot = rigidPivot(end.m_object, angular ? Vec3() : reference, m_scene);
        place.m_start = angular ? place.m_pivot.m_rotation * reference : place.m_pivot.m_start;
        if (place.m_pivot.m_rigidProxy >= 0)
            place.m_spin = m_scene.m_rigid.rigidProxies()[place.m_pivot.m_rigidProxy].m_angularVelocity;
        return place;
    }
    const ClusterMotion motion(*end.m_fem, *end.m_cluster);
    place.m_start = motion.rotation() * reference + (angular ? Vec3() : motion.center());
    if (end.m_kind == End::Kind::cluster) place.m_spin = motion.angularVelocity(velocity(end.m_fem->m_body));
    return place;
}

JointEnd ClusterJointMaker::pointEnd(const End& end, const Place& place, const Vec3& at)
{
    if (end.m_kind == End::Kind::cluster)
        return ClusterMotion(*end.m_fem, *end.m_cluster).pointEnd(end.m_body, at, m_problem);
    JointEnd rigid;
    rigid.m_rigidProxy = place.m_pivot.m_rigidProxy;
    rigid.m_point = at;
    return rigid;
}

JointEnd ClusterJointMaker::spinEnd(const End& end, const Place& place)
{
    if (end.m_kind == End::Kind::cluster)
        return ClusterMotion(*end.m_fem, *end.m_cluster).spinEnd(end.m_body, m_problem);
    JointEnd rigid;
    rigid.m_rigidProxy = place.m_pivot.m_rigidProxy;
    rigid.m_angular = true;
    return rigid;
}

void ClusterJointMaker::appendLinear(const btSoftBody::LJoint& linear, const End* ends, HeldJoint held)
{
    const Place a = placeOf(ends[0], vec3(linear.m_refs[0]), false);
    const Place b = placeOf(ends[1], vec3(linear.m_refs[1]), false);
    // The impulse acts on both sides at one point, otherwise it would change the angular momentum of the pair.
    const Vec3 at = ends[1].m_cluster ? 0.5 * (a.m_start + b.m_start) : a.m_start;
    held.m_point = a.m_start;
    held.m_error = norm(b.m_start - a.m_start);
    Joint joint;
    joint.m_a = pointEnd(ends[0], a, at);
    joint.m_b = pointEnd(ends[1], b, at);
    joint.m_softness = softnessOf(linear);
    const double longest = longestCorrection(m_fem, m_scene.m_step, joint.m_softness);
    const Vec3 correction = shortened(erpOf(linear) * (b.m_start - a.m_start), longest);
    joint.m_wanted = b.m_pivot.wantedVelocity(at, correction, m_scene.m_step);
    hold(held, ends[1], joint);
}

// Finds the axes, and gets a speed from the joint's control about the first axis; NaN if there is none. The control
// sees the joint in its original form.
btScalar ClusterJointMaker::askControl(HiddenJoint& hidden, const End* ends, Place* places)
{
    auto& angular = static_cast<btSoftBody::AJoint&>(*hidden.m_joint);
    Control* control = hidden.m_control;
    swapEnds(hidden);
    control->Prepare(&angular);
    for (int k = 0; k < 2; ++k)
    {
        places[k] = placeOf(ends[k], vec3(angular.m_refs[k]), true);
        places[k].m_start *= 1 / norm(places[k].m_start);
        angular.m_axis[k] = bulletVector(places[k].m_start);
    }
    m_current = static_cast<btScalar>(dot(places[0].m_spin - places[1].m_spin, places[0].m_start));
    const bool usable = isFinite(places[0].m_start) && isFinite(places[1].m_start);
    const btScalar speed = usable ? control->Speed(&angular, m_current) : btScalar(NAN);
    swapEnds(hidden);
    return speed;
}

void ClusterJointMaker::appendAngular(HiddenJoint& hidden, const End* ends, HeldJoint held)
{
    const auto& angular = static_cast<const btSoftBody::AJoint&>(*hidden.m_joint);
    Place places[2];
    const btScalar speed = askControl(hidden, ends, places);
    if (!std::isfinite(speed)) return;
    const Place &a = places[0], &b = places[1];
    Joint joint;
    joint.m_axes[0] = a.m_start;
    const Vec3 side = std::fabs(a.m_start.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    joint.m_axes[1] = (1 / norm(cross(side, a.m_start))) * cross(side, a.m_start);
    joint.m_axes[2] = cross(a.m_start, joint.m_axes[1]);
    joint.m_a = spinEnd(ends[0], a);
    joint.m_b = spinEnd(ends[1], b);
    const Vec3 turn = cross(a.m_start, b.m_start);  // rotation from a to b; undefined for opposite axes
    held.m_error = std::atan2(norm(turn), dot(a.m_start, b.m_start));
    const double angle = std::min(erpOf(angular) * held.m_error, kLargestCorrection);
    const Vec3 correction = norm(turn) > 0 ? (angle / (m_scene.m_step * norm(turn))) * turn : Vec3();
    joint.m_wanted = {double(speed), dot(correction, joint.m_axes[1]), dot(correction, joint.m_axes[2])};
    if (speed == m_current) joint.m_limit.x = 0;
    joint.m_softness = softnessOf(angular);
    hold(held, ends[1], joint);
}

void ClusterJointMaker::hold(const HeldJoint& held, const End& other, const Joint& joint)
{
    m_problem.m_joints.push_back(joint);
    std::vector<HeldJoint>& now = m_fem.m_joints.m_now;
    now.push_back(held);
    now.back().m_row = static_cast<int>(m_problem.m_joints.size()) - 1;
    if (const HeldJoint* before = continuedBy(held, m_fem.m_joints.m_before, now.size() - 1))
        now.back().m_impulse = before->m_impulse;
    m_problem.m_joints.back().m_impulse = now.back().m_impulse;
    if (other.m_kind != End::Kind::cluster || other.m_fem == &m_fem) return;
    HeldJoint seen = now.back();
    seen.m_object = m_fem.m_softBody;
    seen.m_isEndB = true;
    other.m_fem->m_joints.m_now.push_back(seen);
}

}  // namespace bullet_fem
