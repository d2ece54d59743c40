// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/common/aligned_array.h"
#include "fem/factor/lane_gradients.h"
#include "fem/factor/rigid_lanes.h"

namespace bullet_fem
{

/// Solves columns of A0^-1 without rest modes of a model, kPanelLanes at a time, for their rows at some nodes. A
/// column's bits do not depend on which others are solved with it. On the low-memory path the first solve allocates.
class ColumnSolver
{
public:
    struct Column
    {
        int m_node, m_axis;
        float* m_out;  ///< output: column m_axis of the blocks of the nodes i, nine values each, row by row
    };

    /// Model and nodes must outlive it. The nodes of columns are among these.
    ColumnSolver(const BodyModel& model, const std::vector<int>& nodes);

    /// Solves at most kPanelLanes columns; most efficient for neighbours in the factor, which share most of their path
    /// to its root.
    void solve(const Column* columns, int count);

private:
    void markNode(int node);
    void writeColumns(const Column* columns, int count);

    const BodyModel& m_model;
    const std::vector<int>& m_nodes;
    std::vector<int> m_supernodeOfPosition;  // indexed by the factor's order of nodes
    std::vector<int> m_nodeSupernodes;       // supernodes of these nodes and their ancestors
    std::vector<int> m_reach;
    std::vector<unsigned char> m_marked;         // per supernode
    AlignedFloats m_rightSide, m_scratch;        // kPanelLanes interleaved
    std::unique_ptr<LaneGradients> m_gradients;  // on the low-memory path, from the first solve on
    std::unique_ptr<RigidLanes> m_rigid;         // for models with rest modes
    double m_rigidShare = 0;                     // 1 / s of massScale() [-]
};

}  // namespace bullet_fem
