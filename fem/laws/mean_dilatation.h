// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/laws/law.h"

namespace bullet_fem
{

/// Volume change of an element that patches average [-]: tr(e) of a linear law, J - 1 of a law of the volume ratio.
double volumeChange(const Law& law, const Mat3& e);

/// Makes `point` that of an element in a patch whose mean of volumeChange() is `mean`: the patch's share of lambda goes
/// to m_pressure. A linear law shares its bulk modulus, a law of the volume ratio lambda, and others nothing.
void shareWithPatch(const Law& law, double mean, LawPoint& point);

/// Energy per volume of the share of lambda [Pa], for a point before shareWithPatch().
double sharedEnergy(const Law& law, double mean, const LawPoint& point);

}  // namespace bullet_fem
