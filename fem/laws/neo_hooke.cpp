// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/laws/neo_hooke.h"

#include <algorithm>
#include <cmath>

#include "fem/laws/hooke.h"

namespace bullet_fem
{
LawResponse neoHooke(const Mat3& e, double lambda, double mu, double pressure)
{
    const Mat3 adjugate = adjugateOf(e);
    const double tr = trace(e), j = tr + trace(adjugate) + determinant(e);  // J - 1
    const double above = std::max(j, kMinVolumeRatio - 1), below = j - above, inverse = 1 / (1 + above);
    const double curvature = 0.5 * lambda * (1 + inverse * inverse) + mu * inverse * inverse;
    const double slope = above * (lambda * (1 + 0.5 * above) + mu) * inverse;  // q
    const double q = slope + curvature * below + pressure;

    LawResponse result;
    result.m_cofactor = Mat3::diagonal(1 + tr) - e + adjugate;
    result.m_stress = mu * (2.0 * e - Mat3::diagonal(tr) - adjugate) + q * result.m_cofactor;
    const double squares = std::max(squaredNorm(result.m_cofactor), 1e-30), traceOfC = trace(result.m_cofactor);
    const double likeness = 0.5 * (traceOfC * traceOfC / squares - 1);
    result.m_bulk = std::max(0.0, curvature - 3 * mu * likeness * likeness / squares);
    const double size = squaredNorm(e);
    const double stretch = 1 + tr / 3 + std::sqrt(2.0 / 3 * std::max(0.0, size - tr * tr / 3));
    result.m_shear = std::max(1.0, 0.5 * (1 + std::fabs(q - mu) * std::max(0.0, stretch) / mu));
    const double logarithm = std::log1p(above);
    result.m_energy = mu * (tr + 0.5 * size - logarithm) + 0.5 * lambda * (above + 0.5 * above * above - logarithm) +
                      (slope - mu + 0.5 * curvature * below) * below;
    return result;
}

Law neoHookeLaw()
{
    Law law = {};
    law.m_name = "neoHooke";
    law.m_title = "Neo-Hookean law (as jelly and flesh have)";
    law.m_kind = LawKind::varying;
    law.m_hasVolumeRatio = law.m_isInLanes = true;
    law.m_moduli = [](const double*, double young, double poisson) { return lameModuli(young, poisson); };
    law.m_respond = [](const Mat3& e, const LawPoint& point)
    { return neoHooke(e, point.m_lambda, point.m_mu, point.m_pressure); };
    return law;
}

}  // namespace bullet_fem
