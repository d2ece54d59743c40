// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "fem/factor/fill_order.h"

namespace bullet_fem
{

// Fill-reducing orders of libraries: permutations whose entry k is the row that comes k-th. They are the same for
// callers on any number of threads. Both throw std::bad_alloc, or std::runtime_error if the library fails.

/// "AMD x.y.z"; empty in builds and programs without SuiteSparse.
std::string amdVersion();

/// Approximate minimum degree [Amestoy, Davis and Duff 1996] by SuiteSparse. Empty where there is no SuiteSparse.
std::vector<int> amdOrder(const SparsePattern& pattern);

/// "METIS x.y.z"; empty in builds and programs without METIS.
std::string metisVersion();

/// Nested dissection [Karypis and Kumar 1998] by METIS. Empty where there is no METIS, or nothing to dissect.
std::vector<int> metisOrder(const SparsePattern& pattern);

}  // namespace bullet_fem
