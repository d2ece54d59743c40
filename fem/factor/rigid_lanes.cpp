// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/rigid_lanes.h"

#include <algorithm>

#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

// Maximum distance of fixed nodes from their line, relative to their extent.
constexpr double kCollinearShare = 1e-9;

}  // namespace

RigidLanes::RigidLanes(const BodyModel& model)
    : m_model(model),
      m_damped(1 + model.factorInput().m_step * model.shape().m_material.m_massDamping),
      m_components(model.mesh().componentCount()),
      m_taken(m_components.size()),
      m_found(m_taken)
{
    findCenters();
    const std::vector<int>& component = model.mesh().nodeComponent();
    const std::vector<Vec3>& X = model.mesh().restPositions();
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        Component& rigid = m_components[component[i]];
        const Vec3 r = X[i] - rigid.m_center;
        rigid.m_inverseInertia += model.factorInput().m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
    }
    for (Component& rigid : m_components) rigid.m_inverseInertia = inverse(rigid.m_inverseInertia);
    findAxes();
}

// Centre of mass, or any fixed node.
void RigidLanes::findCenters()
{
    const std::vector<int>& component = m_model.mesh().nodeComponent();
    const std::vector<Vec3>& X = m_model.mesh().restPositions();
    std::vector<double> mass(m_components.size());
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        Component& rigid = m_components[component[i]];
        if (m_model.factor().position(static_cast<int>(i)) < 0 && rigid.m_fixed++ == 0) rigid.m_center = X[i];
        if (rigid.m_fixed > 0) continue;
        mass[component[i]] += m_model.factorInput().m_mass[i];
        rigid.m_center += m_model.factorInput().m_mass[i] * X[i];
    }
    for (std::size_t k = 0; k < m_components.size(); ++k)
    {
        if (m_components[k].m_fixed > 0) continue;
        m_components[k].m_inverseMass = 1 / mass[k];
        m_components[k].m_center *= 1 / mass[k];
    }
}

// Removes from the inverse inertia the rotations that several fixed nodes prevent.
void RigidLanes::findAxes()
{
    const std::vector<int>& component = m_model.mesh().nodeComponent();
    const std::vector<Vec3>& X = m_model.mesh().restPositions();
    std::vector<Vec3> axis(m_components.size());  // to the farthest fixed node
    const auto forEachFixed = [&](const auto& visit)
    {
        for (std::size_t i = 0; i < X.size(); ++i)
            if (m_model.factor().position(static_cast<int>(i)) < 0)
                visit(m_components[component[i]], axis[component[i]], X[i] - m_components[component[i]].m_center);
    };
    forEachFixed(
        [](const Component&, Vec3& a, const Vec3& r)
        {
            if (dot(r, r) > dot(a, a)) a = r;
        });
    for (std::size_t k = 0; k < m_components.size(); ++k)
    {
        if (!(dot(axis[k], axis[k]) > 0)) continue;
        const Vec3 a = (1 / norm(axis[k])) * axis[k];
        m_components[k].m_inverseInertia = (1 / dot(a, inverse(m_components[k].m_inverseInertia) * a)) * outer(a, a);
    }
    forEachFixed(
        [](Component& rigid, const Vec3& a, const Vec3& r)
        {
            if (norm(cross(a, r)) > kCollinearShare * dot(a, a)) rigid.m_inverseInertia = {};
        });
}

// Calls visit(component, r, mass, row) for every free node of a movable component: r from its centre, row the start of
// its entries.
template <class Visit>
void RigidLanes::forEachRow(const Visit& visit) const
{
    for (int i = 0; i < m_model.nodeCount(); ++i)
    {
        const int rigid = m_model.mesh().nodeComponent()[i];
        if (m_model.factor().position(i) < 0 || !moves(m_components[rigid])) continue;
        visit(rigid, m_model.mesh().restPositions()[i] - m_components[rigid].m_center, m_model.factorInput().m_mass[i],
              3 * static_cast<std::size_t>(m_model.factor().position(i)) * kPanelLanes);
    }
}

// Sums the rigid motions that impulses cause in undamped bodies, or that velocities contain.
void RigidLanes::sum(const float* values, bool ofVelocities, std::vector<Motions>& motions) const
{
    std::fill(motions.begin(), motions.end(), Motions());
    forEachRow(
        [&](int rigid, const Vec3& r, double mass, std::size_t row)
        {
            const double weight = ofVelocities ? mass : 1;
            const float *x = values + row, *y = x + kPanelLanes, *z = y + kPanelLanes;
            Motions& m = motions[rigid];
            for (int k = 0; k < kPanelLanes; ++k)
            {
                const double px = weight * x[k], py = weight * y[k], pz = weight * z[k];
                m[0][k] += px;
                m[1][k] += py;
                m[2][k] += pz;
                m[3][k] += r.y * pz - r.z * py;
                m[4][k] += r.z * px - r.x * pz;
                m[5][k] += r.x * py - r.y * px;
            }
        });
    for (std::size_t p = 0; p < motions.size(); ++p)
        for (int k = 0; k < kPanelLanes; ++k)
        {
            Motions& m = motions[p];
            const Vec3 angular = m_components[p].m_inverseInertia * Vec3{m[3][k], m[4][k], m[5][k]};
            for (int i = 0; i < 3; ++i)
            {
                m[i][k] *= m_components[p].m_inverseMass;
                m[3 + i][k] = angular[i];
            }
        }
}

void RigidLanes::addMotions(const std::vector<Motions>& motions, double factor, bool asImpulses, float* values) const
{
    forEachRow(
        [&](int rigid, const Vec3& r, double mass, std::size_t row)
        {
            const double weight = asImpulses ? factor * mass : factor;
            float *x = values + row, *y = x + kPanelLanes, *z = y + kPanelLanes;
            const Motions& m = motions[rigid];
            for (int k = 0; k < kPanelLanes; ++k)
            {
                x[k] += static_cast<float>(weight * (m[0][k] + m[4][k] * r.z - m[5][k] * r.y));
                y[k] += static_cast<float>(weight * (m[1][k] + m[5][k] * r.x - m[3][k] * r.z));
                z[k] += static_cast<float>(weight * (m[2][k] + m[3][k] * r.y - m[4][k] * r.x));
            }
        });
}

void RigidLanes::deflateRightSide(float* rightSides)
{
    sum(rightSides, false, m_taken);
    addMotions(m_taken, -1, true, rightSides);
}

void RigidLanes::deflateSolution(float* velocities) const
{
    sum(velocities, true, m_found);
    addMotions(m_found, -1, false, velocities);
}

void RigidLanes::add(float* velocities, double share) const
{
    addMotions(m_taken, share / m_damped, false, velocities);
}

}  // namespace bullet_fem
