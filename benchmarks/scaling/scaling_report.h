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
    BeamFigures m_beam;    ///< times and true residuals of the steps
    SetupStages m_stages;  ///< set-up of the factor
};

/// y = c n^p, a least-squares fit of the logarithms.
struct PowerLaw
{
    double m_exponent = 0;  ///< p [-]
    int m_points = 0;       ///< number of fitted sizes; fewer than 2 give no exponent
};

/// Growth of the table's columns with the number of elements n, from 1,536 elements on; fixed costs dominate below.
struct ScalingExponents
{
    PowerLaw m_order, m_numeric, m_setup, m_factorMegabytes, m_step;
};

ScalingExponents fitExponents(const std::vector<ScalingFigures>& rows);

/// Prints the table and the exponents below it.
void printTable(std::ostream& out, const std::vector<ScalingFigures>& rows);

/// The results as JSON.
nlohmann::json toJson(const std::vector<ScalingFigures>& rows);

}  // namespace bullet_fem
