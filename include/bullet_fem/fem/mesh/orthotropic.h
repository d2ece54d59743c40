// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <string>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/symmetric.h"

namespace bullet_fem
{

/// The moduli of small strain: stress = 2 mu strain + lambda tr(strain) I.
struct BULLETFEM_API LameModuli
{
    double m_mu = 0;      ///< [Pa]
    double m_lambda = 0;  ///< [Pa]

    /// Adds both moduli.
    LameModuli& operator+=(const LameModuli& b);

    /// E = mu (3 lambda + 2 mu) / (lambda + mu) [Pa]; a lambda below 0 counts as 0, which keeps mu.
    double youngModulus() const;
    /// nu = lambda / (2 (lambda + mu)) [-], at least 0 and at most Material::kMostPoissonRatio.
    double poissonRatio() const;
};

/// The stress of a strain, sigma = C eps, in the order xx, yy, zz, yz, xz, xy with doubled shear strains.
struct ElasticMatrix
{
    double m[6][6] = {};  ///< symmetric [Pa]

    /// Row i, column j, both in [0, 6).
    double& operator()(int i, int j) { return m[i][j]; }
    /// Likewise, to read.
    double operator()(int i, int j) const { return m[i][j]; }
};

/// C of Hooke's isotropic law.
BULLETFEM_API ElasticMatrix isotropicStiffness(const LameModuli& moduli);

/// C eps [Pa].
BULLETFEM_API SymmetricTensor stressOf(const ElasticMatrix& C, const SymmetricTensor& strain);

/// The elastic constants of a material with three planes of symmetry, and where its axes 1, 2, 3 point. nu_ij is the
/// contraction along j over the extension along i of a bar that is pulled along i, so that nu_ij / E_i = nu_ji / E_j.
struct BULLETFEM_API Orthotropic
{
    /// det of [[1, -n12, -n13], [-n12, 1, -n23], [-n13, -n23, 1]] with n_ij = nu_ij sqrt(E_j / E_i) has to be above
    /// this [-]; it is where the compliance ceases to be positive definite that it is 0, and .0045 of an isotropic
    /// material of nu = .499.
    static constexpr double kLeastDeterminant = 0.004;
    /// Sine of the least angle between both directions [-].
    static constexpr double kLeastSine = 1e-3;
    static constexpr double kMostModulus = 1e13;  ///< of E_i and G_ij [Pa], as of Material

    std::array<double, 3> m_young = {1e6, 1e6, 1e6};    ///< E_1, E_2, E_3 [Pa], each in (0, 1e13]
    std::array<double, 3> m_poisson = {0.3, 0.3, 0.3};  ///< nu_12, nu_13, nu_23 [-], |nu_ij| < sqrt(E_i / E_j)
    std::array<double, 3> m_shear = {4e5, 4e5, 4e5};    ///< G_12, G_13, G_23 [Pa], each in (0, 1e13]
    Vec3 m_along = {1, 0, 0};                           ///< axis 1 in the axes of the rest shape, of any length but 0
    Vec3 m_across = {0, 1, 0};  ///< axis 2 is what of this is perpendicular to axis 1; not parallel to it

    /// A material of which all directions across `along` are alike: E and nu of a bar that is pulled along the fibres,
    /// and across them within the plane, G of shear along them. G across is E_across / (2 (1 + nu_across)).
    static Orthotropic transverselyIsotropic(double youngAlong, double youngAcross, double poissonAlong,
                                             double poissonAcross, double shearAlong);

    /// True if C is positive definite and the axes are some; else `why` (if given) names value, range and remedy.
    bool valid(std::string* why = nullptr) const;

    /// The axes 1, 2, 3 in the columns: orthonormal and right-handed.
    Mat3 axes() const;
    /// C in the axes of the rest shape.
    ElasticMatrix stiffness() const;
    /// The share t <= 1 of the mean of C over all directions [Voigt], an isotropic law, which C is nowhere less stiff
    /// than: C minus it is positive semidefinite. All of C where that is isotropic. lambda may be below 0.
    LameModuli isotropicPart() const;

    /// The same values.
    friend bool operator==(const Orthotropic& a, const Orthotropic& b)
    {
        const auto same = [](const Vec3& u, const Vec3& v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
        return a.m_young == b.m_young && a.m_poisson == b.m_poisson && a.m_shear == b.m_shear &&
               same(a.m_along, b.m_along) && same(a.m_across, b.m_across);
    }
    /// Not so.
    friend bool operator!=(const Orthotropic& a, const Orthotropic& b) { return !(a == b); }
};

}  // namespace bullet_fem
