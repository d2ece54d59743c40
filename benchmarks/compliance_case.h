// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/timed_work.h"

namespace bullet_fem
{

/// What contact asks of one body's factor.
struct ComplianceFigures
{
    int m_tets = 0, m_nodes = 0;
    int m_touched = 0;  ///< nodes
    Timing m_fresh;     ///< columns of nodes that were never touched before, and all blocks between them
    Timing m_known;     ///< the same for nodes touched in the step before
};

/// Times the compliance of 64 neighbouring surface nodes on a block of 9,360 tets: their columns of A0^-1, and the 64 x
/// 64 blocks between them turned by two rotations each. `seconds` each.
ComplianceFigures measureCompliance(double seconds);

}  // namespace bullet_fem
