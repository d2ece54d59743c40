// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/contact/contact_problem.h"
#include "fem/contact/contact_row.h"

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

/// Response of the velocity at `of` to an impulse at `from`, two sides on rigid proxies [1/kg]; angular sides have
/// spins and angular impulses [1/(kg m)], [1/(kg m2)].
inline Mat3 rigidCompliance(const ContactProblem& problem, const ConstraintSide& of, const ConstraintSide& from)
{
    const RigidProxy& o = problem.m_rigidProxies[from.m_rigidProxy];
    if (o.m_responseCount == 0 && (of.m_rigidProxy != from.m_rigidProxy || !o.canMove())) return {};
    const Mat3 arm = crossMatrix(of.m_arm), lever = crossMatrix(from.m_arm);
    const auto between =
        [&](const Mat3& linear, const Mat3& linearOfAngular, const Mat3& angularOfLinear, const Mat3& angular)
    {
        const Mat3 spin = from.m_angular ? angular : angularOfLinear + angular * lever;
        if (of.m_angular) return spin;
        Mat3 w = from.m_angular ? linearOfAngular : linear + linearOfAngular * lever;
        w -= arm * spin;
        return w;
    };
    const Vec3& m = o.m_inverseMass;
    const Mat3 inverseMass = Mat3::fromColumns({m.x, 0, 0}, {0, m.y, 0}, {0, 0, m.z});
    if (o.m_responseCount == 0) return between(inverseMass, {}, {}, o.m_inverseInertia);
    for (int k = o.m_firstResponse; k < o.m_firstResponse + o.m_responseCount; ++k)
    {
        const RigidResponse& r = problem.m_responses[k];
        if (r.m_rigidProxy == of.m_rigidProxy)
            return between(r.m_linear, r.m_linearOfAngular, r.m_angularOfLinear, r.m_angular);
    }
    return {};
}

}  // namespace bullet_fem
