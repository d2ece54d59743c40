// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

#include "benchmarks/beam/beam_report.h"
#include "benchmarks/beam/setup_stages.h"

namespace bullet_fem
{

/// One size: one row of the table.
struct ScalingFigures
{
    BeamFigures m_beam;    ///< the steps with their true residual
    SetupStages m_stages;  ///< of the factor
};

/// y = c n^p, fitted through the logarithms by least squares.
struct PowerLaw
{
    double m_exponent = 0;  ///< p [-]
    int m_points = 0;       ///< sizes that it was fitted to; fewer than 2 give no exponent
};

/// How the columns of the table grow with the number of elements n, from 1,536 elements on: below, fixed costs rule.
struct ScalingExponents
{
    PowerLaw m_order, m_numeric, m_setup, m_factorMegabytes, m_step;
};

ScalingExponents fitExponents(const std::vector<ScalingFigures>& rows);

/// The table, and the exponents below it.
void printTable(std::ostream& out, const std::vector<ScalingFigures>& rows);

/// The same figures.
nlohmann::json toJson(const std::vector<ScalingFigures>& rows);

}  // namespace bullet_fem
