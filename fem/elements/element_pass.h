// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

constexpr int kWarpedRows = 15;  ///< of a WarpedBlock

/// What the product needs of kLanes elements during a step: no rotation any more, it is in the gradients.
template <class Real>
struct alignas(64) WarpedBlock
{
    Real m_gradient[9][kLanes];  ///< g'_a = R g_a, a = 1, 2, 3 [1/m]
    Real m_tension[6][kLanes];   ///< tension factor times R V sigma+ R^T: xx, yy, zz, yz, xz, xy

    /// Both, as kWarpedRows rows of kLanes numbers.
    Real* rows() { return &m_gradient[0][0]; }
};
static_assert(sizeof(WarpedBlock<float>) == sizeof(float) * kWarpedRows * kLanes);

/// Elements in which tr(S) I - S, F = R S, has a pivot below this share of its trace are flat or inside out: their
/// rotation is about to jump, and their initial stress leaves it out (withInitialStress()).
constexpr double kLeastPivot = 0.01;

/// The initial stress of kLanes elements, times their volumes, in their own frames [J]: xx, yy, zz, yz, xz, xy.
template <class Real>
struct alignas(64) StressBlock
{
    Real m_entry[6][kLanes];
};

/// F = D_s D_m^-1 of every element, its polar rotation R, its force and its part of A, once a step. With
/// E = sym(R^T F) - I,
///   elastic = V (2 mu E + lambda tr(E) I),   viscous the same of sym(R^T Fdot),   sigma+ = positive part of elastic /
///   V, corner forces  f_a = -R (elastic + damping viscous) g_a  [N].
/// Where elements make patches, tr(E) is the mean over the element's patch, weighted by V, in E itself, too.
/// An initial stress sigma_0 adds V sigma_0 to elastic, and to the forces what withInitialStress() says.
/// Edges, and F - R, are taken in double and then rounded to Real, so that strains have the digits of Real however
/// small they are. R by Newton's iteration from the rotation of the last step; elements where it is not sure to be
/// right are done one by one, by polarRotation(). Positions and velocities must be finite.
template <class Real>
struct ElementPass
{
    const ElementBlocks<Real>* m_elements;
    const PaddedVec3* m_x;                               ///< of every node [m]
    const PaddedVec3* m_v;                               ///< of every node [m/s]
    double m_damping;                                    ///< of the viscous force [s]
    double m_tensionFactor;                              ///< of T in A, h^2 [s2]; 0 spares the spectral part
    Quaternion* m_rotation;                              ///< in: of the last step, out: of this one; kLanes a block
    CornerBlock<Real>* m_force;                          ///< out
    WarpedBlock<Real>* m_warped;                         ///< out
    bool m_isRotated = false;                            ///< m_rotation is that of m_x already, and stays as it is
    const StressBlock<Real>* m_initialStress = nullptr;  ///< one a block; null for none
    /// Out, one a block, where elements have laws that are not linear (neo_hooke.h): the matrices C' of an
    /// ElementProduct. Null where ElementBlocks::m_law is empty.
    StressBlock<Real>* m_cofactor = nullptr;
};

/// Runs the pass over pieces (see ElementBlocks::pieceCount()), on the widest vectors that the processor has. Any
/// division into ranges gives the same bits. Never allocates; safe on distinct pieces at the same time.
template <class Real>
void runElementPass(const ElementPass<Real>& pass, Range pieces);

/// The same in plain C++: what the kernel is tested against.
namespace reference
{
template <class Real>
void runElementPass(const ElementPass<Real>& pass, Range pieces);
}

}  // namespace bullet_fem
