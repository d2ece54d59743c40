// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

namespace bullet_fem
{

/// The moduli of small strain: stress = 2 mu strain + lambda tr(strain) I.
struct LameModuli
{
    double m_mu = 0;      ///< [Pa]
    double m_lambda = 0;  ///< [Pa]

    LameModuli& operator+=(const LameModuli& b);

    /// E = mu (3 lambda + 2 mu) / (lambda + mu) [Pa]; a lambda below 0 counts as 0, which keeps mu.
    double youngModulus() const;
    /// nu = lambda / (2 (lambda + mu)) [-], at least 0 and at most .49, what a material may have.
    double poissonRatio() const;
};

/// An isotropic linear elastic material with Rayleigh damping, in SI units.
struct Material
{
    double m_youngModulus = 1e6;    ///< E [Pa], in (0, 1e13].
    double m_poissonRatio = 0.3;    ///< nu [-], in [0, 0.49].
    double m_density = 1000;        ///< rho [kg/m3], in [0, 1e6]; 0 keeps the body's own node masses.
    double m_massDamping = 0;       ///< alpha of D = alpha M + beta K [1/s], in [0, 1e4].
    double m_stiffnessDamping = 0;  ///< beta of D = alpha M + beta K [s], in [0, 10].

    /// First Lame constant lambda = E nu / ((1 + nu)(1 - 2 nu)) [Pa].
    double lameLambda() const;
    /// Shear modulus mu = E / (2 (1 + nu)) [Pa].
    double lameMu() const;

    /// True if every value is finite and in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
    /// Throws std::invalid_argument with the message of valid().
    void validate() const;

    static Material rubber();  ///< soft natural rubber: 2 MPa, nu .47, 1100 kg/m3
    static Material foam();    ///< upholstery foam: 50 kPa, nu .1, 40 kg/m3
    static Material jelly();   ///< gelatine: 10 kPa, nu .45, 1000 kg/m3
    static Material flesh();   ///< muscle and fat: 60 kPa, nu .45, 1060 kg/m3
    static Material wood();    ///< softwood taken as isotropic: 9 GPa, nu .3, 500 kg/m3

    friend bool operator==(const Material& a, const Material& b)
    {
        return a.m_youngModulus == b.m_youngModulus && a.m_poissonRatio == b.m_poissonRatio &&
               a.m_density == b.m_density && a.m_massDamping == b.m_massDamping &&
               a.m_stiffnessDamping == b.m_stiffnessDamping;
    }
    friend bool operator!=(const Material& a, const Material& b) { return !(a == b); }
};

}  // namespace bullet_fem
