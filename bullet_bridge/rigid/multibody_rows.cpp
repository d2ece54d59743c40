// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/multibody_rows.h"

#include <algorithm>

#include "BulletCollision/NarrowPhaseCollision/btManifoldPoint.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "bullet_bridge/rigid/multibody_row.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

const btMultiBodyLinkCollider* colliderOf(const btMultiBody& body, int link)
{
    return link < 0 ? body.getBaseCollider() : body.getLinkCollider(link);
}

}  // namespace

void MultiBodyRows::append(const Scope& scope)
{
    const ContactProblem& problem = scope.m_problem;
    m_firstProxy = static_cast<int>(problem.m_rigidProxies.size());
    m_firstContact = problem.m_rigidContacts.size();
    m_firstTorsion = problem.m_torsions.size();
    m_firstJoint = problem.m_joints.size();
    m_firstJacobian = problem.m_jacobians.size();
    m_contacts.clear();
    m_axes.clear();
    m_added.clear();
    m_spin = m_roll = 0;
    for (int k = 0; k < scope.m_links.m_contacts.size(); ++k) appendContact(scope, k);
    for (int begin = 0, end = 0; begin < scope.m_links.m_joints.size(); begin = end)
    {
        end = endOfJoint(scope, begin);
        appendJoint(scope, begin, end);
    }
    scope.m_proxies.links().connect(scope.m_problem.m_rigidProxies, scope.m_problem.m_responses);
}

RowSide MultiBodyRows::linkSide(const Scope& scope, const btMultiBodyLinkCollider* link)
{
    RowSide side;
    if (!link) return side;
    side.m_center = vec3(link->getWorldTransform().getOrigin());
    if (!canMove(*link))
    {
        const LinkMotion led = motionOf(*link, m_linkVelocities);
        side.m_linear = led.m_linear;
        side.m_angular = led.m_angular;
        return side;
    }
    std::vector<RigidProxy>& proxies = scope.m_problem.m_rigidProxies;
    side.m_proxy = scope.m_proxies.find(*link);
    for (const auto& [known, index] : m_added)
        if (known == link) side.m_proxy = index;
    if (side.m_proxy < 0)
    {
        side.m_proxy = static_cast<int>(proxies.size());
        RigidProxy added;
        added.m_center = side.m_center;
        scope.m_proxies.links().add(side.m_proxy, *link, 0, added);
        proxies.push_back(added);
        m_added.emplace_back(link, side.m_proxy);
    }
    const RigidProxy& proxy = proxies[side.m_proxy];
    side.m_center = proxy.m_center;
    side.m_linear = proxy.m_linearVelocity;
    side.m_angular = proxy.m_angularVelocity;
    return side;
}

// One proxy moves as the two links of a multibody relative to each other: an impulse acts on both.
RowSide MultiBodyRows::between(const Scope& scope, const btMultiBodyLinkCollider& a, const btMultiBodyLinkCollider& b,
                               const Vec3& atA, const Vec3& atB)
{
    std::vector<RigidProxy>& proxies = scope.m_problem.m_rigidProxies;
    const int index = static_cast<int>(proxies.size());
    RigidProxy added;
    added.m_center = atB;
    scope.m_proxies.links().addBetween(index, a, atA, b, added);
    proxies.push_back(added);
    return {index, atA, added.m_linearVelocity, added.m_angularVelocity};
}

