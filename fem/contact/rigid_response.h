// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/contact/contact_problem.h"

namespace bullet_fem
{

/// Calls add(k, linear, angular) with the changes of velocity [m/s], [rad/s] of every rigid proxy k that an impulse [N
/// s] and an angular impulse [N m s] about its centre on one rigid proxy moves.
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

/// What an impulse on a rigid proxy does to the velocity of its own point at `arm` [m] from its centre [1/kg], or, with
/// `angularEnd`, what an angular one does to its spin [1/(kg m2)].
inline Mat3 obstacleCompliance(const ContactProblem& problem, int rigidProxy, const Vec3& arm, bool angularEnd)
{
    const RigidProxy& o = problem.m_rigidProxies[rigidProxy];
    const Mat3 r = crossMatrix(arm);
    if (o.m_responseCount == 0)
    {
        if (angularEnd) return o.m_inverseInertia;
        const Vec3& m = o.m_inverseMass;
        Mat3 w = Mat3::fromColumns({m.x, 0, 0}, {0, m.y, 0}, {0, 0, m.z});
        w -= r * o.m_inverseInertia * r;
        return w;
    }
    Mat3 w;
    for (int k = o.m_firstResponse; k < o.m_firstResponse + o.m_responseCount; ++k)
    {
        const RigidResponse& own = problem.m_responses[k];
        if (own.m_rigidProxy != rigidProxy) continue;
        if (angularEnd) return own.m_angular;
        w = own.m_linear + own.m_linearOfAngular * r;
        w -= r * own.m_angularOfLinear + r * own.m_angular * r;
    }
    return w;
}

}  // namespace bullet_fem
