// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/elements/element_product.h"

namespace bullet_fem
{

/// Strains of kLanes elements in quads, for vectors of four numbers: xx, yy, zz, yz and xz, xy, theta, 0. Shears are
/// doubled; theta is the mean volume change of the element's patch.
template <class Real>
struct alignas(64) StrainQuads
{
    Real m_quad[2][kLanes][4];
};

/// A domain's mean of the same numbers; that of theta has no use.
template <class Real>
struct alignas(32) DomainStrain
{
    Real m_quad[2][4];
};

/// What the product needs of kLanes elements during a step.
template <class Real>
struct alignas(64) SmoothedBlock
{
    Real m_rotation[9][kLanes];  ///< R, row-major
    Real m_tension[6][kLanes];   ///< tension factor times V sigma+, in the element's frame: xx, yy, zz, yz, xz, xy
};

/// Of kLanes elements, H V sigma+ times the tension factor, H = sum over b of p_b g_b^T; row-major.
template <class Real>
struct alignas(64) TensionBlock
{
    Real m_entry[9][kLanes];
};

/// The EdgeDomains of a shape as kernels read them. None where strains are not smoothed. Const once built.
template <class Real>
struct EdgeSmoothing
{
    EdgeSmoothing(const RestShape& shape, const ElementLanes& lanes);

    bool empty() const { return m_lanes.empty(); }
    int domainCount() const { return static_cast<int>(m_start.size()) - 1; }

    /// Of kLanes elements.
    struct alignas(64) BlockShares
    {
        Real m_own[kLanes];                ///< 1 - b [-]
        Real m_ofDomain[kLanes];           ///< b / 6 [-]
        std::int32_t m_domain[kLanes][6];  ///< of the six edges
    };

    std::vector<BlockShares> m_lanes;  ///< one a block
    std::vector<int> m_start = {0};    ///< of every domain and of the end, into the next two
    std::vector<int> m_place;          ///< of an element's first quad in an array of StrainQuads, taken as quads
    std::vector<Real> m_weight;        ///< of the element in the domain's mean [-]
};

/// An array of StrainQuads and the domains' means.
template <class Real>
struct SmoothedStrain
{
    StrainQuads<Real>* m_element;  ///< one a block
    DomainStrain<Real>* m_domain;  ///< one a domain
};

/// What an ElementPass is for elements whose strains are smoothed: with eps_e and its rate in the element's frame,
/// theta their mean volume change over the element's patch, and s the smoothed strain of EdgeDomains,
///     stress = V (2 mu dev(s) + (lambda + 2/3 mu) theta I) + V sigma_0,     f_a = -R_e (stress + W + viscous) g_a,
/// W skew, so that the element has no torque (withInitialStress()): the forces are the gradient of the energy
///     sum over domains of mu |dev(s_k)|^2 + of elements (1 - b) mu V |dev(eps)|^2 + (lambda + 2/3 mu) V theta^2 / 2.
/// It goes in three parts, each when the one before is done for all: findStrains, averageStrains twice, findForces.
template <class Real>
struct SmoothedPass
{
    ElementPass<Real> m_elements;            ///< m_warped and m_isRotated are not read
    const EdgeSmoothing<Real>* m_smoothing;  ///< not empty
    SmoothedStrain<Real> m_elastic;          ///< scratch, of eps
    SmoothedStrain<Real> m_damped;           ///< scratch, of eps + damping times its rate
    SmoothedBlock<Real>* m_warped;           ///< out, one a block
};

/// What an ElementProduct is, likewise in three parts.
template <class Real>
struct SmoothedProduct
{
    ElementProduct<Real> m_elements;         ///< m_warped is not read
    const EdgeSmoothing<Real>* m_smoothing;  ///< not empty
    SmoothedStrain<Real> m_strain;           ///< scratch
    TensionBlock<Real>* m_tension;           ///< scratch, one a block
    const SmoothedBlock<Real>* m_warped;     ///< of the pass
};

// All run on the widest vectors that the processor has, over ranges of pieces (ElementBlocks::pieceCount()), of domains
// or of blocks. Any division into ranges gives the same bits. They never allocate, and are safe on distinct ranges at
// the same time.

/// Rotations and strains, of a range of pieces.
template <class Real>
void findStrains(const SmoothedPass<Real>& pass, Range pieces);
/// Likewise.
template <class Real>
void findStrains(const SmoothedProduct<Real>& product, Range pieces);
/// The means of a range of domains.
template <class Real>
void averageStrains(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, Range domains);
/// Forces, and what products need, of a range of blocks.
template <class Real>
void findForces(const SmoothedPass<Real>& pass, Range blocks);
/// Likewise.
template <class Real>
void findForces(const SmoothedProduct<Real>& product, Range blocks);

/// The same in plain C++: what the kernels are tested against.
namespace reference
{
template <class Real>
void findStrains(const SmoothedPass<Real>& pass, Range pieces);
template <class Real>
void findStrains(const SmoothedProduct<Real>& product, Range pieces);
template <class Real>
void averageStrains(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, Range domains);
template <class Real>
void findForces(const SmoothedPass<Real>& pass, Range blocks);
template <class Real>
void findForces(const SmoothedProduct<Real>& product, Range blocks);
}  // namespace reference

}  // namespace bullet_fem
