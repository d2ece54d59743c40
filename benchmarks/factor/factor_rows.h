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

/// Cost of one library's factor of one matrix on one thread.
struct FactorRow
{
    std::string m_case, m_method;
    int m_tets = 0;
    std::string m_ordering;       ///< library that found the order: AMD, METIS or Eigen; empty if not known
    double m_orderSeconds = 0;    ///< order and symbolic factorization [s], median; 0 for an order of another row
    double m_numericSeconds = 0;  ///< numeric factorization, in BulletFEM including packing [s], median
    double m_solveSeconds = 0;    ///< one right-hand side [s], median
    double m_sixteenSeconds = 0;  ///< sixteen right-hand sides together [s], median
    double m_fill = 0;            ///< entries of L over those of the matrix's lower half [-]
    double m_megabytes = 0;       ///< of the factor, 1e6 bytes
    double m_error = 0;           ///< |b - A x| / |b| of a solve [-]
};

/// Factors by BulletFEM, by CHOLMOD (supernodal and simplicial; supernodal in BulletFEM's order), and by Eigen's
/// SimplicialLLT, as far as this build has them; measured in turns for `seconds` each.
std::vector<FactorRow> measureFactors(const FactorCase& factorCase, double seconds);

/// Time from positions and elements to the end of a body's first step [s], median of `repetitions`.
struct FirstStepRow
{
    std::string m_case;
    int m_tets = 0;
    double m_mesh = 0, m_model = 0, m_step = 0;  ///< checking the mesh and rest shape; factor; body and first step
};

FirstStepRow measureFirstStep(const FactorCase& factorCase, int repetitions);

/// Fill of several orders of one matrix, before supernodes are merged: entries of L over those of its lower half [-]; 0
/// if a build lacks an order.
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

/// Names and versions of the other libraries.
std::string factorLibraries();

}  // namespace bullet_fem
