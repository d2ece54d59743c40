// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// A stress in the world's axes [Pa], tension positive. Symmetric because nothing else can be stored.
using Stress = SymmetricTensor;

/// Von Mises' equivalent stress, sqrt(3/2 s : s) with s the deviator of sigma [Pa], >= 0: in uniaxial stress its
/// magnitude, in pure shear sqrt(3) times that, under pressure from all sides 0.
BULLETFEM_API double vonMises(const Stress& stress);

/// Elastic stress of element e at the body's present positions, by Hooke's law in the frame that turns with the element
/// (docs/theory.md, Stress), with the initial stress sigma_0, if it has some:
///
///     sigma = R (2 mu eps + lambda tr(eps) I + sigma_0) R^T,   eps = sym(R^T F) - I
///
/// with C eps of an orthotropic material, or a Neo-Hookean one's stress, in place of Hooke's.
/// It is what the elastic forces of the step are made of, without the viscous part of Rayleigh's damping. Finite for
/// every finite shape, also of flat and inverted elements. Of an element that is partly filled, it is the stress of
/// what fills it: the forces are those of that share of the volume. Never allocates.
BULLETFEM_API Stress elementStress(const Body& body, int e);

/// The same of all elements, in the mesh's order. Allocates only when `perElement` grows.
BULLETFEM_API void elementStresses(const Body& body, std::vector<Stress>& perElement);

/// The mean over the elements at every node, weighted by their filled volumes; zero at nodes that no element uses.
/// Smooth to look at, and lower than the elements' peaks where stress changes from element to element. `perElement` has
/// one entry an element; allocates only when `perNode` grows.
BULLETFEM_API void nodeStresses(const BodyModel& model, const std::vector<Stress>& perElement,
                                std::vector<Stress>& perNode);

}  // namespace bullet_fem
