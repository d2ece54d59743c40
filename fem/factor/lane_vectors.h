// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/factor/panel_kernels.h"
#include "fem/factor/rest_matrix.h"

namespace bullet_fem
{

/// One number for each of kPanelLanes right-hand sides.
struct LaneNumbers
{
    double m[kPanelLanes] = {};
};

/// kPanelLanes vectors over the nodes of a factor, interleaved as PackedFactor::solveLanes() has them, each an array of
/// 3 x kPanelLanes floats a node that is aligned to 64 bytes: what conjugate gradients work with. What happens in one
/// lane never depends on the others. All run on the widest vectors that the processor has.
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

/// r . q.
LaneNumbers dotLanes(const LaneVectors& v);

}  // namespace bullet_fem