// False if impulses move neither side.
bool MultiBodyRows::sidesOf(const Scope& scope, const Row& row, Sides& sides)
{
    const btManifoldPoint& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    const btMultiBodyLinkCollider* a = row.m_multiBodyA ? colliderOf(*row.m_multiBodyA, row.m_linkA) : nullptr;
    const btMultiBodyLinkCollider* b = row.m_multiBodyB ? colliderOf(*row.m_multiBodyB, row.m_linkB) : nullptr;
    sides.m_atA = vec3(point.getPositionWorldOnA());
    sides.m_atB = vec3(point.getPositionWorldOnB());
    const btMultiBodyLinkCollider* lever = a ? a : b;
    if (lever) sides.m_lever = norm((a ? sides.m_atA : sides.m_atB) - vec3(lever->getWorldTransform().getOrigin()));
    if (isOneBody(row) && a && b && canMove(*a) && canMove(*b))
    {
        sides.m_a = between(scope, *a, *b, sides.m_atA, sides.m_atB);
        sides.m_b.m_center = sides.m_atB;
        return true;
    }
    sides.m_a = row.m_multiBodyA ? linkSide(scope, a) : sideOf(scope.m_rigid, row.m_solverBodyIdA, scope.m_proxyOf);
    sides.m_b = row.m_multiBodyB ? linkSide(scope, b) : sideOf(scope.m_rigid, row.m_solverBodyIdB, scope.m_proxyOf);
    return sides.m_a.m_proxy >= 0 || sides.m_b.m_proxy >= 0;
}

void MultiBodyRows::appendContact(const Scope& scope, int k)
{
    const Row& row = scope.m_links.m_contacts[k];
    const btManifoldPoint& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    double beyond = 0;
    Sides sides;
    if (!targetBeyond(row, beyond) || !isFiniteRow(scope.m_links.m_data, row) || !sidesOf(scope, row, sides)) return;
    RowOfContact contact;
    contact.m_row = k;
    if (sides.m_a.m_proxy < 0) contact.m_sign = -1;
    const bool isTurned = contact.m_sign < 0;
    const RowSide &first = isTurned ? sides.m_b : sides.m_a, &second = isTurned ? sides.m_a : sides.m_b;
    RigidContact touch =
        contactOf(first, second, isTurned ? sides.m_atB : sides.m_atA, isTurned ? sides.m_atA : sides.m_atB,
                  contact.m_sign * vec3(point.m_normalWorldOnB), beyond);
    touch.m_gap = double(point.getDistance());
    touch.m_compliance = complianceOf(row);
    touch.m_impulse = std::max(0.0, double(point.m_appliedImpulse)) * touch.m_normal;
    setFriction(scope, row, sides, contact, touch);
    m_contacts.push_back(contact);
    scope.m_problem.m_rigidContacts.push_back(touch);
    appendTorsion(scope, k, second.m_angular, sides.m_lever);
}

// Frictional anchors want the points of both sides back together.
void MultiBodyRows::setFriction(const Scope& scope, const Row& row, const Sides& sides, RowOfContact& contact,
                                RigidContact& touch) const
{
    const btManifoldPoint& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    const int next = row.m_frictionIndex;
    if (next + 1 >= scope.m_links.m_friction.size()) return;
    const Row &first = scope.m_links.m_friction[next], &second = scope.m_links.m_friction[next + 1];
    const FrictionPlane plane(touch.m_normal, vec3(first.m_contactNormal1), vec3(second.m_contactNormal1));
    double beyond[2] = {0, 0};
    const bool isGiven = targetBeyond(first, beyond[0]) && targetBeyond(second, beyond[1]);
    if (!isGiven || !isFinite(plane.m_first) || !isFinite(plane.m_second)) return;
    contact.m_plane = plane;
    plane.setCone(std::max(0.0, double(row.m_friction)), touch);
    if (point.m_appliedImpulse > 0)
        touch.m_impulse += contact.m_sign * (double(point.m_appliedImpulseLateral1) * plane.m_first +
                                             double(point.m_appliedImpulseLateral2) * plane.m_second);
    if ((point.m_contactPointFlags & BT_CONTACT_FLAG_FRICTION_ANCHOR) == 0) return;
    const Vec3 relative =
        sides.m_a.velocityAt(sides.m_atA - sides.m_a.m_center) - sides.m_b.velocityAt(sides.m_atB - sides.m_b.m_center);
    const Vec3 motion =
        plane.withProducts(beyond[0] + dot(plane.m_first, relative), beyond[1] + dot(plane.m_second, relative));
    touch.m_otherVelocity += contact.m_sign * motion;
}

