// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact/rebound.h"

#include <algorithm>
#include <cmath>

#include "fem/body/rigid_momentum.h"
#include "fem/contact/constraints/rigid_response.h"

namespace bullet_fem
{

RigidProxy wholeMotion(const Body& body, int component)
{
    const BodyState& s = body.m_state;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    RigidProxy whole;
    double mass = 0;
    bool isFree = true;
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        if (componentOf[i] != component) continue;
        isFree = isFree && !s.m_fixed[i];
        mass += s.m_mass[i];
        whole.m_center += s.m_mass[i] * s.m_x[i];
        whole.m_linearVelocity += s.m_mass[i] * s.m_v[i];
    }
    whole.m_center *= 1 / mass;
    whole.m_linearVelocity *= 1 / mass;
    Mat3 inertia;
    Vec3 momentum;
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        if (componentOf[i] != component) continue;
        const Vec3 r = s.m_x[i] - whole.m_center;
        inertia += s.m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
        momentum += s.m_mass[i] * cross(r, s.m_v[i]);
    }
    const Mat3 inverseInertia = RigidMomentum::inverseInertia(inertia, mass, whole.m_center);
    whole.m_angularVelocity = inverseInertia * momentum;
    if (!isFree) return whole;
    whole.m_inverseMass = {1 / mass, 1 / mass, 1 / mass};
    whole.m_inverseInertia = inverseInertia;
    return whole;
}

void addWholeMotion(Body& body, int component, const Vec3& center, const Vec3& linear, const Vec3& angular)
{
    BodyState& s = body.m_state;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
        if (componentOf[i] == component && !s.m_fixed[i]) s.m_v[i] += linear + cross(angular, s.m_x[i] - center);
}

double rigidMobility(const ContactProblem& problem, int rigidProxy, const Vec3& point, const Vec3& direction)
{
    ConstraintSide end;
    end.m_rigidProxy = rigidProxy;
    end.m_arm = point - problem.m_rigidProxies[rigidProxy].m_center;
    return dot(direction, rigidCompliance(problem, end, end) * direction);
}

Vec3 giveRebound(ContactProblem& problem, const Rebound& rebound)
{
    std::vector<RigidProxy>& proxies = problem.m_rigidProxies;
    const Vec3& n = rebound.m_normal;
    double compliance = 0, speed = 0;
    for (const int k : {rebound.m_first, rebound.m_second})
    {
        compliance += rigidMobility(problem, k, rebound.m_point, n);
        speed += (k == rebound.m_first ? 1 : -1) * dot(n, proxies[k].velocityAt(rebound.m_point));
    }
    if (!(compliance > 0)) return {};
    // An impulse that changes the separation speed from s0 to s adds the energy (s^2 - s0^2) / (2 compliance).
    const double maxSquared = speed * speed + 2 * compliance * std::max(rebound.m_energy, 0.0);
    const double wanted = std::min(rebound.m_speed, std::sqrt(maxSquared));
    if (!(wanted > speed)) return {};
    const Vec3 impulse = ((wanted - speed) / compliance) * n;
    const auto add = [&proxies](int k, const Vec3& linear, const Vec3& angular)
    {
        proxies[k].m_linearVelocity += linear;
        proxies[k].m_angularVelocity += angular;
    };
    const auto push = [&](int k, const Vec3& by)
    { respond(problem, k, by, cross(rebound.m_point - proxies[k].m_center, by), add); };
    push(rebound.m_first, impulse);
    push(rebound.m_second, -impulse);
    return impulse;
}

}  // namespace bullet_fem
