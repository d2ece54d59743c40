// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/kernels/timed_work.h"
#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// Cost of compliance columns for contact, for one body's factor.
struct ComplianceFigures
{
    int m_tets = 0, m_nodes = 0;
    int m_touched = 0;  ///< nodes in contact
    FactorPath m_path = FactorPath::full;
    double m_factorMegabytes = 0;
    double m_matrixMegabytes = 0;  ///< of A0 itself, which the low-memory path stores beside its factor
    Timing m_fresh;                ///< columns of nodes requested for the first time, and all blocks between them
    Timing m_known;                ///< columns of nodes requested in the previous step, and all blocks between them
};

constexpr int kComplianceTets = 9360;  ///< of the default block

/// Times the compliance of 64 neighbouring surface nodes on a block of 1.3 x 1.2 x 1.2 m with about `tets` elements:
/// their columns of A0^-1, and the 64 x 64 blocks between them, each multiplied by two rotations. `seconds` for each
/// time.
ComplianceFigures measureCompliance(int tets, FactorChoice choice, double seconds);

}  // namespace bullet_fem
