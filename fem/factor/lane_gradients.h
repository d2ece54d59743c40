// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/common/aligned_array.h"
#include "fem/factor/rest_factor.h"
#include "fem/factor/rigid_lanes.h"

namespace bullet_fem
{

/// One number per right-hand side.
struct LaneNumbers
{
    double m[kPanelLanes] = {};
};

/// The vectors of kPanelLanes conjugate gradient solves over the nodes of a factor, interleaved as in
/// PackedFactor::solveLanes(), each an array of 3 x kPanelLanes floats a node, aligned to 64 bytes. Lanes are
/// independent of each other. All functions use the widest vectors that the processor has.
struct LaneVectors
{
    int m_nodes;
    float* m_x;  ///< solution
    float* m_r;  ///< residual
    float* m_p;  ///< direction
    float* m_q;  ///< A p, or the preconditioned residual
};

/// p = q + beta p, then q = 0.
void turnLanes(const LaneVectors& v, const LaneNumbers& beta);

/// q += A p; returns p . q.
LaneNumbers multiplyLanes(const RestMatrix& A, const LaneVectors& v);

/// x += step p, r -= step q, then q = r.
void advanceLanes(const LaneVectors& v, const LaneNumbers& step);

/// Returns r . q.
LaneNumbers dotLanes(const LaneVectors& v);

/// Columns of A0^-1 on the low-memory path, whose factor is not that of A0: solves kPanelLanes right-hand sides at a
/// time by conjugate gradients [Hestenes & Stiefel 1952] in single precision, preconditioned by that factor. All
/// vectors are free of the rest modes. A lane ends when an iteration changes the energy x . A0 x by less than
/// tolerance^2 of it. The relative error of x in the energy norm, without rigid motions, is then less than the
/// tolerance, or up to twice that if convergence is slow; it also bounds the error of (A0^-1)_ij relative to
/// sqrt((A0^-1)_ii (A0^-1)_jj). A lane's bits do not depend on the other lanes. Allocates in the constructor only.
class LaneGradients
{
public:
    static constexpr int kMaxIterations = 200;

    /// The model must outlive this object, and its factor must be that of the low-memory path. Allocates.
    explicit LaneGradients(const BodyModel& model);

    /// y <- A0^-1 y without rest modes in all lanes. `scratch` is that of PackedFactor::solveLanes(). Returns the
    /// maximum number of iterations of a lane.
    int solve(double tolerance, float* y, float* scratch);

private:
    const RestFactor& m_factor;
    RigidLanes m_rigid;
    AlignedFloats m_x, m_p, m_q;
};

}  // namespace bullet_fem
