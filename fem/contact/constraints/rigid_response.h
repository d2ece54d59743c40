// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/contact/contact_problem.h"
#include "fem/contact/constraints/contact_row.h"

namespace bullet_fem
{

/// Calls add(k, linear, angular) with the velocity changes [m/s], [rad/s] of every rigid proxy k that moves by an
/// impulse [N s] and an angular impulse [N m s] about its centre on one rigid proxy.
template <class Add>
void respond(const ContactProblem& problem, int rigidProxy, const Vec3& impulse, const Vec3& angular, const Add& add)
{
    const RigidProxy& o = problem.m_rigidProxies[rigidProxy];
    if (o.m_responseCount == 0) return add(rigidProxy, scaled(o.m_inverseMass, impulse), o.m_inverseInertia * angular);
    for (int k = o.m_firstResponse; k < o.m_firstResponse + o.m_responseCount; ++k)
    {
        const RigidResponse& r = problem.m_responses[k];
        add(r.m_rigidProxy, r.m_linear * impulse + r.m_linearOfAngular * angular,
            r.m_angularOfLinear * impulse + r.m_angular * angular);
    }
}

/// The velocity of a side on a rigid proxy as a matrix on that proxy's linear and angular velocity.
inline RigidJacobian jacobianOf(const ContactProblem& problem, const ConstraintSide& side)
{
    if (side.m_jacobian >= 0) return problem.m_jacobians[side.m_jacobian];
    if (side.m_angular) return {{}, Mat3::identity()};
    return {Mat3::identity(), -1 * crossMatrix(side.m_arm)};
}

/// Response of the velocity at `of` to an impulse at `from`, two sides on rigid proxies [1/kg]; angular sides have
/// spins and angular impulses [1/(kg m)], [1/(kg m2)].
inline Mat3 rigidCompliance(const ContactProblem& problem, const ConstraintSide& of, const ConstraintSide& from)
{
    const RigidProxy& o = problem.m_rigidProxies[from.m_rigidProxy];
    if (o.m_responseCount == 0 && (of.m_rigidProxy != from.m_rigidProxy || !o.canMove())) return {};
    const RigidJacobian to = jacobianOf(problem, of), by = jacobianOf(problem, from);
    const Mat3 linear = transpose(by.m_linear), angular = transpose(by.m_angular);
    const Vec3& m = o.m_inverseMass;
    const Mat3 inverseMass = Mat3::fromColumns({m.x, 0, 0}, {0, m.y, 0}, {0, 0, m.z});
    if (o.m_responseCount == 0)
        return to.m_linear * (inverseMass * linear) + to.m_angular * (o.m_inverseInertia * angular);
    for (int k = o.m_firstResponse; k < o.m_firstResponse + o.m_responseCount; ++k)
    {
        const RigidResponse& r = problem.m_responses[k];
        if (r.m_rigidProxy == of.m_rigidProxy)
            return to.m_linear * (r.m_linear * linear + r.m_linearOfAngular * angular) +
                   to.m_angular * (r.m_angularOfLinear * linear + r.m_angular * angular);
    }
    return {};
}

}  // namespace bullet_fem
