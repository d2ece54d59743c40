// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/elements/element_pass.h"

namespace bullet_fem
{

class Threads;

/// True if elements have a stress that is not that of their strain.
bool hasInitialStress(const Body& body);

/// What element e has of it, in the frame that turns with it [Pa]: what was given, of which in a patch the pressure of
/// all elements is the patch's mean, as their volume change is, and -2 mu (eps_p + sum g_i alpha_i) of what has flown
/// and relaxed. Never allocates.
SymmetricTensor initialStress(const Body& body, int e);

/// sum g_i alpha_i of the element's relaxation terms [-].
SymmetricTensor relaxedStrain(const Body& body, int e);

/// V mu (eps_p : eps_p + 2 eps_p : sum g_i alpha_i + sum g_i alpha_i : alpha_i) [J]: with it the energy of elastic
/// strain e = dev(eps) - eps_p is V mu ((1 - sum g_i) |e|^2 + sum g_i |e - alpha_i|^2).
double inelasticEnergy(const Body& body, int e);

/// Of all elements, times their volumes, as the kernels read them. Never allocates. Any number of threads gives the
/// same bits.
template <class Real>
void gatherInitialStress(const Body& body, const Threads* threads, StressBlock<Real>* out);

}  // namespace bullet_fem
