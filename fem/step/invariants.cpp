// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/stepping.h"

#include "fem/common/rotation.h"

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

// Element energy: V (mu E:E + lambda/2 tr(E)^2), E = sym(R^T F) - I. The state's rotations are those of the last step's
// start, which a spinning body has left behind: R is found anew.
double mechanicalEnergy(const Body& body)
{
    const BodyState& s = body.m_state;
    double energy = 0;
    for (std::size_t i = 0; i < s.m_x.size(); ++i) energy += 0.5 * s.m_mass[i] * dot(s.m_v[i], s.m_v[i]);
    const std::vector<Tet>& tets = body.m_model->mesh().tets();
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        const RestElement& element = body.m_model->shape().m_elements[e];
        const Vec3& x0 = s.m_x[tets[e][0]];
        const Mat3 F = Mat3::fromColumns(s.m_x[tets[e][1]] - x0, s.m_x[tets[e][2]] - x0, s.m_x[tets[e][3]] - x0) *
                       element.m_DmInverse;
        const Mat3 E = transposeTimes(polarRotation(F, toMatrix(s.m_elementRotation[e])), F) - Mat3::identity();
        const Mat3 symmetric = 0.5 * (E + transpose(E));
        energy += element.m_muVolume * squaredNorm(symmetric) +
                  0.5 * element.m_lambdaVolume * trace(symmetric) * trace(symmetric);
    }
    return energy;
}

}  // namespace bullet_fem
