// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// Responses of laws that are written for one element at a time, for as many lanes as a vector has. All values include
/// the volume; symmetric matrices are xx, yy, zz, yz, xz, xy.
template <class Real>
struct alignas(64) SingleResponses
{
    /// Evaluates the laws of the lanes from `first` on; other lanes keep their values. `history`: BodyState's.
    void respond(const ElementBlocks<Real>& elements, const double* history, int first, int count);

    Real m_strain[6][kLanes];                                                          ///< in: e, shears not doubled
    Real m_lambda[kLanes], m_pressure[kLanes];                                         ///< in [J]
    Real m_stress[6][kLanes], m_cofactor[6][kLanes], m_bulk[kLanes], m_shear[kLanes];  ///< in and out
};

}  // namespace bullet_fem
