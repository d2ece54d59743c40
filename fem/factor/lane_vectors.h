// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/factor/panel_kernels.h"
#include "fem/factor/rest_matrix.h"

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

}  // namespace bullet_fem
