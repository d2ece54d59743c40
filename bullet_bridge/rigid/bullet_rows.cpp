// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/bullet_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "BulletCollision/NarrowPhaseCollision/btManifoldPoint.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

// Bullet's rolling friction grows with the normal impulse only up to this one
// (btSequentialImpulseConstraintSolver::solveSingleIteration) [N s].
constexpr double kMaxRollingLoad = 1;

// Added compliance of a joint's rows as a multiple of their own, so that redundant joints share a load: impulses of
// nearly dependent rows would be arbitrary, and thousands of newtons in a bridge with two joints between planks [-].
constexpr double kJointSoftness = 1e-4;

double impulseOf(const btSolverConstraint& row)
{
    return double(btScalar(row.m_appliedImpulse));
}

// Direction of a row between two bodies, on body A; Bullet's is zero for a body that does not move.
Vec3 directionOf(const btSolverConstraint& row)
{
    return row.m_contactNormal1.length2() > 0 ? vec3(row.m_contactNormal1) : -vec3(row.m_contactNormal2);
}

}  // namespace

RowSide sideOf(const BulletConstraints& bullet, int solverBody, const std::vector<int>& proxyOf)
{
    RowSide side;
    const btSolverBody& body = bullet.m_bodies[solverBody];
    side.m_proxy = proxyOf[solverBody];
    if (!body.m_originalBody) return side;
    side.m_center = vec3(body.m_originalBody->getCenterOfMassPosition());
    side.m_linear = vec3(body.m_linearVelocity) + vec3(body.m_externalForceImpulse);
    side.m_angular = vec3(body.m_angularVelocity) + vec3(body.m_externalTorqueImpulse);
    return side;
}

void BulletRows::append(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem)
{
    m_firstContact = problem.m_rigidContacts.size();
    m_firstTorsion = problem.m_torsions.size();
    m_firstJoint = problem.m_joints.size();
    m_firstJacobian = problem.m_jacobians.size();
    m_contacts.clear();
    m_torsions.clear();
    m_axes.clear();
    m_contactOf.assign(bullet.m_contacts.size(), -1);
    m_anyBad = false;
    for (int k = 0; k < bullet.m_bodies.size(); ++k)
    {
        bullet.m_bodies[k].m_deltaLinearVelocity.setZero();
        bullet.m_bodies[k].m_deltaAngularVelocity.setZero();
    }
    for (int k = 0; k < bullet.m_contacts.size(); ++k) appendContact(bullet, k, proxyOf, problem);
    appendTorsions(bullet, proxyOf, problem);
    appendJoints(bullet, proxyOf, problem);
}

void BulletRows::appendContact(const BulletConstraints& bullet, int k, const std::vector<int>& proxyOf,
                               ContactProblem& problem)
{
    const btSolverConstraint& row = bullet.m_contacts[k];
    const btManifoldPoint& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    RowSide first = sideOf(bullet, row.m_solverBodyIdA, proxyOf), second = sideOf(bullet, row.m_solverBodyIdB, proxyOf);
    Vec3 at = vec3(point.getPositionWorldOnA()), atSecond = vec3(point.getPositionWorldOnB());
    RowOfContact contact;
    contact.m_row = k;
    if (first.m_proxy < 0)
    {
        std::swap(first, second);
        std::swap(at, atSecond);
        contact.m_sign = -1;
    }
    double beyond = 0;
    if (first.m_proxy < 0) return;
    const bool isBad = !targetBeyond(row, beyond);
    m_anyBad = m_anyBad || isBad || row.m_cfm < 0;
    if (isBad) return;
    RigidContact touch = contactOf(first, second, at, atSecond, contact.m_sign * vec3(point.m_normalWorldOnB), beyond);
    touch.m_gap = double(point.getDistance());
    touch.m_compliance = complianceOf(row);
    touch.m_impulse = impulseOf(row) * touch.m_normal;
    setFriction(bullet, row, contact, touch);
    m_contactOf[k] = static_cast<int>(m_contacts.size());
    m_contacts.push_back(contact);
    problem.m_rigidContacts.push_back(touch);
}

