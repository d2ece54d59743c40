// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/common/aligned_array.h"
#include "fem/factor/lane_vectors.h"
#include "fem/factor/rest_factor.h"
#include "fem/factor/rigid_lanes.h"

namespace bullet_fem
{

/// Columns of A0^-1 on the low-memory path, whose factor is not that of A0: kPanelLanes right-hand sides at a time by
/// conjugate gradients [Hestenes & Stiefel 1952] in single precision, with that factor as preconditioner. The rigid
/// motions that fixed nodes allow are known, and all vectors are free of them. A lane ends where its last
/// iteration changed the energy x . A0 x by less than tolerance^2 of what it is. The error of x in the energy norm, as
/// a share of x, both without rigid motions, is then less than the tolerance, or up to twice as much where convergence
/// is slow; and with it that of (A0^-1)_ij as a share of sqrt((A0^-1)_ii (A0^-1)_jj). A lane's bits do not depend on
/// the other lanes. Allocates when it is made, never else.
class LaneGradients
{
public:
    static constexpr int kMostIterations = 200;

    /// The model must outlive it, and its factor be of the low-memory path.
    explicit LaneGradients(const BodyModel& model);

    /// y <- A0^-1 y, in all lanes. `scratch` is that of PackedFactor::solveLanes(). Returns the iterations of the lane
    /// that took most.
    int solve(double tolerance, float* y, float* scratch);

private:
    const RestFactor& m_factor;
    RigidLanes m_rigid;
    AlignedFloats m_x, m_p, m_q;
};

}  // namespace bullet_fem
