// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/elements/element_product.h"

namespace bullet_fem
{

/// Strains of kLanes elements as quads, for vectors of four numbers: xx, yy, zz, yz and xz, xy, theta, 0. Shears are
/// doubled; theta is the mean volume change of the element's patch.
template <class Real>
struct alignas(64) StrainQuads
{
    Real m_quad[2][kLanes][4];
};

/// A domain's mean strain as quads; its theta is unused.
template <class Real>
struct alignas(32) DomainStrain
{
    Real m_quad[2][4];
};

/// Data of kLanes smoothed elements for products with K' during a step.
template <class Real>
struct alignas(64) SmoothedBlock
{
    Real m_rotation[9][kLanes];  ///< R, row-major
    Real m_tension[6][kLanes];   ///< tension factor times V sigma+, in the element's frame: xx, yy, zz, yz, xz, xy
};

/// H V sigma+ times the tension factor, of kLanes elements, H = sum over b of p_b g_b^T; row-major.
template <class Real>
struct alignas(64) TensionBlock
{
    Real m_entry[9][kLanes];
};

/// The EdgeDomains of a shape in the kernels' layout. Empty without smoothed strains. Constant once built.
template <class Real>
struct EdgeSmoothing
{
    EdgeSmoothing(const RestShape& shape, const ElementLanes& lanes);

    bool empty() const { return m_lanes.empty(); }
    int domainCount() const { return static_cast<int>(m_start.size()) - 1; }

    /// Shares of kLanes elements.
    struct alignas(64) BlockShares
    {
        Real m_own[kLanes];                ///< 1 - b [-]
        Real m_ofDomain[kLanes];           ///< b / 6 [-]
        std::int32_t m_domain[kLanes][6];  ///< domains of the six edges
    };

    std::vector<BlockShares> m_lanes;  ///< one per block
    std::vector<int> m_start = {0};    ///< start of each domain in the next two arrays, then the end
    std::vector<int> m_place;          ///< index of an element's first quad in an array of StrainQuads, taken as quads
    std::vector<Real> m_weight;        ///< weight of the element in the domain's mean [-]
};

/// An array of StrainQuads and the domains' means.
template <class Real>
struct SmoothedStrain
{
    StrainQuads<Real>* m_element;  ///< one per block
    DomainStrain<Real>* m_domain;  ///< one per domain
};

/// Element pass for smoothed strains: with the elastic strain eps_e and its rate in the element's frame, theta the mean
/// volume change over the element's patch, and s the smoothed strain of EdgeDomains,
///     stress = V (2 mu dev(s) + (lambda + 2/3 mu) theta I) + V sigma_0,     f_a = -R_e (stress + W + viscous) g_a,
/// with the skew W that makes the element's torque zero (withInitialStress()): the forces are the gradient of the
/// energy
///     sum over domains of mu |dev(s_k)|^2
///         + sum over elements of (1 - b) mu V |dev(eps)|^2 + (lambda + 2/3 mu) V theta^2 / 2.
/// Three stages, each for all elements before the next: findStrains, averageStrains twice, findForces.
template <class Real>
struct SmoothedPass
{
    ElementPass<Real> m_elements;            ///< m_warped and m_isRotated are unused
    const EdgeSmoothing<Real>* m_smoothing;  ///< not empty
    SmoothedStrain<Real> m_elastic;          ///< scratch, strains eps
    SmoothedStrain<Real> m_damped;           ///< scratch, eps + damping times its rate
    SmoothedBlock<Real>* m_warped;           ///< output, one per block
    /// Plastic and relaxed strain, deviatoric, subtracted from eps before it is averaged; null for none. One per block.
    const StrainBlock<Real>* m_inelastic = nullptr;
};

/// Element product for smoothed strains, in the three stages findStrains, averageStrains, findForces.
template <class Real>
struct SmoothedProduct
{
    ElementProduct<Real> m_elements;         ///< m_warped is unused
    const EdgeSmoothing<Real>* m_smoothing;  ///< not empty
    SmoothedStrain<Real> m_strain;           ///< scratch
    TensionBlock<Real>* m_tension;           ///< scratch, one per block
    const SmoothedBlock<Real>* m_warped;     ///< output of the pass
};

// All run over ranges of work units (ElementBlocks::workUnitCount()), of domains or of blocks, on the widest vectors
// that the processor has. Bitwise independent of the division into ranges. Never allocate; thread-safe on distinct
// ranges.

/// Rotations and strains of a range of work units.
template <class Real>
void findStrains(const SmoothedPass<Real>& pass, Range pieces);
/// Strains of the vector p, of a range of work units.
template <class Real>
void findStrains(const SmoothedProduct<Real>& product, Range pieces);
/// Means of a range of domains.
template <class Real>
void averageStrains(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, Range domains);
/// Forces and the data of products, of a range of blocks.
template <class Real>
void findForces(const SmoothedPass<Real>& pass, Range blocks);
/// Corner vectors f_a, of a range of blocks.
template <class Real>
void findForces(const SmoothedProduct<Real>& product, Range blocks);

}  // namespace bullet_fem
