// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <string>

#include "LinearMath/btScalar.h"
#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/laws/elastic_law.h"

/// Mean dilatation: whether the tetrahedra of a patch (a lattice cube, or four to eight neighbours in any other mesh)
/// share one volume change. Linear tetrahedra with separate volume changes lock where nu is near .5.
enum class btFemMeanDilatation
{
    automatic,  ///< on for nu above .4, and with accurate bending
    on,
    off
};

/// Bending of bodies with few cells across, in which plain linear tetrahedra are too stiff.
enum class btFemBending
{
    automatic,  ///< accurate in bodies with fewer than four cells across somewhere, else plain
    plain,      ///< the strain of an element is its own, but for mean dilatation
    accurate    ///< strains of an element that differ from its patch's mean count less
};

/// Constitutive law: hooke, neoHooke, orthotropic, ... (docs/materials.md, Laws and elements).
using btFemElasticLaw = bullet_fem::ElasticLaw;

/// A term g_i exp(-t / tau_i) of the Prony series of the shear modulus.
struct BULLETFEM_API btFemRelaxation
{
    btScalar m_share = btScalar(0);  ///< relative modulus g_i [-], in [0, 0.99]; 0: no term
    btScalar m_time = btScalar(1);   ///< relaxation time tau_i [s], in [1e-6, 1e9]
};

/// Constants and axes 1, 2, 3 of a material with three planes of symmetry, such as wood or a fibre-reinforced solid.
/// nu_ij is the contraction along j over the extension along i under tension along i, so nu_ij / E_i = nu_ji / E_j.
/// Constants that make the stiffness indefinite are refused (docs/materials.md, Orthotropic).
struct BULLETFEM_API btFemOrthotropic
{
    btScalar m_young[3] = {btScalar(1e6), btScalar(1e6), btScalar(1e6)};    ///< E_1, E_2, E_3 [Pa], in (0, 1e13]
    btScalar m_poisson[3] = {btScalar(0.3), btScalar(0.3), btScalar(0.3)};  ///< nu_12, nu_13, nu_23 [-]
    btScalar m_shear[3] = {btScalar(4e5), btScalar(4e5), btScalar(4e5)};    ///< G_12, G_13, G_23 [Pa], in (0, 1e13]
    /// Axis 1, in the axes of the rest shape, that is of the world as the body lies when first stepped or prepared; it
    /// then rotates with the body. Any nonzero length.
    btVector3 m_along = btVector3(1, 0, 0);
    /// Its component perpendicular to axis 1 is axis 2; not parallel to m_along. Axis 3 is their cross product.
    btVector3 m_across = btVector3(0, 1, 0);
};

/// An elastic material with Rayleigh damping D = alpha M + beta K: isotropic and linear, optionally with yield and
/// relaxation; Neo-Hookean; or orthotropic (docs/materials.md). In SI units whatever the scale of the scene: a Bullet
/// unit of length is a metre, one of mass a kilogram.
struct BULLETFEM_API btFemMaterial
{
    btScalar m_youngModulus = btScalar(1e6);        ///< E [Pa], in (0, 1e13]
    btScalar m_poissonRatio = btScalar(0.3);        ///< nu [-], in [0, 0.499]
    btScalar m_density = btScalar(1000);            ///< rho [kg/m3], in [0, 1e6]; 0 keeps the body's own node masses
    btScalar m_massDamping = btScalar(0);           ///< alpha [1/s], in [0, 1e4]
    btScalar m_stiffnessDamping = btScalar(0.005);  ///< beta [s], in [0, 10]
    btFemMeanDilatation m_meanDilatation = btFemMeanDilatation::automatic;  ///< remedy against volumetric locking
    /// Yield stress sigma_y [Pa], in (0, inf]: larger von Mises stresses cause plastic strain; infinity never yields.
    btScalar m_yieldStress = std::numeric_limits<btScalar>::infinity();
    /// Hardening modulus H [Pa], in [0, 1e13]: sigma_y grows by H times the plastic strain.
    btScalar m_hardeningModulus = btScalar(0);
    /// Rate at which stress beyond sigma_y decays, as exp(-rate t) [1/s], in (0, inf]; infinity: at once.
    btScalar m_plasticCreep = std::numeric_limits<btScalar>::infinity();
    /// Maximum plastic strain, sqrt(2/3 eps_p : eps_p) [-], in (0, 0.9]; strain beyond it is elastic.
    btScalar m_mostPlasticStrain = btScalar(0.5);
    static constexpr int kMaxRelaxationTerms = 3;  ///< capacity of m_relaxation
    [[deprecated("kMaxRelaxationTerms")]] static constexpr int kMostRelaxationTerms = kMaxRelaxationTerms;
    /// Viscoelasticity. With terms, E and nu are the instantaneous ones, and the shear modulus is mu (1 - sum g_i (1 -
    /// exp(-t / tau_i))) at time t after loading; the bulk modulus does not relax. Terms with a share stand first; the
    /// sum of the shares is at most 0.99.
    btFemRelaxation m_relaxation[kMaxRelaxationTerms];
    /// Constitutive law; E and nu are its small-strain constants. Only hooke can yield or relax.
    btFemElasticLaw m_law = btFemElasticLaw::hooke;
    /// Remedy against locking in bending (docs/materials.md). With `accurate` bars of two or more cells across have a
    /// bending error of at most 5 %, and a step takes 1.3 to 1.4 times as long. It is not available with mean
    /// dilatation off, and `automatic` is plain there.
    btFemBending m_bending = btFemBending::automatic;
    /// Constants for btFemElasticLaw::orthotropic, which ignores E and nu. An orthotropic material cannot yield or
    /// relax, and takes mean dilatation with accurate bending alone. For directions that vary in space,
    /// pass a function of position to setMaterials.
    btFemOrthotropic m_orthotropic;

