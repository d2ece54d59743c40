// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <array>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/rigid/multibody_row.h"
#include "bullet_bridge/rigid/multibody_rows.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr int kAxes = 3;  // rows of a joint

// Added compliance of rows as a multiple of their own, so that redundant ones share a load. A motor yields by this
// share of the velocity that its load would give the joint alone: with that of rigid bodies' joints, lifts sank [-].
constexpr double kRowSoftness = 1e-6;

bool isUsable(const btMultiBodyJacobianData& data, const MultiBodyRow& row)
{
    double beyond = 0;
    return targetBeyond(row, beyond) && row.m_lowerLimit <= row.m_upperLimit && isFiniteRow(data, row);
}

// A solver body without the effect of forces, which Bullet's rows of multibody joints do not know; their target is the
// velocity after the solve nevertheless.
RowSide bodySide(const MultiBodyRows::Scope& scope, int solverBody)
{
    if (solverBody < 0 || solverBody >= scope.m_rigid.m_bodies.size()) return {};
    RowSide side = sideOf(scope.m_rigid, solverBody, scope.m_proxyOf);
    side.m_linear = vec3(scope.m_rigid.m_bodies[solverBody].m_linearVelocity);
    side.m_angular = vec3(scope.m_rigid.m_bodies[solverBody].m_angularVelocity);
    return side;
}

}  // namespace

// Up to three consecutive rows of a constraint between the same bodies form a joint, but not limits and the like, which
// act in one direction: the two limits of a joint depend on each other.
int MultiBodyRows::endOfJoint(const Scope& scope, int begin) const
{
    const btMultiBodyConstraintArray& rows = scope.m_links.m_joints;
    const Row& first = rows[begin];
    const auto isOpen = [&](const Row& row)
    {
        return isUsable(scope.m_links.m_data, row) &&
               RowLimits(double(row.m_lowerLimit), double(row.m_upperLimit)).areTwoSided();
    };
    const auto bodyOf = [](const btMultiBody* links, int solverBody) { return links ? -1 : solverBody; };
    const auto continues = [&](const Row& row)
    {
        return row.m_orgConstraint == first.m_orgConstraint && row.m_multiBodyA == first.m_multiBodyA &&
               row.m_multiBodyB == first.m_multiBodyB &&
               bodyOf(row.m_multiBodyA, row.m_solverBodyIdA) == bodyOf(first.m_multiBodyA, first.m_solverBodyIdA) &&
               bodyOf(row.m_multiBodyB, row.m_solverBodyIdB) == bodyOf(first.m_multiBodyB, first.m_solverBodyIdB) &&
               isOpen(row) && complianceOf(row) == complianceOf(first);
    };
    int end = begin + 1;
    if (!isOpen(first)) return end;
    while (end < rows.size() && end < begin + kAxes && continues(rows[end])) ++end;
    return end;
}

void MultiBodyRows::appendJoint(const Scope& scope, int begin, int end)
{
    ContactProblem& problem = scope.m_problem;
    const Row& first = scope.m_links.m_joints[begin];
    if (!isUsable(scope.m_links.m_data, first)) return;
    Joint joint;
    joint.m_limit = {};
    joint.m_compliance = complianceOf(first);
    joint.m_softness = kRowSoftness;
    const auto setSide = [&](JointEnd& side, const btMultiBody* links, int solverBody)
    {
        side.m_rigidProxy =
            links ? addCoordinates(scope, begin, end, &side == &joint.m_a) : bodySide(scope, solverBody).m_proxy;
        if (links || side.m_rigidProxy < 0) return;
        side.m_jacobian = static_cast<int>(problem.m_jacobians.size());
        problem.m_jacobians.emplace_back();
    };
    setSide(joint.m_a, first.m_multiBodyA, first.m_solverBodyIdA);
    if (!isOneBody(first)) setSide(joint.m_b, first.m_multiBodyB, first.m_solverBodyIdB);
    for (int k = begin; k < end; ++k) appendAxis(scope, k, k - begin, joint);
    problem.m_joints.push_back(joint);
}

// Adds the proxy of a side: its velocity is that of the rows with the signs of the joint. The joint's relative velocity
// is that of its first side less that of its second, Bullet's rows have the sum.
int MultiBodyRows::addCoordinates(const Scope& scope, int begin, int end, bool ofA)
{
    const btMultiBodyJacobianData& data = scope.m_links.m_data;
    const Row& first = scope.m_links.m_joints[begin];
    btMultiBody& body = ofA ? *first.m_multiBodyA : *first.m_multiBodyB;
    const int n = coordinatesOf(body);
    m_rows.assign(2 * kAxes * n, 0);
    std::array<const btScalar*, kAxes> jacobians = {}, answers = {};
    for (int k = begin; k < end; ++k)
    {
        const Row& row = scope.m_links.m_joints[k];
        const btScalar sign = btScalar(RowLimits(double(row.m_lowerLimit), double(row.m_upperLimit)).m_sign);
        btScalar *jacobian = &m_rows[(k - begin) * n], *answer = &m_rows[(kAxes + k - begin) * n];
        const auto add = [&](int from, btScalar weight)
        {
            for (int i = 0; i < n; ++i) jacobian[i] += weight * data.m_jacobians[from + i];
            for (int i = 0; i < n; ++i) answer[i] += weight * data.m_deltaVelocitiesUnitImpulse[from + i];
        };
        add(ofA ? row.m_jacAindex : row.m_jacBindex, ofA ? sign : -sign);
        if (isOneBody(row)) add(row.m_jacBindex, sign);
        jacobians[k - begin] = jacobian;
        answers[k - begin] = answer;
    }
    RigidProxy added;
    const int index = static_cast<int>(scope.m_problem.m_rigidProxies.size());
    scope.m_proxies.links().addRows(index, body, jacobians, answers, added);
    scope.m_problem.m_rigidProxies.push_back(added);
    return index;
}

void MultiBodyRows::appendAxis(const Scope& scope, int k, int axis, Joint& joint)
{
    const Row& row = scope.m_links.m_joints[k];
    const RowLimits limits(double(row.m_lowerLimit), double(row.m_upperLimit));
    double target = 0;
    targetBeyond(row, target);
    target += velocityOf(scope.m_links.m_data, row);
    const auto setSide = [&](const JointEnd& end, double sign, int solverBody, const Vec3& linear, const Vec3& angular)
    {
        if (end.m_jacobian < 0) return;
        RigidJacobian& jacobian = scope.m_problem.m_jacobians[end.m_jacobian];
        const RowSide side = bodySide(scope, solverBody);
        target += dot(linear, side.m_linear) + dot(angular, side.m_angular);
        for (int i = 0; i < 3; ++i)
        {
            jacobian.m_linear(axis, i) = sign * linear[i];
            jacobian.m_angular(axis, i) = sign * angular[i];
        }
    };
    setSide(joint.m_a, limits.m_sign, row.m_solverBodyIdA, vec3(row.m_contactNormal1), vec3(row.m_relpos1CrossNormal));
    setSide(joint.m_b, -limits.m_sign, row.m_solverBodyIdB, vec3(row.m_contactNormal2), vec3(row.m_relpos2CrossNormal));
    joint.m_wanted[axis] = limits.m_sign * target;
    joint.m_limit[axis] = limits.m_upper;
    joint.m_lower[axis] = limits.m_lower;
    m_axes.push_back({k, static_cast<int>(scope.m_problem.m_joints.size()), axis, limits.m_sign});
}

}  // namespace bullet_fem
