// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "fem/factor/fill_order.h"

namespace bullet_fem
{

// Fill-reducing orders of libraries: permutations whose entry k is the row eliminated k-th, independent of the number
// of calling threads. Both throw std::bad_alloc, or std::runtime_error if the library fails.

/// "AMD x.y.z"; empty without SuiteSparse.
std::string amdVersion();

/// Approximate minimum degree order [Amestoy et al. 1996] by SuiteSparse. Empty without SuiteSparse.
std::vector<int> amdOrder(const SparsePattern& pattern);

/// "METIS x.y.z"; empty without METIS.
std::string metisVersion();

/// Nested dissection order [Karypis & Kumar 1998] by METIS. Empty without METIS, or for a graph without edges.
std::vector<int> metisOrder(const SparsePattern& pattern);

}  // namespace bullet_fem
