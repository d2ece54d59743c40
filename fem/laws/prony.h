// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>

#include "bullet_fem/fem/common/symmetric.h"

namespace bullet_fem
{

/// A term of a Prony series of the shear modulus for one step [Simo & Hughes 1998, 10.2]: d alpha / dt = (e - alpha) /
/// tau for constant e.
class PronyStep
{
public:
    PronyStep() = default;
    /// Both in seconds.
    PronyStep(double step, double relaxationTime) : m_relaxed(-std::expm1(-step / relaxationTime)) {}

    /// Relaxes alpha towards the deviatoric elastic strain e.
    void relax(const SymmetricTensor& e, SymmetricTensor& alpha) const
    {
        alpha *= 1 - m_relaxed;
        alpha += m_relaxed * e;
    }

private:
    double m_relaxed = 0;  // share of e - alpha that relaxes in the step [-]
};

}  // namespace bullet_fem
