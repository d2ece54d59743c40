// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

constexpr int kWarpedRows = 15;  ///< rows of a WarpedBlock

/// Data of kLanes elements for products with K' during a step; the gradients include the rotation.
template <class Real>
struct alignas(64) WarpedBlock
{
    Real m_gradient[9][kLanes];  ///< g'_a = R g_a, a = 1, 2, 3 [1/m]; with assumed strains R, row-major
    /// Tension factor times R V sigma+ R^T, with assumed strains times V sigma+: xx, yy, zz, yz, xz, xy.
    Real m_tension[6][kLanes];

    /// Both arrays as kWarpedRows rows of kLanes numbers.
    Real* rows() { return &m_gradient[0][0]; }
};
static_assert(sizeof(WarpedBlock<float>) == sizeof(float) * kWarpedRows * kLanes);

/// Minimum pivot of tr(S) I - S, F = R S, as a share of its trace [-]. Elements below it are flat or inverted: their
/// rotation is about to jump, and they omit the skew term of initial stress (withInitialStress()).
constexpr double kMinPivot = 0.01;

/// The initial stress of kLanes elements, times their volumes, in their own frames [J]: xx, yy, zz, yz, xz, xy.
template <class Real>
struct alignas(64) StressBlock
{
    Real m_entry[6][kLanes];
};

/// Derivative of the stress in kLanes elements whose law varies, for products with K': l C (C : H) and, in patches,
/// C times the patch's mean of C : H, weighted by volume.
template <class Real>
struct alignas(64) TangentBlock
{
    Real m_cofactor[6][kLanes];  ///< C / sqrt(k): xx, yy, zz, yz, xz, xy
    Real m_bulk[kLanes];         ///< l [J]
    Real m_patchBulk[kLanes];    ///< coefficient of the patch's mean [J]; 0 without patches; k in runAssumedPass() [-]
};

/// Element pass, once a step: F = D_s D_m^-1 of every element, its polar rotation R, its force and its part of A. With
/// E = sym(R^T F) - I,
///   elastic = V (2 mu E + lambda tr(E) I),   viscous = V (2 mu D + lambda tr(D) I),   D = sym(R^T Fdot),
///   sigma+ = positive part of elastic / V,   corner forces f_a = -R (elastic + damping viscous) g_a  [N].
/// In patches, the V-weighted mean of tr(E) over the patch replaces tr(E), in E itself, too. An initial stress sigma_0
/// adds V sigma_0 to elastic, and the terms of withInitialStress() to the forces. Edges, and F - R, are computed in
/// double and then rounded to Real, so that small strains have the relative accuracy of Real. R comes from Newton's
/// iteration, started from the rotation of the last step; elements where it may fail are done one by one by
/// polarRotation(). Positions and velocities must be finite.
template <class Real>
struct ElementPass
{
    const ElementBlocks<Real>* m_elements;
    const PaddedVec3* m_x;        ///< per node [m]
    const PaddedVec3* m_v;        ///< per node [m/s]
    double m_damping;             ///< coefficient of the viscous force [s]
    double m_tensionFactor;       ///< coefficient of T in A, c h^2 [s2]; 0 skips the spectral part
    Quaternion* m_rotation;       ///< in: last step's, out: this step's; kLanes a block
    CornerBlock<Real>* m_force;   ///< out
    WarpedBlock<Real>* m_warped;  ///< out
    bool m_isRotated = false;     ///< true: m_rotation already belongs to m_x, and stays unchanged
    const StressBlock<Real>* m_initialStress = nullptr;  ///< one per block; null for none
    /// Output for laws that vary (law.h), one per block; null if ElementBlocks::m_law is empty. Then m_warped has g'
    /// sqrt(k) and T / k, so that k multiplies all of K'.
    TangentBlock<Real>* m_tangent = nullptr;
    const double* m_history = nullptr;  ///< history variables of the laws (BodyState::m_lawHistory); null for none
};

/// Runs the pass over work units (ElementBlocks::workUnitCount()), on the widest vectors that the processor has.
/// Bitwise independent of the division into ranges. Never allocates; thread-safe on distinct work units.
template <class Real>
void runElementPass(const ElementPass<Real>& pass, Range pieces);

/// Strains of kLanes elements in their frames, sym(R^T F) - I [-]: xx, yy, zz, yz, xz, xy, shears not doubled.
template <class Real>
struct alignas(64) StrainBlock
{
    Real m_entry[6][kLanes];
};

/// Strains and rotations of all elements at the present positions, with assumed strains in the frames of their patches.
/// F - R is computed in double and R as in an ElementPass. Positions must be finite.
template <class Real>
struct ElementStrains
{
    const ElementBlocks<Real>* m_elements;
    const PaddedVec3* m_x;        ///< per node [m]
    Quaternion* m_rotation;       ///< in: initial guess, out: solution; kLanes a block
    StrainBlock<Real>* m_strain;  ///< out, one per block
};

/// Runs over a range of blocks, with assumed strains of work units (ElementBlocks::workUnitCount()), on the widest
/// vectors that the processor has. Bitwise independent of the division into ranges. Never allocates; thread-safe on
/// distinct ranges.
template <class Real>
void runElementStrains(const ElementStrains<Real>& strains, Range blocks);

}  // namespace bullet_fem
