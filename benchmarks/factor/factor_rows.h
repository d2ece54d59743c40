// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "benchmarks/factor/factor_cases.h"
#include "benchmarks/kernels/timed_work.h"

namespace bullet_fem
{

/// What one library's factor of one matrix costs, on one thread.
struct FactorRow
{
    std::string m_case, m_method;
    int m_tets = 0;
    std::string m_ordering;       ///< what found the order: AMD, METIS or Eigen; empty where the library does not tell
    double m_orderSeconds = 0;    ///< order and symbolic factorization [s], median; 0 where the order is another row's
    double m_numericSeconds = 0;  ///< numeric factorization, ours with its packing [s], median
    double m_solveSeconds = 0;    ///< one right-hand side [s], median
    double m_sixteenSeconds = 0;  ///< sixteen right-hand sides together [s], median
    double m_fill = 0;            ///< entries of L over those of the matrix's lower half [-]
    double m_megabytes = 0;       ///< of the factor, 1e6 bytes
    double m_error = 0;           ///< |b - A x| / |b| of a solve [-]
};

/// Our factor, CHOLMOD's supernodal and simplicial, CHOLMOD's supernodal in our order, and Eigen's SimplicialLLT, in
/// turns for `seconds` each; those that this build has.
std::vector<FactorRow> measureFactors(const FactorCase& factorCase, double seconds);

/// What a body costs from positions and elements to the end of its first step [s], median of `repetitions`.
struct FirstStepRow
{
    std::string m_case;
    int m_tets = 0;
    double m_mesh = 0, m_model = 0, m_step = 0;  ///< checked mesh and rest shape; factor; body and first step
};

FirstStepRow measureFirstStep(const FactorCase& factorCase, int repetitions);

/// Fill of the orders of one matrix, entries of L over those of its lower half [-], before supernodes are merged; 0
/// where a build has no such order.
struct FillRow
{
    std::string m_case, m_chosen;
    int m_tets = 0, m_freeNodes = 0;
    double m_amd = 0, m_metis = 0, m_eigen = 0;
};

FillRow measureFill(const FactorCase& factorCase);

void printTable(std::ostream& out, const std::vector<FactorRow>& rows);
void printTable(std::ostream& out, const std::vector<FirstStepRow>& rows);
void printTable(std::ostream& out, const std::vector<FillRow>& rows);
nlohmann::json toJson(const std::vector<FactorRow>& rows);
nlohmann::json toJson(const std::vector<FirstStepRow>& rows);
nlohmann::json toJson(const std::vector<FillRow>& rows);

/// The libraries beside ours, with their versions.
std::string factorLibraries();

}  // namespace bullet_fem
