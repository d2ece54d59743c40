// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <vector>

namespace bullet_fem
{

/// Leaves out of `all` what is not needed for `fails` to stay true, in the order given: delta debugging (Zeller and
/// Hildebrandt, Simplifying and Isolating Failure-Inducing Input, 2002), which halves what it tries to leave out until
/// that is one item. `fails(all)` must be true. At most `maxRuns` calls.
std::vector<int> minimise(std::vector<int> all, const std::function<bool(const std::vector<int>&)>& fails, int maxRuns);

}  // namespace bullet_fem