    /// Constants of laws with constants of their own, in the order of docs/materials.md; 0 for the others.
    btScalar m_lawConstants[bullet_fem::kMaxLawConstants] = {};

    /// A transversely isotropic material with fibres along m_orthotropic.m_along and equal directions across: Young's
    /// modulus [Pa] and Poisson's ratio [-] under tension along the fibres, and under tension across them within the
    /// isotropic plane, and the shear modulus along the fibres [Pa]. All other values are those of btFemMaterial().
    /// Checked when it is assigned to a body.
    static btFemMaterial transverselyIsotropic(btScalar youngAlong, btScalar youngAcross, btScalar poissonAlong,
                                               btScalar poissonAcross, btScalar shearAlong);

    static btFemMaterial rubber();    ///< soft natural rubber: 2 MPa, nu .47, 1100 kg/m3
    static btFemMaterial foam();      ///< upholstery foam: 50 kPa, nu .1, 40 kg/m3
    static btFemMaterial jelly();     ///< gelatine: 10 kPa, nu .45, 1000 kg/m3, Neo-Hookean
    static btFemMaterial flesh();     ///< muscle and fat: 60 kPa, nu .45, 1060 kg/m3, Neo-Hookean
    static btFemMaterial wood();      ///< softwood taken as isotropic: 9 GPa, nu .3, 500 kg/m3
    static btFemMaterial clay();      ///< soft clay, undrained: 2.5 MPa, nu .45, 1800 kg/m3, yields at 50 kPa
    static btFemMaterial lead();      ///< 16 GPa, nu .44, 11340 kg/m3, yields at 5.5 MPa and hardens by 20 MPa
    static btFemMaterial mildFoam();  ///< foam that keeps dents: as foam(), yields at 2.5 kPa, with a creep of 2 / s

    /// Rubber by its hardness on Shore's scale A, in [10, 95]: E by Gent's formula, nu from a bulk modulus of 2 GPa,
    /// 1100 kg/m3, a loss factor of 0.1 at 10 Hz, Hooke's law with mean dilatation (docs/materials.md, Rubber by
    /// hardness). Outside the range: if `why` is given, it names the value, the range and the remedy, and the default
    /// material is returned; else std::invalid_argument is thrown.
    static btFemMaterial shoreA(btScalar hardness, std::string* why = nullptr);
    /// Hard rubber and thermoplastic elastomers by hardness on Shore's scale D, in [30, 70], as shoreA() with 1200
    /// kg/m3 and the fit of E by Qi, Joyce and Boyce.
    static btFemMaterial shoreD(btScalar hardness, std::string* why = nullptr);

    /// Sets m_stiffnessDamping so that the loss factor [-], in [0, 2], of a vibration of `frequency` [Hz], in [1e-3,
    /// 1e5], is `lossFactor`, beside m_massDamping, which stays. The loss factor grows in proportion to the frequency.
    /// Returns false, with the reason in `why`, outside the ranges, if m_massDamping alone gives more, or if
    /// m_stiffnessDamping would be above 10 s; without `why` it throws std::invalid_argument.
    bool setLossFactor(btScalar lossFactor, btScalar frequency, std::string* why = nullptr);
    /// The loss factor [-] at a frequency [Hz]: alpha / w + beta w, w = 2 pi frequency.
    btScalar lossFactor(btScalar frequency) const;

    /// True if every value is finite and in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};
