// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/kernels/timed_work.h"
#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// What contact asks of one body's factor.
struct ComplianceFigures
{
    int m_tets = 0, m_nodes = 0;
    int m_touched = 0;  ///< nodes
    FactorPath m_path = FactorPath::full;
    double m_factorMegabytes = 0;
    double m_matrixMegabytes = 0;  ///< of A0 itself, which the low-memory path keeps beside its factor
    Timing m_fresh;                ///< columns of nodes that were never touched before, and all blocks between them
    Timing m_known;                ///< the same for nodes touched in the step before
};

constexpr int kComplianceTets = 9360;  ///< of the usual block

/// Times the compliance of 64 neighbouring surface nodes on a block of 1.3 x 1.2 x 1.2 m and about so many tets: their
/// columns of A0^-1, and the 64 x 64 blocks between them turned by two rotations each. `seconds` each.
ComplianceFigures measureCompliance(int tets, FactorChoice choice, double seconds);

}  // namespace bullet_fem
