// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/rigid_lanes.h"

#include <algorithm>

#include "fem/factor/rest_modes.h"

namespace bullet_fem
{

RigidLanes::RigidLanes(const BodyModel& model)
    : m_model(model), m_taken(model.restModes().components().size()), m_found(m_taken)
{
}

// Calls visit(component, r, mass, row) for every free node of a movable component: r from its centre, row the start of
// its entries.
template <class Visit>
void RigidLanes::forEachRow(const Visit& visit) const
{
    const RestModes& modes = m_model.restModes();
    for (std::size_t k = 0; k < modes.nodes().size(); ++k)
    {
        const RestModes::Node& node = modes.nodes()[k];
        if (modes.components()[node.m_component].moves())
            visit(node.m_component, node.m_lever, node.m_mass, 3 * k * kPanelLanes);
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
    const std::vector<RestModes::Component>& components = m_model.restModes().components();
    for (std::size_t p = 0; p < motions.size(); ++p)
        for (int k = 0; k < kPanelLanes; ++k)
        {
            Motions& m = motions[p];
            const Vec3 angular = components[p].m_inverseInertia * Vec3{m[3][k], m[4][k], m[5][k]};
            for (int i = 0; i < 3; ++i)
            {
                m[i][k] *= components[p].m_inverseMass;
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

}  // namespace bullet_fem