// Bullet's arrays are in the order of the contacts. `spin`: of an immovable other side [rad/s].
void MultiBodyRows::appendTorsion(const Scope& scope, int k, const Vec3& spin, double lever)
{
    const btMultiBodyConstraintArray &spinning = scope.m_links.m_spinning, &rolling = scope.m_links.m_rolling;
    while (m_spin < spinning.size() && spinning[m_spin].m_frictionIndex < k) ++m_spin;
    while (m_roll < rolling.size() && rolling[m_roll].m_frictionIndex < k) ++m_roll;
    RollingFriction friction;
    friction.m_lever = lever;
    if (m_spin < spinning.size() && spinning[m_spin].m_frictionIndex == k)
        friction.m_spinning = double(spinning[m_spin].m_friction);
    for (int r = m_roll; r < rolling.size() && rolling[r].m_frictionIndex == k && friction.m_count < 2; ++r)
    {
        friction.m_axes[friction.m_count] = vec3(rolling[r].m_relpos1CrossNormal);
        friction.m_rolling[friction.m_count++] = double(rolling[r].m_friction);
    }
    if (friction.m_count == 0 && !(friction.m_spinning > 0)) return;
    RigidContact& touch = scope.m_problem.m_rigidContacts.back();
    TorsionalFriction torsion;
    if (!friction.set(touch, torsion)) return;
    if (touch.m_other < 0) torsion.m_spin = spin;
    touch.m_torsion = static_cast<int>(scope.m_problem.m_torsions.size());
    scope.m_problem.m_torsions.push_back(torsion);
}

void MultiBodyRows::takeBack(const Scope& scope)
{
    ContactProblem& problem = scope.m_problem;
    for (std::size_t k = 0; k < m_contacts.size(); ++k)
    {
        const RowOfContact& contact = m_contacts[k];
        const RigidContact& touch = problem.m_rigidContacts[m_firstContact + k];
        const Row& row = scope.m_links.m_contacts[contact.m_row];
        setImpulse(scope.m_links.m_data, row, dot(touch.m_impulse, touch.m_normal));
        if (row.m_frictionIndex + 1 >= scope.m_links.m_friction.size()) continue;
        double first = 0, second = 0;
        contact.m_plane.split(contact.m_sign * touch.m_impulse, first, second);
        setImpulse(scope.m_links.m_data, scope.m_links.m_friction[row.m_frictionIndex], first);
        setImpulse(scope.m_links.m_data, scope.m_links.m_friction[row.m_frictionIndex + 1], second);
    }
    ArticulatedBodies& links = scope.m_proxies.links();
    for (std::size_t k = m_firstTorsion; k < problem.m_torsions.size(); ++k)
    {
        const TorsionalFriction& torsion = problem.m_torsions[k];
        links.addImpulse(torsion.m_firstRigidProxy, {}, torsion.m_impulse);
        if (torsion.m_rigidProxy >= 0) links.addImpulse(torsion.m_rigidProxy, {}, -torsion.m_impulse);
    }
    for (const RowOfAxis& axis : m_axes)
        setImpulse(scope.m_links.m_data, scope.m_links.m_joints[axis.m_row],
                   axis.m_sign * problem.m_joints[axis.m_joint].m_impulse[axis.m_axis]);
    links.letGo(m_firstProxy, problem.m_rigidProxies);
    problem.m_rigidProxies.resize(m_firstProxy);
    problem.m_rigidContacts.resize(m_firstContact);
    problem.m_torsions.resize(m_firstTorsion);
    problem.m_joints.resize(m_firstJoint);
    problem.m_jacobians.resize(m_firstJacobian);
}

}  // namespace bullet_fem
