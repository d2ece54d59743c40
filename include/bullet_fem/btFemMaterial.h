// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "LinearMath/btScalar.h"
#include "bullet_fem/btFemPrecision.h"

/// An isotropic linear elastic material with Rayleigh damping D = alpha M + beta K. SI units whatever the scene's
/// scale: a Bullet unit of length is a metre, of mass a kilogram.
struct btFemMaterial
{
    btScalar m_youngModulus = btScalar(1e6);        ///< E [Pa], in (0, 1e13]
    btScalar m_poissonRatio = btScalar(0.3);        ///< nu [-], in [0, 0.49]
    btScalar m_density = btScalar(1000);            ///< rho [kg/m3], in [0, 1e6]; 0 keeps the body's own node masses
    btScalar m_massDamping = btScalar(0);           ///< alpha [1/s], in [0, 1e4]
    btScalar m_stiffnessDamping = btScalar(0.005);  ///< beta [s], in [0, 10]

    static btFemMaterial rubber();  ///< soft natural rubber: 2 MPa, nu .47, 1100 kg/m3
    static btFemMaterial foam();    ///< upholstery foam: 50 kPa, nu .1, 40 kg/m3
    static btFemMaterial jelly();   ///< gelatine: 10 kPa, nu .45, 1000 kg/m3
    static btFemMaterial flesh();   ///< muscle and fat: 60 kPa, nu .45, 1060 kg/m3
    static btFemMaterial wood();    ///< softwood taken as isotropic: 9 GPa, nu .3, 500 kg/m3

    /// True if every value is finite and in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};
