// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <limits>
#include <string>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/laws/elastic_law.h"
#include "bullet_fem/fem/laws/orthotropic.h"

namespace bullet_fem
{

/// Mean dilatation: whether the elements of a patch share one volume change (docs/materials.md). Linear tetrahedra that
/// each keep their own volume lock where the material is nearly incompressible.
enum class MeanDilatation
{
    automatic,  ///< on for nu above Material::kMinAveragedRatio, and for accurate bending
    on,
    off
};

/// Bending of few cells (docs/materials.md): plain linear tetrahedra are too stiff in it.
enum class Bending
{
    automatic,  ///< accurate in bodies with fewer than four cells across somewhere (isThinSomewhere), else plain
    plain,      ///< the strain of an element is its own, but for mean dilatation
    accurate    ///< assumed strains of patches (AssumedStrain)
};

/// A term g_i exp(-t / tau_i) of the Prony series of the shear modulus.
struct PronyTerm
{
    double m_share = 0;  ///< relative modulus g_i [-], in [0, 0.99]; 0: no term
    double m_time = 1;   ///< relaxation time tau_i [s], in [1e-6, 1e9]

    /// True if both values are equal.
    friend bool operator==(const PronyTerm& a, const PronyTerm& b)
    {
        return a.m_share == b.m_share && a.m_time == b.m_time;
    }
};

/// An elastic material with Rayleigh damping, in SI units: isotropic and linear, optionally with yield and relaxation;
/// Neo-Hookean; or orthotropic (docs/materials.md).
struct BULLETFEM_API Material
{
    /// A yield stress that is never reached.
    static constexpr double kInfinite = std::numeric_limits<double>::infinity();
    static constexpr int kMaxRelaxationTerms = 3;  ///< capacity of m_relaxation
    [[deprecated("kMaxRelaxationTerms")]] static constexpr int kMostRelaxationTerms = kMaxRelaxationTerms;
    static constexpr double kMaxRelaxedShare = 0.99;  ///< maximum sum of g_i; the rest carries slow loads
    [[deprecated("kMaxRelaxedShare")]] static constexpr double kMostRelaxedShare = kMaxRelaxedShare;
    static constexpr double kMaxPoissonRatio = bullet_fem::kMaxPoissonRatio;  ///< maximum nu [-]
    [[deprecated("kMaxPoissonRatio")]] static constexpr double kMostPoissonRatio = kMaxPoissonRatio;
    static constexpr double kMinAveragedRatio = 0.4;  ///< MeanDilatation::automatic is on for larger nu
    [[deprecated("kMinAveragedRatio")]] static constexpr double kLeastAveragedRatio = kMinAveragedRatio;

    double m_youngModulus = 1e6;    ///< E [Pa], in (0, 1e13].
    double m_poissonRatio = 0.3;    ///< nu [-], in [0, 0.499].
    double m_density = 1000;        ///< rho [kg/m3], in [0, 1e6]; 0 keeps the body's own node masses.
    double m_massDamping = 0;       ///< alpha of D = alpha M + beta K [1/s], in [0, 1e4].
    double m_stiffnessDamping = 0;  ///< beta of D = alpha M + beta K [s], in [0, 10].
    /// Whether patches of elements share one volume change.
    MeanDilatation m_meanDilatation = MeanDilatation::automatic;
    /// Yield stress sigma_y [Pa], in (0, inf]: larger von Mises stresses cause plastic strain; infinity never yields.
    double m_yieldStress = kInfinite;
    /// Hardening modulus H [Pa], in [0, 1e13]: sigma_y grows by H times the plastic strain.
    double m_hardeningModulus = 0;
    /// Rate at which stress beyond sigma_y relaxes [1/s], in (0, inf]; infinity: at once.
    double m_plasticCreep = kInfinite;
    /// Maximum sqrt(2/3 eps_p : eps_p) of the plastic strain eps_p [-], in (0, 0.9]; strain beyond it is elastic.
    double m_mostPlasticStrain = 0.5;

    /// Prony series. With terms, E and nu are the instantaneous ones, and the shear modulus is mu (1 - sum g_i (1 -
    /// exp(-t / tau_i))); the bulk modulus does not relax. Terms with a share stand first; the sum of the shares is at
    /// most 0.99.
    std::array<PronyTerm, kMaxRelaxationTerms> m_relaxation = {};

