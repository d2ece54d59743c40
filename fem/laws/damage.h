// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/laws/law.h"

namespace bullet_fem
{

/// Isotropic damage with softening, of brittle solids at small strain [Lemaitre & Chaboche 1990, ch. 7]:
///
///     stress = (1 - d) (2 mu e + lambda tr(e) I),   d = 1 - kappa_0 / kappa exp(-(kappa - kappa_0) / kappa_s)
///
/// kappa, the history variable, is the largest equivalent strain sqrt(sum of max(0, e_i)^2) so far [Mazars 1986], e_i
/// the principal strains, and kappa_0 = strength / E. The softening strain kappa_s = G / (strength size) - kappa_0 / 2
/// makes a crack of one element dissipate the fracture energy G per area at any size [Bazant & Oh 1983]. Stiffness is
/// lost in compression, too.
Law damageLaw();

}  // namespace bullet_fem
