// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <string>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/symmetric.h"

namespace bullet_fem
{

/// Lame's constants: stress = 2 mu strain + lambda tr(strain) I at small strain.
struct BULLETFEM_API LameModuli
{
    double m_mu = 0;      ///< [Pa]
    double m_lambda = 0;  ///< [Pa]

    /// Adds both moduli.
    LameModuli& operator+=(const LameModuli& b);

    /// E = mu (3 lambda + 2 mu) / (lambda + mu) [Pa]; a lambda below 0 counts as 0, which keeps mu.
    double youngModulus() const;
    /// nu = lambda / (2 (lambda + mu)) [-], clamped to [0, Material::kMaxPoissonRatio].
    double poissonRatio() const;
};

/// A 6x6 stiffness matrix, sigma = C eps, in the order xx, yy, zz, yz, xz, xy with doubled shear strains.
struct ElasticMatrix
{
    double m[6][6] = {};  ///< symmetric [Pa]

    /// Entry in row i, column j, both in [0, 6), writable.
    double& operator()(int i, int j) { return m[i][j]; }
    /// Entry in row i, column j, both in [0, 6).
    double operator()(int i, int j) const { return m[i][j]; }
};

/// Stiffness matrix C of Hooke's isotropic law.
BULLETFEM_API ElasticMatrix isotropicStiffness(const LameModuli& moduli);

/// Stress C eps [Pa].
BULLETFEM_API SymmetricTensor stressOf(const ElasticMatrix& C, const SymmetricTensor& strain);

/// The elastic constants of a material with three planes of symmetry, and its axes 1, 2, 3. nu_ij is the contraction
/// along j over the extension along i of a bar under tension along i, so that nu_ij / E_i = nu_ji / E_j.
struct BULLETFEM_API Orthotropic
{
    /// Lower bound [-] of det [[1, -n12, -n13], [-n12, 1, -n23], [-n13, -n23, 1]] with n_ij = nu_ij sqrt(E_j / E_i).
    /// The compliance ceases to be positive definite where the determinant is 0; an isotropic material of nu = .499 has
    /// .0045.
    static constexpr double kMinDeterminant = 0.004;
    [[deprecated("kMinDeterminant")]] static constexpr double kLeastDeterminant = kMinDeterminant;
    /// Minimum sine of the angle between m_along and m_across [-].
    static constexpr double kMinSine = 1e-3;
    [[deprecated("kMinSine")]] static constexpr double kLeastSine = kMinSine;
    static constexpr double kMaxModulus = 1e13;  ///< maximum of E_i and G_ij [Pa], equal to that of Material
    [[deprecated("kMaxModulus")]] static constexpr double kMostModulus = kMaxModulus;

    std::array<double, 3> m_young = {1e6, 1e6, 1e6};    ///< E_1, E_2, E_3 [Pa], each in (0, 1e13]
    std::array<double, 3> m_poisson = {0.3, 0.3, 0.3};  ///< nu_12, nu_13, nu_23 [-], |nu_ij| < sqrt(E_i / E_j)
    std::array<double, 3> m_shear = {4e5, 4e5, 4e5};    ///< G_12, G_13, G_23 [Pa], each in (0, 1e13]
    Vec3 m_along = {1, 0, 0};                           ///< axis 1 in the axes of the rest shape, of any nonzero length
    Vec3 m_across = {0, 1, 0};  ///< its part perpendicular to axis 1 is axis 2; not parallel to m_along

    /// A transversely isotropic material with fibres along axis 1 and equal directions across: E [Pa] and nu [-] of a
    /// bar under tension along the fibres, and of one across them within the plane, and the shear modulus G along the
    /// fibres [Pa]. The transverse shear modulus is E_across / (2 (1 + nu_across)).
    static Orthotropic transverselyIsotropic(double youngAlong, double youngAcross, double poissonAlong,
                                             double poissonAcross, double shearAlong);

    /// True if C is positive definite and the axes are independent; else `why` (if given) names value, range and
    /// remedy.
    bool valid(std::string* why = nullptr) const;

    /// Axes 1, 2, 3 as columns: orthonormal and right-handed.
    Mat3 axes() const;
    /// Stiffness matrix C in the axes of the rest shape.
    ElasticMatrix stiffness() const;
    /// Strain over stress of a bar that is pulled along a unit vector in the axes of the rest shape [1/Pa]:
    /// sum of c_i^4 / E_i + sum over i < j of (1 / G_ij - 2 nu_ij / E_i) c_i^2 c_j^2, c its cosines with the axes
    /// [Jones 1999, ch. 2].
    double compliance(const Vec3& direction) const;
    /// The isotropic law t <C>: <C> is the mean of C over all directions (Voigt average), t in (0, 1] the largest share
    /// that leaves C - t <C> positive semidefinite. Equals C if that is isotropic. lambda may be negative.
    LameModuli isotropicPart() const;

    /// True if all constants and axes are equal.
    friend bool operator==(const Orthotropic& a, const Orthotropic& b)
    {
        const auto same = [](const Vec3& u, const Vec3& v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
        return a.m_young == b.m_young && a.m_poisson == b.m_poisson && a.m_shear == b.m_shear &&
               same(a.m_along, b.m_along) && same(a.m_across, b.m_across);
    }
    /// True if any constant or axis differs.
    friend bool operator!=(const Orthotropic& a, const Orthotropic& b) { return !(a == b); }
};

}  // namespace bullet_fem
