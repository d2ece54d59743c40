// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/symmetric.h"

namespace bullet_fem
{

/// Von Mises' law with isotropic hardening and creep, of small strain in the element's frame [Simo & Hughes 1998, box
/// 3.2 and 1.7.3], for one step.
struct VonMises
{
    double m_mu;                 ///< [Pa]
    double m_yieldStress;        ///< [Pa]
    double m_hardeningModulus;   ///< [Pa]
    double m_flow;               ///< share of the stress beyond the yield stress that relaxes in the step [-]
    double m_mostPlasticStrain;  ///< maximum sqrt(2/3 eps_p : eps_p) [-]

    /// Returns the stress deviator s along the radius: changes eps_p and the equivalent plastic strain. `s` is the
    /// deviator before.
    void flow(const SymmetricTensor& s, SymmetricTensor& plastic, double& equivalent) const;
};

}  // namespace bullet_fem
