// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <vector>

namespace bullet_fem
{

/// Removes items of `all`, in the given order, as long as `fails` stays true: delta debugging (Zeller and Hildebrandt,
/// Simplifying and Isolating Failure-Inducing Input, 2002), which halves the number of items to remove until it is one.
/// `fails(all)` must be true. At most `maxRuns` calls.
std::vector<int> minimise(std::vector<int> all, const std::function<bool(const std::vector<int>&)>& fails, int maxRuns);

}  // namespace bullet_fem