// Belts run with the motion that a program gave the contact point; if that is not finite, there is no friction.
void BulletRows::setFriction(const BulletConstraints& bullet, const btSolverConstraint& row, RowOfContact& contact,
                             RigidContact& touch) const
{
    const btManifoldPoint& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    const double coefficient = std::max(0.0, double(row.m_friction));
    touch.m_friction = coefficient;
    if (row.m_frictionIndex + 1 >= bullet.m_friction.size()) return;
    const FrictionPlane plane(touch.m_normal, directionOf(bullet.m_friction[row.m_frictionIndex]),
                              directionOf(bullet.m_friction[row.m_frictionIndex + 1]));
    const Vec3 motion =
        double(point.m_contactMotion1) * plane.m_first + double(point.m_contactMotion2) * plane.m_second;
    if (!isFinite(motion))
    {
        touch.m_friction = 0;
        return;
    }
    contact.m_plane = plane;
    if (impulseOf(row) > 0)
        touch.m_impulse += contact.m_sign * (double(point.m_appliedImpulseLateral1) * plane.m_first +
                                             double(point.m_appliedImpulseLateral2) * plane.m_second);
    touch.m_otherVelocity += contact.m_sign * motion;
    plane.setCone(coefficient, touch);
}

// The rows of one contact are consecutive: about its normal, then about tangents.
void BulletRows::appendTorsions(const BulletConstraints& bullet, const std::vector<int>& proxyOf,
                                ContactProblem& problem)
{
    const int count = bullet.m_torsions.size();
    for (int begin = 0, end = 0; begin < count; begin = end)
    {
        const int contact = bullet.m_torsions[begin].m_frictionIndex;
        while (end < count && bullet.m_torsions[end].m_frictionIndex == contact) ++end;
        if (m_contactOf[contact] < 0) continue;
        RigidContact& touch = problem.m_rigidContacts[m_firstContact + m_contactOf[contact]];
        RollingFriction rolling;
        rolling.m_maxLoad = kMaxRollingLoad;
        rolling.m_lever = norm(touch.m_arm);
        rolling.m_spinning = double(bullet.m_torsions[begin].m_friction);
        for (int k = begin + 1; k < std::min(end, begin + 3); ++k, ++rolling.m_count)
        {
            rolling.m_axes[rolling.m_count] = vec3(bullet.m_torsions[k].m_relpos2CrossNormal);
            rolling.m_rolling[rolling.m_count] = double(bullet.m_torsions[k].m_friction);
        }
        TorsionalFriction torsion;
        if (!rolling.set(touch, torsion)) continue;
        const btSolverConstraint& row = bullet.m_torsions[begin];
        const int other =
            touch.m_rigidProxy == proxyOf[row.m_solverBodyIdA] ? row.m_solverBodyIdB : row.m_solverBodyIdA;
        if (touch.m_other < 0) torsion.m_spin = sideOf(bullet, other, proxyOf).m_angular;
        touch.m_torsion = static_cast<int>(problem.m_torsions.size());
        problem.m_torsions.push_back(torsion);
        m_torsions.push_back({begin, end - begin, m_contacts[m_contactOf[contact]].m_sign});
    }
}

