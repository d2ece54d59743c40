// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/factor/fill_order.h"

namespace bullet_fem
{

/// "METIS x.y.z", or a null pointer in builds and programs without METIS.
const char* nestedDissectionLibrary();

/// A permutation by nested dissection [Karypis and Kumar 1998]: entry k is the row that comes k-th. Empty where there
/// is no METIS, or nothing to dissect. The same for callers on any number of threads. Throws std::bad_alloc, or
/// std::runtime_error if METIS fails.
std::vector<int> nestedDissectionOrder(const SparsePattern& pattern);

}  // namespace bullet_fem
