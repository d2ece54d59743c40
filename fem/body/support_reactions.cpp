// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/support_reactions.h"

#include <algorithm>
#include <cstring>

#include "fem/body/rigid_sums.h"

namespace bullet_fem
{

SupportReactions::SupportReactions(const BodyModel& model)
{
    const std::vector<unsigned char>& fixed = model.factorInput().m_fixed;
    const auto count = static_cast<std::size_t>(std::count(fixed.begin(), fixed.end(), 1));
    if (count > 0) makeRoom(model, count);
}

void SupportReactions::makeRoom(const BodyModel& model, std::size_t fixed)
{
    const auto nodes = static_cast<std::size_t>(model.nodeCount());
    for (std::vector<Vec3>* vectors : {&m_beginPosition, &m_endPosition, &m_beginVelocity, &m_endVelocity, &m_from,
                                       &m_solvedVelocity, &m_change, &m_product})
        vectors->reserve(nodes);
    m_known.reserve(fixed);
    m_reactions.reserve(fixed);
    m_components.reserve(model.mesh().componentCount());
}

void SupportReactions::begin(const BodyModel& model, const BodyState& state, const Step& step)
{
    m_stage = Stage::nothing;
    m_needsSmoothing = m_isNewton = false;
    if (!std::memchr(state.m_fixed.data(), 1, state.m_fixed.size())) return;
    if (m_product.capacity() == 0) makeRoom(model, 0);
    m_stage = Stage::step;
    m_model = &model;
    m_step = step;
    m_beginPosition = state.m_x;
    m_beginVelocity = state.m_v;
    m_components.assign(model.mesh().componentCount(), Component());
    m_reactions.clear();
    for (std::size_t i = 0; i < state.m_fixed.size(); ++i)
        if (state.m_fixed[i] && !model.mesh().isLoose(static_cast<int>(i)))
            m_reactions.push_back({static_cast<int>(i), {}, {}});
    m_known.assign(m_reactions.size(), Vec3());
}

void SupportReactions::noteKick(const std::vector<Vec3>& velocity)
{
    if (isNoting()) m_from = velocity;
}

void SupportReactions::noteRightSide(const std::vector<Vec3>& b)
{
    for (std::size_t k = 0; k < m_known.size(); ++k) m_known[k] = b[m_reactions[k].m_node];
}

void SupportReactions::noteForces(const std::vector<Vec3>& loads, const std::vector<Vec3>& force)
{
    m_isNewton = true;
    for (std::size_t k = 0; k < m_known.size(); ++k)
    {
        const int node = m_reactions[k].m_node;
        m_known[k] = loads[node] + m_step.m_length * force[node];
    }
}

void SupportReactions::noteSolved(const std::vector<Vec3>& velocity)
{
    if (m_isNewton) m_from = velocity;
}

void SupportReactions::add(const std::vector<Vec3>& impulses)
{
    for (std::size_t k = 0; k < m_known.size(); ++k) m_known[k] += impulses[m_reactions[k].m_node];
}

void SupportReactions::addOutside(int component, const Vec3& impulse, const Vec3& angularImpulse)
{
    m_components[component].m_linear += impulse;
    m_components[component].m_angular += angularImpulse;
}

void SupportReactions::changeVelocity(const std::vector<Vec3>& change)
{
    if (!isNoting()) return;
    for (std::size_t i = 0; i < change.size(); ++i)
    {
        m_beginVelocity[i] += change[i];
        m_from[i] += change[i];
    }
}

void SupportReactions::noteEnd(const std::vector<Vec3>& velocity, const std::vector<Vec3>& unresolved, double share)
{
    m_change.resize(velocity.size());
    for (std::size_t i = 0; i < velocity.size(); ++i)
    {
        const Vec3 gained = velocity[i] - m_from[i];
        m_change[i] = m_needsSmoothing ? gained + share * (m_change[i] - unresolved[i]) : gained;
    }
    if (m_step.m_damping > 0 || m_step.m_toFrame > 0) m_solvedVelocity = velocity;
}

void SupportReactions::finish(const BodyState& state)
{
    m_endPosition = state.m_x;
    m_endVelocity = state.m_v;
    m_stage = Stage::ended;
}

void SupportReactions::find(const std::vector<double>& scaledMass, const StepLoads& loads)
{
    findImpulses(scaledMass);
    centre(scaledMass);
    findMissing(scaledMass, loads);
    shareOutMissing(scaledMass);
    m_stage = Stage::found;
}

// As impulses [N s] for now: those of the rows of A.
void SupportReactions::findImpulses(const std::vector<double>& scaledMass)
{
    for (std::size_t k = 0; k < m_known.size(); ++k)
    {
        const auto p = static_cast<std::size_t>(m_reactions[k].m_node);
        const Vec3 gained = m_endVelocity[p] - m_beginVelocity[p];
        m_reactions[k].m_point = middle(p);
        m_reactions[k].m_force = m_product[p] + scaledMass[p] * (gained - m_change[p]) - m_known[k];
    }
}

// Finds centre and inertia of the fixed nodes of every component. Their masses are taken times 1 + h alpha.
void SupportReactions::centre(const std::vector<double>& scaledMass)
{
    for (const NodeReaction& r : m_reactions)
    {
        componentOf(r.m_node).m_fixedMass += scaledMass[r.m_node];
        componentOf(r.m_node).m_origin += scaledMass[r.m_node] * r.m_point;
    }
    for (Component& c : m_components)
        if (c.m_fixedMass > 0) c.m_origin *= 1 / c.m_fixedMass;
    for (const NodeReaction& r : m_reactions)
    {
        Component& c = componentOf(r.m_node);
        const Vec3 lever = r.m_point - c.m_origin;
        c.m_inertia += scaledMass[r.m_node] * (Mat3::diagonal(dot(lever, lever)) - outer(lever, lever));
    }
}

// The momenta that components have gained beyond those of loads, of contacts and joints, and of the rows of A.
void SupportReactions::findMissing(const std::vector<double>& scaledMass, const StepLoads& loads)
{
    for (Component& c : m_components)
    {
        c.m_angular = cross(c.m_origin, c.m_linear) - c.m_angular;
        c.m_linear *= -1;
    }
    for (const NodeReaction& r : m_reactions)
    {
        componentOf(r.m_node).m_linear -= r.m_force;
        componentOf(r.m_node).m_angular -= cross(r.m_point - componentOf(r.m_node).m_origin, r.m_force);
    }
    const double h = m_step.m_length, rate = m_step.m_damping + m_step.m_toFrame, inverse = 1 / (1 + h * rate);
    for (std::size_t i = 0; i < m_change.size(); ++i)
    {
        Component& c = componentOf(i);
        if (!(c.m_fixedMass > 0)) continue;
        const double m = inverse * scaledMass[i];
        Vec3 impulse = h * loads.m_force[i];
        if (rate > 0) impulse -= h * rate * m * m_solvedVelocity[i];
        if (m_step.m_toFrame > 0) impulse += h * m_step.m_toFrame * m * loads.m_frameVelocity[i];
        const Vec3 lever = middle(i) - c.m_origin, begin = m_beginPosition[i] - c.m_origin,
                   end = m_endPosition[i] - c.m_origin;
        c.m_linear += m * (m_endVelocity[i] - m_beginVelocity[i]) - impulse;
        c.m_angular += m * (cross(end, m_endVelocity[i]) - cross(begin, m_beginVelocity[i])) - cross(lever, impulse);
        c.m_mass += m;
        c.m_spread += m * dot(lever, lever);
    }
}

// As impulses that a rigid motion of the fixed nodes' masses would make; and all impulses become forces.
void SupportReactions::shareOutMissing(const std::vector<double>& scaledMass)
{
    for (Component& c : m_components)
    {
        if (!(c.m_fixedMass > 0)) continue;
        c.m_shift = (1 / c.m_fixedMass) * c.m_linear;
        c.m_turn =
            spinOf(c.m_inertia, c.m_angular, kShortestLever * kShortestLever * c.m_fixedMass * c.m_spread / c.m_mass);
    }
    for (NodeReaction& r : m_reactions)
    {
        const Component& c = componentOf(r.m_node);
        const Vec3 motion = c.m_shift + cross(c.m_turn, r.m_point - c.m_origin);
        r.m_force = (1 / m_step.m_length) * (r.m_force + scaledMass[r.m_node] * motion);
    }
}

}  // namespace bullet_fem
