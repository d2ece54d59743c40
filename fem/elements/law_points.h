// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/laws/law.h"

namespace bullet_fem
{

/// The values that the response of element e depends on. `history`: BodyState's history variables, or null if no law
/// has any.
LawPoint lawPointOf(const RestShape& shape, int e, const double* history);

}  // namespace bullet_fem
