// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"

namespace bullet_fem
{

/// Updates relaxation and plastic strain at the end of a step of h, at its end positions. With the elastic strain e =
/// dev(eps) - eps_p:
///
/// Relaxation [Simo & Hughes 1998, 10.2], exact for constant e:
///     alpha_i -> exp(-h / tau_i) alpha_i + (1 - exp(-h / tau_i)) e
///
/// Plastic flow by radial return of the stress to von Mises' cylinder [Simo & Hughes 1998, box 3.2]:
///     s = 2 mu (e - sum g_i alpha_i) + dev(sigma_0),   f = |s| - sqrt(2/3) (sigma_y + H alpha),   n = s / |s|,
///     gamma = c f / (2 mu + 2/3 H),   eps_p += gamma n,   alpha += sqrt(2/3) gamma
/// if f > 0. c = 1 - exp(-h creep) is the share of f that flows in a step; 1 for infinite creep. eps_p is scaled back
/// to sqrt(2/3) |eps_p| <= the maximum plastic strain.
///
/// No effect on bodies of other materials. Never allocates. Bitwise independent of the number of threads.
void advanceInelasticStrain(Body& body, const StepSettings& settings);

}  // namespace bullet_fem
