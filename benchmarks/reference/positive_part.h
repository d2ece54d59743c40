// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Positive part of a symmetric matrix: its negative eigenvalues set to zero.
Mat3 positivePart(const Mat3& symmetric);

}  // namespace bullet_fem
