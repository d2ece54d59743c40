// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_pass.h"
#include "fem/elements/node_rotations.h"
#include "fem/elements/node_sums.h"
#include "fem/elements/orthotropic_elements.h"

namespace bullet_fem
{

/// The kernels of elements and nodes in plain C++, one element or node at a time in double precision.
namespace reference
{

template <class Real>
void runElementPass(const ElementPass<Real>& pass, Range pieces);
template <class Real>
void runElementProduct(const ElementProduct<Real>& product, Range pieces);
template <class Real>
void runElementStrains(const ElementStrains<Real>& strains, Range blocks);

void averageRotations(const NodeRotations& rotations, Range nodes);
Mat3 sumRotations(const NodeCorners& nodes, const Quaternion* rotation, Range blocks);
template <class Real>
void sumCorners(const NodeSums<Real>& sums, Range nodes);

template <class Real>
void runOrthotropicPass(const StretchPass<Real>& pass, Range blocks);
template <class Real>
void runOrthotropicProduct(const StretchProduct<Real>& product, Range blocks);

}  // namespace reference
}  // namespace bullet_fem
