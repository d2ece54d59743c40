// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_fem/fem/body_model.h"
#include "fem/aligned_floats.h"

namespace bullet_fem
{

/// The 3x3 blocks of A0^-1 between surface nodes of one model [1/kg]. They are constants; a node's column is solved
/// when it is first asked for and kept while there is room. Bodies of the same model may share a cache on one thread.
/// request() allocates only when it is given more nodes than ever before.
class ComplianceCache
{
public:
    explicit ComplianceCache(std::shared_ptr<const BodyModel> model);

    const BodyModel& model() const { return *m_model; }

    /// Makes the columns of these surface nodes available until the next request. Repeated nodes are allowed.
    void request(const std::vector<int>& nodes);

    /// (A0^-1)_ij between surface nodes i and j; the column of j must have been requested. Zero if either was fixed
    /// when the factor was built; the inverse diagonal where that node is free now is the caller's business.
    Mat3 block(int i, int j) const;

private:
    void markNode(int node);
    int claimSlot();
    void solveColumns(const int* nodes, int count);
    void copyColumn(int node, int firstLane, float* column) const;

    std::shared_ptr<const BodyModel> m_model;
    std::vector<int> m_surfaceIndex;  // per node: its place among the surface nodes, or -1
    std::vector<int> m_slotOfNode;    // per node, or -1
    std::vector<int> m_nodeOfSlot;
    std::vector<unsigned long> m_lastUse;  // per slot: number of the request that last named it
    std::vector<std::vector<float>> m_columns;
    std::vector<int> m_supernodeOfPosition;  // by the factor's order of nodes
    std::vector<int> m_surfaceSupernodes;    // those with surface nodes and what is above them
    std::vector<int> m_newNodes, m_reach;
    std::vector<unsigned char> m_marked;   // per supernode
    AlignedFloats m_rightSide, m_scratch;  // kPanelLanes interleaved
    unsigned long m_requestCount = 0;
};

}  // namespace bullet_fem
