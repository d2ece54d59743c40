// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

#include "benchmarks/factor/factor_rows.h"
#include "benchmarks/kernels/compliance_case.h"
#include "benchmarks/kernels/kernel_figures.h"

namespace bullet_fem
{

/// All results of the kernel benchmark.
struct KernelReport
{
    double m_peakGigaflops = 0;  ///< of one thread, single precision, measured [GFLOP/s]
    std::vector<KernelRun> m_runs;
    ComplianceFigures m_compliance;
    std::vector<ComplianceFigures> m_touch;  ///< on both paths for other blocks, if requested
    std::vector<FactorRow> m_factors;        ///< compared with other libraries, if requested
    std::vector<FirstStepRow> m_firstSteps;  ///< of the bodies in m_factors
    std::vector<FillRow> m_fill;             ///< of the thirty meshes, if requested
};

/// Prints tables: kernels, triangular solves compared with reads, compliance; factors and fill if requested.
void printTables(std::ostream& out, const KernelReport& report);

/// The results as JSON.
nlohmann::json toJson(const KernelReport& report);

}  // namespace bullet_fem
