// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/stepping.h"

#include "fem/step/elastic_energy.h"

namespace bullet_fem
{

Vec3 linearMomentum(const BodyState& state)
{
    Vec3 sum;
    for (std::size_t i = 0; i < state.m_x.size(); ++i) sum += state.m_mass[i] * state.m_v[i];
    return sum;
}

Vec3 angularMomentum(const BodyState& state)
{
    Vec3 sum;
    for (std::size_t i = 0; i < state.m_x.size(); ++i) sum += state.m_mass[i] * cross(state.m_x[i], state.m_v[i]);
    return sum;
}

double kineticEnergy(const BodyState& state, const std::vector<Vec3>& v)
{
    double energy = 0;
    for (std::size_t i = 0; i < v.size(); ++i) energy += 0.5 * state.m_mass[i] * dot(v[i], v[i]);
    return energy;
}

double mechanicalEnergy(const Body& body)
{
    return kineticEnergy(body.m_state, body.m_state.m_v) + elasticEnergy(body, body.m_state.m_x);
}

}  // namespace bullet_fem
