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

/// All that the kernels' benchmark measures.
struct KernelReport
{
    double m_peakGigaflops = 0;  ///< of one thread, single precision, measured [GFLOP/s]
    std::vector<KernelRun> m_runs;
    ComplianceFigures m_compliance;
    std::vector<ComplianceFigures> m_touch;  ///< on both paths of other blocks, where asked for
    std::vector<FactorRow> m_factors;        ///< beside other libraries, where asked for
    std::vector<FirstStepRow> m_firstSteps;  ///< of the same bodies
    std::vector<FillRow> m_fill;             ///< of the thirty meshes, where asked for
};

/// Tables: kernels, triangular solves beside reads, compliance; factors and fill where asked for.
void printTables(std::ostream& out, const KernelReport& report);

/// The same figures.
nlohmann::json toJson(const KernelReport& report);

}  // namespace bullet_fem
