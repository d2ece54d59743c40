// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// The constitutive law (docs/materials.md, Laws and elements).
enum class ElasticLaw
{
    hooke,        ///< linear in the strain of the rotated frame
    neoHooke,     ///< equals hooke at small strain; stiffens in tension, and without bound in compression
    orthotropic,  ///< linear, with the constants and axes of Material::m_orthotropic instead of E and nu
    ogden,        ///< for rubber; m_lawConstants mu1, alpha1, mu2, alpha2, mu3, alpha3 instead of E
    damage        ///< linear, softens beyond a strength; m_lawConstants strength [Pa], fracture energy [J/m2]
};

constexpr int kMaxLawConstants = 6;         ///< capacity of Material::m_lawConstants
constexpr double kMaxPoissonRatio = 0.499;  ///< maximum nu [-]; lambda / mu is 499 there, infinite at .5

}  // namespace bullet_fem
