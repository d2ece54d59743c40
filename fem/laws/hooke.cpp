// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/laws/hooke.h"

#include <algorithm>

namespace bullet_fem
{

LameModuli lameModuli(double youngModulus, double poissonRatio)
{
    return {youngModulus / (2 * (1 + poissonRatio)),
            youngModulus * poissonRatio / ((1 + poissonRatio) * (1 - 2 * poissonRatio))};
}

LawResponse hookeResponse(const Mat3& e, const LawPoint& point)
{
    const double tr = trace(e);
    LawResponse result;
    result.m_stress = 2 * point.m_mu * e + Mat3::diagonal(point.m_lambda * tr + point.m_pressure);
    result.m_cofactor = Mat3::identity();
    result.m_bulk = point.m_lambda;
    result.m_energy = point.m_mu * squaredNorm(e) + 0.5 * point.m_lambda * tr * tr;
    return result;
}

Law hookeLaw()
{
    Law law = {};
    law.m_name = "hooke";
    law.m_title = "Hooke's law";
    law.m_kind = LawKind::linear;
    law.m_moduli = [](const double*, double young, double poisson) { return lameModuli(young, poisson); };
    law.m_respond = &hookeResponse;
    return law;
}

LameModuli& LameModuli::operator+=(const LameModuli& b)
{
    m_mu += b.m_mu;
    m_lambda += b.m_lambda;
    return *this;
}

double LameModuli::youngModulus() const
{
    const double lambda = std::max(0.0, m_lambda);
    return m_mu * (3 * lambda + 2 * m_mu) / (lambda + m_mu);
}

double LameModuli::poissonRatio() const
{
    const double lambda = std::max(0.0, m_lambda);
    return std::min(kMaxPoissonRatio, 0.5 * lambda / (lambda + m_mu));
}

}  // namespace bullet_fem