// Up to three consecutive rows of a constraint with equal compliance form a joint.
void BulletRows::appendJoints(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem)
{
    int axis = 0;
    const btSolverConstraint* last = nullptr;
    for (int k = 0; k < bullet.m_joints.size(); ++k)
    {
        const btSolverConstraint& row = bullet.m_joints[k];
        const RowSide a = sideOf(bullet, row.m_solverBodyIdA, proxyOf),
                      b = sideOf(bullet, row.m_solverBodyIdB, proxyOf);
        if (a.m_proxy < 0 && b.m_proxy < 0) continue;
        double beyond = 0;
        const bool isBad = !targetBeyond(row, beyond) || !(row.m_lowerLimit <= row.m_upperLimit);
        m_anyBad = m_anyBad || row.m_cfm < 0 || (isBad && row.m_jacDiagABInv != 0);
        if (isBad) continue;
        const bool continues = last && axis < 3 && last->m_originalContactPoint == row.m_originalContactPoint &&
                               complianceOf(*last) == complianceOf(row);
        if (!continues)
        {
            axis = 0;
            Joint joint;
            joint.m_limit = {};
            joint.m_compliance = complianceOf(row);
            joint.m_softness = kJointSoftness;
            joint.m_a.m_rigidProxy = a.m_proxy;
            joint.m_b.m_rigidProxy = b.m_proxy;
            joint.m_a.m_jacobian = static_cast<int>(problem.m_jacobians.size());
            joint.m_b.m_jacobian = joint.m_a.m_jacobian + 1;
            problem.m_jacobians.resize(problem.m_jacobians.size() + 2);
            problem.m_joints.push_back(joint);
        }
        Joint& joint = problem.m_joints.back();
        const RowLimits limits(double(row.m_lowerLimit), double(row.m_upperLimit));
        const RowOfAxis of = {k, static_cast<int>(problem.m_joints.size() - 1), axis, limits.m_sign};
        const Vec3 linearA = vec3(row.m_contactNormal1), angularA = vec3(row.m_relpos1CrossNormal);
        const Vec3 linearB = vec3(row.m_contactNormal2), angularB = vec3(row.m_relpos2CrossNormal);
        double target = beyond;
        if (a.m_proxy >= 0) target += dot(linearA, a.m_linear) + dot(angularA, a.m_angular);
        if (b.m_proxy >= 0) target += dot(linearB, b.m_linear) + dot(angularB, b.m_angular);
        joint.m_wanted[axis] = of.m_sign * target;
        joint.m_limit[axis] = limits.m_upper;
        joint.m_lower[axis] = limits.m_lower;
        RigidJacobian &ofA = problem.m_jacobians[joint.m_a.m_jacobian],
                      &ofB = problem.m_jacobians[joint.m_b.m_jacobian];
        for (int i = 0; i < 3; ++i)
        {
            ofA.m_linear(axis, i) = of.m_sign * linearA[i];
            ofA.m_angular(axis, i) = of.m_sign * angularA[i];
            ofB.m_linear(axis, i) = -of.m_sign * linearB[i];
            ofB.m_angular(axis, i) = -of.m_sign * angularB[i];
        }
        m_axes.push_back(of);
        last = &row;
        ++axis;
    }
}

void BulletRows::takeBack(const BulletConstraints& bullet, ContactProblem& problem)
{
    for (std::size_t k = 0; k < m_contacts.size(); ++k)
    {
        const RowOfContact& contact = m_contacts[k];
        const RigidContact& touch = problem.m_rigidContacts[m_firstContact + k];
        const Vec3 onA = contact.m_sign * touch.m_impulse;
        btSolverConstraint& row = bullet.m_contacts[contact.m_row];
        row.m_appliedImpulse = btScalar(dot(touch.m_impulse, touch.m_normal));
        if (row.m_frictionIndex + 1 >= bullet.m_friction.size()) continue;
        double first = 0, second = 0;
        contact.m_plane.split(onA, first, second);
        bullet.m_friction[row.m_frictionIndex].m_appliedImpulse = btScalar(first);
        bullet.m_friction[row.m_frictionIndex + 1].m_appliedImpulse = btScalar(second);
    }
    for (std::size_t k = 0; k < m_torsions.size(); ++k)
    {
        const Vec3 onA = m_torsions[k].m_sign * problem.m_torsions[m_firstTorsion + k].m_impulse;
        for (int r = m_torsions[k].m_first; r < m_torsions[k].m_first + m_torsions[k].m_count; ++r)
        {
            btSolverConstraint& row = bullet.m_torsions[r];
            const Vec3 axis = vec3(row.m_relpos1CrossNormal);
            row.m_appliedImpulse = btScalar(dot(axis, axis) > 0 ? dot(onA, axis) / dot(axis, axis) : 0);
        }
    }
    for (const RowOfAxis& axis : m_axes)
        bullet.m_joints[axis.m_row].m_appliedImpulse =
            btScalar(axis.m_sign * problem.m_joints[axis.m_joint].m_impulse[axis.m_axis]);
    problem.m_rigidContacts.resize(m_firstContact);
    problem.m_torsions.resize(m_firstTorsion);
    problem.m_joints.resize(m_firstJoint);
    problem.m_jacobians.resize(m_firstJacobian);
}

}  // namespace bullet_fem
