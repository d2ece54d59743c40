// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/material.h"

#include <algorithm>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

/// One range of a material: (low, high] or [low, high].
struct ValueRange
{
    const char* m_what;
    double m_value;
    bool m_openBelow;
    double m_low, m_high;
    const char* m_remedy;

    bool contains() const  // false for NaN
    {
        return (m_openBelow ? m_value > m_low : m_value >= m_low) && m_value <= m_high;
    }
    std::string complaint() const
    {
        return message(m_what, " is ", m_value, ", outside ", m_openBelow ? "(" : "[", m_low, ", ", m_high, "]; ",
                       m_remedy);
    }
};

Material isotropic(double youngModulus, double poissonRatio, double density)
{
    Material material;
    material.m_youngModulus = youngModulus;
    material.m_poissonRatio = poissonRatio;
    material.m_density = density;
    return material;
}

}  // namespace

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
    return std::min(0.49, 0.5 * lambda / (lambda + m_mu));
}

double Material::lameLambda() const
{
    return m_youngModulus * m_poissonRatio / ((1 + m_poissonRatio) * (1 - 2 * m_poissonRatio));
}

double Material::lameMu() const
{
    return m_youngModulus / (2 * (1 + m_poissonRatio));
}

bool Material::valid(std::string* why) const
{
    const ValueRange ranges[] = {
        {"Young's modulus [Pa]", m_youngModulus, true, 0, 1e13, "rubber is about 2e6, steel 2e11"},
        {"Poisson's ratio [-]", m_poissonRatio, false, 0, 0.49, "use 0.45 to 0.49 for a nearly incompressible solid"},
        {"density [kg/m3]", m_density, false, 0, 1e6, "water is 1000; 0 keeps the body's own node masses"},
        {"mass damping [1/s]", m_massDamping, false, 0, 1e4, "0 switches it off"},
        {"stiffness damping [s]", m_stiffnessDamping, false, 0, 10, "0 switches it off, 0.01 is already much"}};
    for (const ValueRange& range : ranges)
        if (!range.contains())
        {
            if (why) *why = range.complaint();
            return false;
        }
    return true;
}

void Material::validate() const
{
    std::string why;
    if (!valid(&why)) reject(why);
}

Material Material::rubber()
{
    return isotropic(2e6, 0.47, 1100);
}
Material Material::foam()
{
    return isotropic(5e4, 0.1, 40);
}
Material Material::jelly()
{
    return isotropic(1e4, 0.45, 1000);
}
Material Material::flesh()
{
    return isotropic(6e4, 0.45, 1060);
}
Material Material::wood()
{
    return isotropic(9e9, 0.3, 500);
}

}  // namespace bullet_fem
