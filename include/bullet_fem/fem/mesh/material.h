// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <limits>
#include <string>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/orthotropic.h"

namespace bullet_fem
{

/// Whether the elements of a patch share one volume change (docs/materials.md): linear tetrahedra that each keep their
/// own volume are too stiff where the material is nearly incompressible.
enum class MeanDilatation
{
    automatic,  ///< on where nu is above Material::kLeastAveragedRatio, and for accurate bending
    on,
    off
};

/// How stress follows from strain (docs/materials.md, Large strain).
enum class ElasticLaw
{
    hooke,       ///< linear in the strain of the rotated frame
    neoHooke,    ///< the same at small strain; stiffens as it is stretched, and without bound as it is crushed
    orthotropic  ///< linear as hooke, with the constants and axes of Material::m_orthotropic in place of E and nu
};

/// A part of the shear modulus that relaxes: g_i exp(-t / tau_i) of a Prony series.
struct PronyTerm
{
    double m_share = 0;  ///< g_i of the shear modulus [-], in [0, 0.99]; 0 for none
    double m_time = 1;   ///< tau_i [s], in [1e-6, 1e9]

    /// The same values.
    friend bool operator==(const PronyTerm& a, const PronyTerm& b)
    {
        return a.m_share == b.m_share && a.m_time == b.m_time;
    }
};

/// An elastic material with Rayleigh damping, in SI units: isotropic and linear, where it may yield and relax,
/// Neo-Hookean, or orthotropic (docs/materials.md).
struct BULLETFEM_API Material
{
    static constexpr double kInfinite = std::numeric_limits<double>::infinity();  ///< a stress that nothing reaches
    static constexpr int kMostRelaxationTerms = 3;                                ///< of m_relaxation
    static constexpr double kMostRelaxedShare = 0.99;   ///< of the shear modulus; what is left holds slow loads
    static constexpr double kMostPoissonRatio = 0.499;  ///< lambda / mu is 499 there, and infinite at .5
    static constexpr double kLeastAveragedRatio = 0.4;  ///< nu above which MeanDilatation::automatic is on

    double m_youngModulus = 1e6;    ///< E [Pa], in (0, 1e13].
    double m_poissonRatio = 0.3;    ///< nu [-], in [0, 0.499].
    double m_density = 1000;        ///< rho [kg/m3], in [0, 1e6]; 0 keeps the body's own node masses.
    double m_massDamping = 0;       ///< alpha of D = alpha M + beta K [1/s], in [0, 1e4].
    double m_stiffnessDamping = 0;  ///< beta of D = alpha M + beta K [s], in [0, 10].
    MeanDilatation m_meanDilatation = MeanDilatation::automatic;  ///< one volume change a patch of elements.
    /// sigma_y [Pa], in (0, inf]: beyond this von Mises stress the strain stays; infinity never yields.
    double m_yieldStress = kInfinite;
    double m_hardeningModulus = 0;  ///< H [Pa], in [0, 1e13]: sigma_y grows by H times the plastic strain.
    double m_plasticCreep =
        kInfinite;                     ///< rate at which stress beyond sigma_y decays [1/s], in (0, inf]; inf: at once.
    double m_mostPlasticStrain = 0.5;  ///< equivalent strain [-], in (0, 0.9]; what goes beyond it is elastic again.

    /// With terms, E and nu are those of fast loads, and the shear modulus is mu (1 - sum g_i (1 - exp(-t / tau_i)));
    /// the bulk modulus stays. Those with a share stand first; the shares' sum is at most 0.99.
    std::array<PronyTerm, kMostRelaxationTerms> m_relaxation = {};

    /// Shear strains are averaged around edges, so that bending is not too stiff (EdgeDomains). Not with mean
    /// dilatation off, and not for materials that yield or relax.
    bool m_accurateBending = false;
    /// The law; E and nu are those of small strain.
    ElasticLaw m_law = ElasticLaw::hooke;
    /// Read with ElasticLaw::orthotropic alone: E and nu are not, then. Such a material does not yield or relax, does
    /// not bend accurately, and its elements have their own volume change each.
    Orthotropic m_orthotropic = {};

    /// First Lame constant lambda = E nu / ((1 + nu)(1 - 2 nu)) [Pa]; of an orthotropic material that of
    /// Orthotropic::isotropicPart().
    double lameLambda() const;
    /// Shear modulus mu = E / (2 (1 + nu)) [Pa], likewise.
    double lameMu() const;
    /// Whether stress depends on the direction of the strain.
    bool isOrthotropic() const { return m_law == ElasticLaw::orthotropic; }
    /// C in the axes of the rest shape, of Hooke's law or an orthotropic one.
    ElasticMatrix stiffness() const;
    /// Whether elements share their volume change; nu is compared in single precision, so that what Bullet rounds and
    /// what is not rounded choose alike.
    bool usesMeanDilatation() const;
    /// Whether some stress makes it yield.
    bool yields() const { return m_yieldStress < kInfinite; }
    /// How many terms of m_relaxation there are.
    int relaxationTerms() const;

    /// True if every value is finite and in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
    /// Throws std::invalid_argument with the message of valid().
    void validate() const;

    static Material rubber();    ///< soft natural rubber: 2 MPa, nu .47, 1100 kg/m3
    static Material foam();      ///< upholstery foam: 50 kPa, nu .1, 40 kg/m3
    static Material jelly();     ///< gelatine: 10 kPa, nu .45, 1000 kg/m3
    static Material flesh();     ///< muscle and fat: 60 kPa, nu .45, 1060 kg/m3
    static Material wood();      ///< softwood taken as isotropic: 9 GPa, nu .3, 500 kg/m3
    static Material clay();      ///< soft clay, undrained: 2.5 MPa, nu .45, 1800 kg/m3, yields at 50 kPa
    static Material lead();      ///< 16 GPa, nu .44, 11340 kg/m3, yields at 5.5 MPa and hardens by 20 MPa
    static Material mildFoam();  ///< foam that keeps dents: as foam(), yields at 2.5 kPa, with creep of 2 / s

    /// The same values.
    friend bool operator==(const Material& a, const Material& b)
    {
        return a.m_law == b.m_law && a.m_youngModulus == b.m_youngModulus && a.m_poissonRatio == b.m_poissonRatio &&
               a.m_density == b.m_density && a.m_massDamping == b.m_massDamping &&
               a.m_stiffnessDamping == b.m_stiffnessDamping && a.m_meanDilatation == b.m_meanDilatation &&
               a.m_accurateBending == b.m_accurateBending && a.m_yieldStress == b.m_yieldStress &&
               a.m_hardeningModulus == b.m_hardeningModulus && a.m_plasticCreep == b.m_plasticCreep &&
               a.m_mostPlasticStrain == b.m_mostPlasticStrain && a.m_relaxation == b.m_relaxation &&
               (!a.isOrthotropic() || a.m_orthotropic == b.m_orthotropic);
    }
    /// Not so.
    friend bool operator!=(const Material& a, const Material& b) { return !(a == b); }
};

}  // namespace bullet_fem
