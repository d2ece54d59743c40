// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <string>

#include "LinearMath/btScalar.h"
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
    hooke,    ///< linear in the strain of the rotated frame
    neoHooke  ///< the same at small strain; stiffens as it is stretched, and without bound as it is crushed
};

/// A part of the shear modulus that relaxes, g_i exp(-t / tau_i) of a Prony series.
struct BULLETFEM_API btFemRelaxation
{
    btScalar m_share = btScalar(0);  ///< g_i of the shear modulus [-], in [0, 0.99]; 0 for none
    btScalar m_time = btScalar(1);   ///< tau_i [s], in [1e-6, 1e9]
};

/// An isotropic elastic material with Rayleigh damping D = alpha M + beta K: linear, where it may yield and relax, or
/// Neo-Hookean (docs/materials.md). SI units whatever the scene's scale: a Bullet unit of length is a metre, of mass a
/// kilogram.
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
    static constexpr int kMostRelaxationTerms = 3;  ///< of m_relaxation
    /// Viscoelasticity: E and nu are those of fast loads, and mu (1 - sum g_i (1 - exp(-t / tau_i))) the shear modulus
    /// after a time t; the bulk modulus stays. Those with a share stand first; the shares' sum is at most 0.99.
    btFemRelaxation m_relaxation[kMostRelaxationTerms];
    /// The law; E and nu are those of small strain. A Neo-Hookean material does not yield or relax, and its elements
    /// have their own volume change each.
    btFemElasticLaw m_law = btFemElasticLaw::hooke;
    /// Against locking in bending: shear strains are averaged around edges, as volume changes are over patches. Bars of
    /// two cells across and more bend as they should within 6 %; a step takes two to three times as long. Not with mean
    /// dilatation off, and not for materials that yield or relax (docs/materials.md).
    bool m_accurateBending = false;

    static btFemMaterial rubber();    ///< soft natural rubber: 2 MPa, nu .47, 1100 kg/m3
    static btFemMaterial foam();      ///< upholstery foam: 50 kPa, nu .1, 40 kg/m3
    static btFemMaterial jelly();     ///< gelatine: 10 kPa, nu .45, 1000 kg/m3
    static btFemMaterial flesh();     ///< muscle and fat: 60 kPa, nu .45, 1060 kg/m3
    static btFemMaterial wood();      ///< softwood taken as isotropic: 9 GPa, nu .3, 500 kg/m3
    static btFemMaterial clay();      ///< soft clay, undrained: 2.5 MPa, nu .45, 1800 kg/m3, yields at 50 kPa
    static btFemMaterial lead();      ///< 16 GPa, nu .44, 11340 kg/m3, yields at 5.5 MPa and hardens by 20 MPa
    static btFemMaterial mildFoam();  ///< foam that keeps dents: as foam(), yields at 2.5 kPa, with a creep of 2 / s

    /// True if every value is finite and in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};