    /// Whether bending does not lock. `accurate` is not available with mean dilatation off; `automatic` is plain there.
    Bending m_bending = Bending::plain;
    /// The constitutive law; E and nu are its small-strain constants.
    ElasticLaw m_law = ElasticLaw::hooke;
    /// The constants for ElasticLaw::orthotropic, which ignores E and nu. An orthotropic material cannot yield or
    /// relax, and takes mean dilatation with accurate bending alone.
    Orthotropic m_orthotropic = {};
    /// Constants of laws with constants of their own, in the order of docs/materials.md; 0 for the others.
    std::array<double, kMaxLawConstants> m_lawConstants = {};

    /// First Lame constant lambda = E nu / ((1 + nu)(1 - 2 nu)) [Pa]; for an orthotropic material that of
    /// Orthotropic::isotropicPart().
    double lameLambda() const;
    /// Shear modulus mu = E / (2 (1 + nu)) [Pa]; for an orthotropic material that of Orthotropic::isotropicPart().
    double lameMu() const;
    /// True if the law is ElasticLaw::orthotropic.
    bool isOrthotropic() const { return m_law == ElasticLaw::orthotropic; }
    /// Stiffness matrix C in the axes of the rest shape, of Hooke's law or the orthotropic one.
    ElasticMatrix stiffness() const;
    /// True if elements share their volume change; Bending::automatic counts as plain. Compares nu in single precision,
    /// so that both precisions of Bullet choose alike.
    bool usesMeanDilatation() const;
    /// True if m_yieldStress is finite.
    bool yields() const { return m_yieldStress < kInfinite; }
    /// Number of terms of m_relaxation with a share.
    int relaxationTerms() const;
    /// Long-time compliance [1/Pa]: strain over stress of a bar under constant tension along a unit vector [-], at
    /// small strain. 1 / E for an isotropic material; for an orthotropic one in that direction of the rest shape; for a
    /// relaxing one with the long-time shear modulus.
    double slowCompliance(const Vec3& direction) const;

    /// True if every value is finite and in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
    /// Throws std::invalid_argument with the message of valid().
    void validate() const;

    static Material rubber();    ///< soft natural rubber: 2 MPa, nu .47, 1100 kg/m3
    static Material foam();      ///< upholstery foam: 50 kPa, nu .1, 40 kg/m3
    static Material jelly();     ///< gelatine: 10 kPa, nu .45, 1000 kg/m3, Neo-Hookean
    static Material flesh();     ///< muscle and fat: 60 kPa, nu .45, 1060 kg/m3, Neo-Hookean
    static Material wood();      ///< softwood taken as isotropic: 9 GPa, nu .3, 500 kg/m3
    static Material clay();      ///< soft clay, undrained: 2.5 MPa, nu .45, 1800 kg/m3, yields at 50 kPa
    static Material lead();      ///< 16 GPa, nu .44, 11340 kg/m3, yields at 5.5 MPa and hardens by 20 MPa
    static Material mildFoam();  ///< foam that keeps dents: as foam(), yields at 2.5 kPa, with creep of 2 / s

    /// True if all values that the law reads are equal.
    friend bool operator==(const Material& a, const Material& b)
    {
        return a.m_law == b.m_law && a.m_youngModulus == b.m_youngModulus && a.m_poissonRatio == b.m_poissonRatio &&
               a.m_density == b.m_density && a.m_massDamping == b.m_massDamping &&
               a.m_stiffnessDamping == b.m_stiffnessDamping && a.m_meanDilatation == b.m_meanDilatation &&
               a.m_bending == b.m_bending && a.m_yieldStress == b.m_yieldStress &&
               a.m_hardeningModulus == b.m_hardeningModulus && a.m_plasticCreep == b.m_plasticCreep &&
               a.m_mostPlasticStrain == b.m_mostPlasticStrain && a.m_relaxation == b.m_relaxation &&
               a.m_lawConstants == b.m_lawConstants && (!a.isOrthotropic() || a.m_orthotropic == b.m_orthotropic);
    }
    /// True if any value that the law reads differs.
    friend bool operator!=(const Material& a, const Material& b) { return !(a == b); }
};

/// A material with the settings that a btFemMaterial starts from, for scenes, the command line and Python: automatic
/// bending, and a stiffness damping of 0.005 s unless the material has one.
BULLETFEM_API Material withProgramDefaults(Material material);

}  // namespace bullet_fem
