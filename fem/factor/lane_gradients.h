// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/aligned_floats.h"
#include "fem/factor/lane_vectors.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{

/// Columns of A0^-1 on the low-memory path, whose factor is not that of A0: kPanelLanes right-hand sides at a time by
/// conjugate gradients [Hestenes & Stiefel 1952] in single precision, with that factor as preconditioner. A lane ends
/// where its last iteration changed the energy x . A0 x by less than tolerance^2 of what it is. The error of x in the
/// energy norm, as a share of x, is then less than the tolerance, or up to twice as much where convergence is slow; and
/// with it that of (A0^-1)_ij as a share of sqrt((A0^-1)_ii (A0^-1)_jj). A lane's bits do not depend on the other
/// lanes. Allocates when it is made, never else.
class LaneGradients
{
public:
    static constexpr int kMostIterations = 200;

    /// The factor must outlive it, and be of the low-memory path.
    explicit LaneGradients(const RestFactor& factor);

    /// y <- A0^-1 y, in all lanes; `reach` has the supernodes that the entries of y reach, ascending. `scratch` is
    /// that of PackedFactor::solveLanes(). Returns the iterations of the lane that took most.
    int solve(const std::vector<int>& reach, double tolerance, float* y, float* scratch);

private:
    const RestFactor& m_factor;
    AlignedFloats m_x, m_p, m_q;
};

}  // namespace bullet_fem
