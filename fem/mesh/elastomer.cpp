// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/elastomer.h"

#include <algorithm>
#include <cmath>

#include "fem/common/bounds.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kCircle = 6.28318530717958647692;               // 2 pi
constexpr double kMaxLossFactor = 2;                             // polymers in their glass transition have about 1
constexpr double kMinLossFrequency = 1e-3, kMaxFrequency = 1e5;  // [Hz]
constexpr double kMaxStiffnessDamping = 10;                      // [s], as Material::valid()
constexpr double kRubberDensity = 1100;                          // [kg/m3], natural rubber with carbon black
constexpr double kPolyurethaneDensity = 1200;                    // [kg/m3], thermoplastic polyurethane

Material elastomer(double youngModulus, double density)
{
    Material material;
    material.m_youngModulus = youngModulus;
    material.m_poissonRatio = std::min(Material::kMaxPoissonRatio, 0.5 - youngModulus / (6 * kRubberBulkModulus));
    material.m_density = density;
    setLossFactor(material, kElastomerLossFactor, kElastomerLossFrequency);
    return material;
}

}  // namespace

Material shoreA(double hardness)
{
    if (!isWithin(hardness, kMinShoreA, kMaxShoreA))
        reject("hardness [Shore A] is ", hardness, ", outside [", kMinShoreA, ", ", kMaxShoreA,
               "]; take a gel's Young's modulus for less, and shoreD for more");
    const double gent = (56 + 7.62336 * hardness) / (0.137505 * (254 - 2.54 * hardness));  // [kgf/cm2]
    return elastomer(98100 * gent, kRubberDensity);
}

Material shoreD(double hardness)
{
    if (!isWithin(hardness, kMinShoreD, kMaxShoreD))
        reject("hardness [Shore D] is ", hardness, ", outside [", kMinShoreD, ", ", kMaxShoreD,
               "]; take shoreA for less, and a plastic's Young's modulus for more");
    return elastomer(1e6 * std::pow(10, 0.0235 * (hardness + 50) - 0.6403), kPolyurethaneDensity);
}

double lossFactor(const Material& material, double frequency)
{
    const double w = kCircle * frequency;
    return material.m_massDamping / w + material.m_stiffnessDamping * w;
}

void setLossFactor(Material& material, double factor, double frequency)
{
    if (!isWithin(factor, 0, kMaxLossFactor))
        reject("loss factor [-] is ", factor, ", outside [0, ", kMaxLossFactor, "]; rubber has 0.05 to 0.3");
    if (!isWithin(frequency, kMinLossFrequency, kMaxFrequency))
        reject("frequency of the loss factor [Hz] is ", frequency, ", outside [", kMinLossFrequency, ", ",
               kMaxFrequency, "]; data sheets have 1 to 100");
    const double w = kCircle * frequency, ofMass = material.m_massDamping / w;
    if (factor < ofMass)
        reject("loss factor [-] is ", factor, " at ", frequency, " Hz, less than the ", ofMass,
               " of the mass damping alone; reduce the mass damping");
    const double beta = (factor - ofMass) / w;
    if (beta > kMaxStiffnessDamping)
        reject("stiffness damping [s] of a loss factor of ", factor, " at ", frequency, " Hz is ", beta,
               ", outside [0, ", kMaxStiffnessDamping, "]; give a higher frequency");
    material.m_stiffnessDamping = beta;
}

}  // namespace bullet_fem
