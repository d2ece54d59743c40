// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/laws/von_mises.h"

#include <cmath>

namespace bullet_fem
{
namespace
{

/// Ratio of the equivalent uniaxial strain to the norm of a deviatoric strain, and of the norm of a stress deviator to
/// the uniaxial stress.
const double kOfUniaxial = std::sqrt(2.0 / 3);

}  // namespace

void VonMises::flow(const SymmetricTensor& s, SymmetricTensor& plastic, double& equivalent) const
{
    const double size = std::sqrt(contraction(s, s));
    const double beyond = size - kOfUniaxial * (m_yieldStress + m_hardeningModulus * equivalent);
    if (!(beyond > 0)) return;
    const SymmetricTensor before = plastic;
    const double gamma = m_flow * beyond / (2 * m_mu + 2.0 / 3 * m_hardeningModulus);
    plastic += (gamma / size) * s;
    const double norm = kOfUniaxial * std::sqrt(contraction(plastic, plastic));
    if (norm > m_mostPlasticStrain) plastic *= m_mostPlasticStrain / norm;
    const SymmetricTensor flown = plastic + -1.0 * before;
    equivalent += kOfUniaxial * std::sqrt(contraction(flown, flown));
}

}  // namespace bullet_fem
