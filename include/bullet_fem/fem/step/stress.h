// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Stress in world axes [Pa], tension positive; symmetric by construction.
using Stress = SymmetricTensor;

/// Von Mises equivalent stress sqrt(3/2 s : s), s the deviator of sigma [Pa], >= 0: the magnitude of a uniaxial stress,
/// sqrt(3) times that of pure shear, 0 for hydrostatic pressure.
BULLETFEM_API double vonMises(const Stress& stress);

/// Elastic stress of element e, in [0, element count), at the body's present positions, by Hooke's law in the frame
/// that rotates with the element (docs/theory.md, Stress), plus its initial stress sigma_0:
///
///     sigma = R (2 mu eps + lambda tr(eps) I + sigma_0) R^T,   eps = sym(R^T F) - I
///
/// with C eps of an orthotropic material, or a Neo-Hookean one's stress, in place of Hooke's law. The elastic forces of
/// a step derive from it; viscous stress is excluded. Finite for every finite shape, flat and inverted elements
/// included. In a partly filled element it is the stress of the filled share of the volume. Never allocates.
BULLETFEM_API Stress elementStress(const Body& body, int e);

/// Elastic stresses of all elements, in the mesh's order [Pa]. Allocates only when `perElement` grows.
BULLETFEM_API void elementStresses(const Body& body, std::vector<Stress>& perElement);

/// Nodal stresses [Pa]: the mean over the adjacent elements, weighted by their filled volumes; zero at loose nodes.
/// Smoother than element stresses, with lower peaks. `perElement` has one entry per element; allocates only when
/// `perNode` grows.
BULLETFEM_API void nodeStresses(const BodyModel& model, const std::vector<Stress>& perElement,
                                std::vector<Stress>& perNode);

/// Impedance rho c of pressure waves [Pa s/m], c = sqrt(C / rho) with the largest of C_11, C_22, C_33 at small strain
/// in the axes of the rest shape; the largest of the body's regions. rho is a region's density, or the body's mass over
/// its volume if that is 0. A body that meets an obstacle at speed v is first stressed by rho c v there [Kolsky 1953].
/// Never allocates.
BULLETFEM_API double waveImpedance(const Body& body);

}  // namespace bullet_fem
