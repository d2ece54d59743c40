// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact/rebound.h"

#include <algorithm>
#include <cmath>

#include "fem/body/rigid_momentum.h"
#include "fem/contact/constraints/rigid_response.h"

namespace bullet_fem
{
namespace
{

// Sweeps over the rebounds of a group at most, and the change of a speed as a share of the largest one that ends them
// [-].
constexpr int kReboundSweeps = 200;
constexpr double kReboundError = 1e-9;

// Rebounds and proxies of a system for which memory is reserved.
constexpr int kUsualRebounds = 16, kUsualProxies = 64;

// Gives an impulse along a rebound's normal [N s] to both of its proxies.
void apply(ContactProblem& problem, const Rebound& rebound, double impulse)
{
    std::vector<RigidProxy>& proxies = problem.m_rigidProxies;
    const auto add = [&proxies](int k, const Vec3& linear, const Vec3& angular)
    {
        proxies[k].m_linearVelocity += linear;
        proxies[k].m_angularVelocity += angular;
    };
    const auto push = [&](int k, const Vec3& linear)
    { respond(problem, k, linear, cross(rebound.m_point - proxies[k].m_center, linear), add); };
    push(rebound.m_first, impulse * rebound.m_normal);
    push(rebound.m_second, -impulse * rebound.m_normal);
}

}  // namespace

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

double separationSpeed(const ContactProblem& problem, const Rebound& rebound)
{
    const auto velocityOf = [&](int k) { return problem.m_rigidProxies[k].velocityAt(rebound.m_point); };
    return dot(rebound.m_normal, velocityOf(rebound.m_first) - velocityOf(rebound.m_second));
}

ReboundSystem::ReboundSystem()
{
    m_scratch.m_rigidProxies.reserve(kUsualProxies);
    m_compliance.reserve(std::size_t(kUsualRebounds) * kUsualRebounds);
    m_missing.reserve(kUsualRebounds);
}

void ReboundSystem::set(const ContactProblem& problem, const std::vector<Rebound>& rebounds)
{
    m_count = static_cast<int>(rebounds.size());
    m_scratch.m_rigidProxies.assign(problem.m_rigidProxies.begin(), problem.m_rigidProxies.end());
    m_scratch.m_responses.assign(problem.m_responses.begin(), problem.m_responses.end());
    m_compliance.assign(std::size_t(m_count) * m_count, 0);
    for (int from = 0; from < m_count; ++from)
    {
        for (RigidProxy& proxy : m_scratch.m_rigidProxies) proxy.m_linearVelocity = proxy.m_angularVelocity = {};
        apply(m_scratch, rebounds[from], 1);
        for (int of = 0; of < m_count; ++of)
            m_compliance[of * m_count + from] = separationSpeed(m_scratch, rebounds[of]);
    }
}

// Projected Gauss-Seidel. An impulse of all, times c, adds the energy c r . s + c^2 r . W r / 2.
bool ReboundSystem::give(ContactProblem& problem, std::vector<Rebound>& rebounds, double energy)
{
    m_missing.resize(m_count);
    double most = 0;
    for (int p = 0; p < m_count; ++p)
    {
        rebounds[p].m_impulse = 0;
        m_missing[p] = rebounds[p].m_speed - separationSpeed(problem, rebounds[p]);
        most = std::max(most, std::abs(m_missing[p]));
    }
    for (int sweep = 0; sweep < kReboundSweeps; ++sweep)
    {
        double change = 0;
        for (int p = 0; p < m_count; ++p)
        {
            const double own = compliance(p, p);
            if (!(own > 0)) continue;
            double missing = m_missing[p];
            for (int q = 0; q < m_count; ++q)
                if (q != p) missing -= compliance(p, q) * rebounds[q].m_impulse;
            const double impulse = std::max(missing / own, 0.0);
            change = std::max(change, std::abs(impulse - rebounds[p].m_impulse) * own);
            rebounds[p].m_impulse = impulse;
        }
        if (!(change > kReboundError * most)) break;
    }
    double linear = 0, quadratic = 0;
    for (int p = 0; p < m_count; ++p)
    {
        linear += rebounds[p].m_impulse * (rebounds[p].m_speed - m_missing[p]);
        for (int q = 0; q < m_count; ++q) quadratic += rebounds[p].m_impulse * compliance(p, q) * rebounds[q].m_impulse;
    }
    if (!(quadratic > 0)) return false;
    const double root = std::sqrt(linear * linear + 2 * quadratic * std::max(energy, 0.0));
    const double scale = std::min(1.0, (root - linear) / quadratic);
    if (!(scale > 0)) return false;
    for (int p = 0; p < m_count; ++p)
    {
        rebounds[p].m_impulse *= scale;
        apply(problem, rebounds[p], rebounds[p].m_impulse);
    }
    return true;
}

}  // namespace bullet_fem
