// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/laws/law_table.h"
#include "bullet_fem/fem/laws/orthotropic.h"

namespace bullet_fem
{

/// An element's values that a law's response depends on, besides its strain.
struct LawPoint
{
    double m_lambda = 0, m_mu = 0;        ///< moduli at small strain [Pa]
    double m_pressure = 0;                ///< p of mean dilatation [Pa]: p C is added to the stress (volume_ratio.h)
    double m_size = 0;                    ///< cube root of the element's volume [m]
    const double* m_constants = nullptr;  ///< as Law::m_constants lists them
    const double* m_history = nullptr;    ///< Law::m_historyCount history variables
    const ElasticMatrix* m_stiffness = nullptr;  ///< C of an anisotropic law
};

/// Response of a law in one element of strain e = S - I, F = R S, in the units of lambda and mu. The stress is dW/dS;
/// A takes its derivative along H = dF R^T as l C (C : H) + k mu (H + H^T) + H T, with T the tension of an ElementPass.
/// The response may be in the frame of the element or, for an isotropic law, in the world's, with R e R^T.
struct LawResponse
{
    Mat3 m_stress;        ///< dW/dS
    Mat3 m_cofactor;      ///< C: derivative of the law's volume change by S, I for a linear law
    double m_bulk = 0;    ///< l, >= 0
    double m_shear = 1;   ///< k [-], >= 0
    double m_energy = 0;  ///< W, without the energy of m_pressure
};

/// How the elements evaluate a law.
enum class LawKind
{
    linear,       ///< by lambda and mu alone, as Hooke's law
    anisotropic,  ///< by a constant matrix C
    varying       ///< by m_respond in every step: nonlinear, or with history variables
};

/// A constitutive law. One is a file pair of this folder and its line in laws.cpp; elements, steps, energy, stress,
/// saved states, files and scenes know it by this table alone.
struct Law
{
    const char* m_name;   ///< in scenes and programs
    const char* m_title;  ///< in messages
    LawKind m_kind;
    /// True if lambda multiplies a function of J = det F (volume_ratio.h), which patches of mean dilatation average.
    bool m_hasVolumeRatio;
    bool m_isInLanes;         ///< true if kernels have the law for several elements at a time (neo_hooke-inl.h)
    const char* m_noPatches;  ///< why it refuses mean dilatation; null if it takes it
    std::vector<LawConstant> m_constants;  ///< at most kMaxLawConstants
    int m_historyCount;                    ///< history variables of an element, initially 0
    /// Moduli at small strain, of which the factor is made.
    LameModuli (*m_moduli)(const double* constants, double youngModulus, double poissonRatio);
    /// Response to a symmetric e.
    LawResponse (*m_respond)(const Mat3& e, const LawPoint& point);
    /// False, and the reason, for constants that fit their ranges but not each other; null if all do.
    bool (*m_isConsistent)(const double* constants, std::string* why) = nullptr;
    /// Advances the history variables at the end of a step; null without any.
    void (*m_advance)(const Mat3& e, const LawPoint& point, double* history) = nullptr;
};

/// All laws, in the order of ElasticLaw.
const std::vector<Law>& allLaws();

/// The traits and functions of a law.
inline const Law& lawOf(ElasticLaw law)
{
    return allLaws()[static_cast<std::size_t>(law)];
}

/// True if the constants are in their ranges and consistent; else `why` (if given) names value, range and remedy.
bool areLawConstants(const Law& law, const double* constants, std::string* why);

}  // namespace bullet_fem
