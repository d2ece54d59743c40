// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/laws/law.h"

namespace bullet_fem
{

/// Hooke's law, stress = 2 mu e + lambda tr(e) I, W = mu e : e + lambda tr(e)^2 / 2.
Law hookeLaw();

/// Lame's constants of E [Pa] and nu [-].
LameModuli lameModuli(double youngModulus, double poissonRatio);

/// The response for a symmetric e.
LawResponse hookeResponse(const Mat3& e, const LawPoint& point);

}  // namespace bullet_fem
