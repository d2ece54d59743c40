// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <string>

#include "LinearMath/btScalar.h"
#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

/// Whether the tetrahedra of a patch (those of a cube of the lattice, or four to eight neighbours of any other mesh)
/// share one volume change. Linear tetrahedra that each keep their own volume are too stiff where nu comes near .5.
enum class btFemMeanDilatation
{
    automatic,  ///< on where nu is above .4, and for accurate bending
    on,
    off
};

/// How stress follows from strain (docs/materials.md, Large strain).
enum class btFemElasticLaw
{
    hooke,       ///< linear in the strain of the rotated frame
    neoHooke,    ///< the same at small strain; stiffens as it is stretched, and without bound as it is crushed
    orthotropic  ///< linear as hooke, with the constants and axes of m_orthotropic in place of E and nu
};

/// A part of the shear modulus that relaxes, g_i exp(-t / tau_i) of a Prony series.
struct BULLETFEM_API btFemRelaxation
{
    btScalar m_share = btScalar(0);  ///< g_i of the shear modulus [-], in [0, 0.99]; 0 for none
    btScalar m_time = btScalar(1);   ///< tau_i [s], in [1e-6, 1e9]
};

/// The constants of a material with three planes of symmetry, such as wood or what fibres reinforce, and where its axes
/// 1, 2, 3 point. nu_ij is the contraction along j over the extension along i of a bar that is pulled along i;
/// nu_ij / E_i = nu_ji / E_j. What makes the stiffness indefinite is refused (docs/materials.md, Orthotropic).
struct BULLETFEM_API btFemOrthotropic
{
    btScalar m_young[3] = {btScalar(1e6), btScalar(1e6), btScalar(1e6)};    ///< E_1, E_2, E_3 [Pa], in (0, 1e13]
    btScalar m_poisson[3] = {btScalar(0.3), btScalar(0.3), btScalar(0.3)};  ///< nu_12, nu_13, nu_23 [-]
    btScalar m_shear[3] = {btScalar(4e5), btScalar(4e5), btScalar(4e5)};    ///< G_12, G_13, G_23 [Pa], in (0, 1e13]
    /// Axis 1, in the axes of the rest shape: of the world as the body lies when it is first stepped or prepared. It
    /// has any length but 0, and turns with the body from then on.
    btVector3 m_along = btVector3(1, 0, 0);
    /// Axis 2 is what of this is perpendicular to axis 1; not parallel to it. Axis 3 is their vector product.
    btVector3 m_across = btVector3(0, 1, 0);
};

/// An elastic material with Rayleigh damping D = alpha M + beta K: isotropic and linear, where it may yield and relax,
/// Neo-Hookean, or orthotropic (docs/materials.md). SI units whatever the scene's scale: a Bullet unit of length is a
/// metre, of mass a kilogram.
struct BULLETFEM_API btFemMaterial
{
    btScalar m_youngModulus = btScalar(1e6);        ///< E [Pa], in (0, 1e13]
    btScalar m_poissonRatio = btScalar(0.3);        ///< nu [-], in [0, 0.499]
    btScalar m_density = btScalar(1000);            ///< rho [kg/m3], in [0, 1e6]; 0 keeps the body's own node masses
    btScalar m_massDamping = btScalar(0);           ///< alpha [1/s], in [0, 1e4]
    btScalar m_stiffnessDamping = btScalar(0.005);  ///< beta [s], in [0, 10]
    btFemMeanDilatation m_meanDilatation = btFemMeanDilatation::automatic;  ///< against volumetric locking
    /// sigma_y [Pa], in (0, inf]: what strains beyond this von Mises stress does not come back; infinity never yields.
    btScalar m_yieldStress = std::numeric_limits<btScalar>::infinity();
    btScalar m_hardeningModulus = btScalar(0);  ///< H [Pa], in [0, 1e13]: sigma_y grows by H times the plastic strain
    /// Rate at which stress beyond sigma_y decays, as exp(-rate t) [1/s], in (0, inf]; infinity: at once.
    btScalar m_plasticCreep = std::numeric_limits<btScalar>::infinity();
    /// Largest plastic strain, sqrt(2/3 eps_p : eps_p) [-], in (0, 0.9]; strain beyond it is elastic again.
    btScalar m_mostPlasticStrain = btScalar(0.5);
    static constexpr int kMaxRelaxationTerms = 3;  ///< of m_relaxation
    [[deprecated("kMaxRelaxationTerms")]] static constexpr int kMostRelaxationTerms = kMaxRelaxationTerms;
    /// Viscoelasticity: E and nu are those of fast loads, and mu (1 - sum g_i (1 - exp(-t / tau_i))) the shear modulus
    /// after a time t; the bulk modulus stays. Those with a share stand first; the shares' sum is at most 0.99.
    btFemRelaxation m_relaxation[kMaxRelaxationTerms];
    /// The law; E and nu are those of small strain. A Neo-Hookean material does not yield or relax, and its elements
    /// have their own volume change each.
    btFemElasticLaw m_law = btFemElasticLaw::hooke;
    /// Against locking in bending: shear strains are averaged around edges, as volume changes are over patches. Bars of
    /// two cells across and more bend as they should within 6 %; a step takes two to three times as long. Not with mean
    /// dilatation off, and not for materials that yield or relax (docs/materials.md).
    bool m_accurateBending = false;
    /// Read with btFemElasticLaw::orthotropic alone, where E and nu are not. Such a material does not yield or relax,
    /// does not bend accurately, and its elements have their own volume change each. For directions that change from
    /// place to place, give setMaterials a function of the place.
    btFemOrthotropic m_orthotropic;

    /// An orthotropic material of which all directions across its fibres, m_orthotropic.m_along, are alike: Young's
    /// modulus [Pa] and Poisson's ratio [-] of a bar that is pulled along its fibres, and across them in the plane in
    /// which all is alike, and the modulus of shear along the fibres [Pa]. The rest is as of btFemMaterial(). Checked
    /// as all materials are, where it is given to a body.
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

    /// True if every value is finite and in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};
