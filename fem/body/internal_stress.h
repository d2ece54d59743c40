// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/elements/element_pass.h"

namespace bullet_fem
{

class Threads;

/// True if any element has a stress besides the one of its strain.
bool hasInitialStress(const Body& body);

/// Initial stress of element e, in the frame that rotates with it [Pa]: the given stress, whose pressure is averaged
/// over the element's patch as the volume change is, minus 2 mu (eps_p + sum g_i alpha_i). Never allocates.
SymmetricTensor initialStress(const Body& body, int e);

/// sum g_i alpha_i of the element's relaxation terms [-].
SymmetricTensor relaxedStrain(const Body& body, int e);

/// V mu (eps_p : eps_p + 2 eps_p : sum g_i alpha_i + sum g_i alpha_i : alpha_i) [J]: with it the energy of elastic
/// strain e = dev(eps) - eps_p is V mu ((1 - sum g_i) |e|^2 + sum g_i |e - alpha_i|^2).
double inelasticEnergy(const Body& body, int e);

/// Initial stresses of all elements, times their volumes, in the kernels' layout; with assumed strains those that do
/// the same work on the elements' own strains. Never allocates. Bitwise independent of the number of threads.
template <class Real>
void gatherInitialStress(const Body& body, const Threads* threads, StressBlock<Real>* out);

}  // namespace bullet_fem
