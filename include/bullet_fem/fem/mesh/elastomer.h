// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

constexpr double kMinShoreA = 10, kMaxShoreA = 95;  ///< hardness that shoreA() accepts [Shore A]
constexpr double kMinShoreD = 30, kMaxShoreD = 70;  ///< hardness that shoreD() accepts [Shore D]
/// Bulk modulus of rubber [Pa], which hardness hardly changes [Treloar 1975, 4.1].
constexpr double kRubberBulkModulus = 2e9;
/// Loss factor [-] of shoreA() and shoreD() at kElastomerLossFrequency, between gum and filled rubber.
constexpr double kElastomerLossFactor = 0.1;
constexpr double kElastomerLossFrequency = 10;  ///< usual frequency of dynamic data sheets [Hz]

/// Rubber by its hardness on Shore's scale A, in [10, 95], from gels and erasers (10 to 40) to tyre treads (65) and
/// rollers (90). Young's modulus is that of a linear half-space under the durometer's indenter [Gent 1958]:
///
///     E = 98.1 kPa (56 + 7.62336 S) / (0.137505 (254 - 2.54 S))
///
/// Poisson's ratio is 1/2 - E / (6 K) with the bulk modulus kRubberBulkModulus, at most Material::kMaxPoissonRatio; the
/// density 1100 kg/m3; the loss factor kElastomerLossFactor; the law Hooke's with mean dilatation. Moduli of
/// natural rubber by hardness [Lindley 1970] are within 26 % of it: take a measured modulus where there is one. Throws
/// std::invalid_argument outside the range.
BULLETFEM_API Material shoreA(double hardness);

/// Hard rubber and thermoplastic elastomers by hardness on Shore's scale D, in [30, 70], as shoreA() with 1200 kg/m3
/// and the fit log10(E / MPa) = 0.0235 (S + 50) - 0.6403 [Qi, Joyce & Boyce 2003].
BULLETFEM_API Material shoreD(double hardness);

/// Loss factor (tangent of the loss angle) of a bar that vibrates at a frequency [Hz]: alpha / w + beta w, w = 2 pi
/// frequency.
BULLETFEM_API double lossFactor(const Material& material, double frequency);

/// Chooses the stiffness damping beta that gives a loss factor, in [0, 2], at a frequency [Hz], in [1e-3, 1e5], beside
/// the mass damping alpha, which stays. The loss factor grows in proportion to the frequency. Throws
/// std::invalid_argument outside the ranges, if alpha alone gives more, and if beta would be above 10 s.
BULLETFEM_API void setLossFactor(Material& material, double lossFactor, double frequency);

}  // namespace bullet_fem
