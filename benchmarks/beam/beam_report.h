// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

#include "benchmarks/beam/beam_case.h"

namespace bullet_fem
{

/// Results of one run: one row of the table.
struct BeamFigures
{
    int m_tets = 0;
    int m_nodes = 0;
    double m_mass = 0;          ///< of the free nodes [kg]
    double m_youngModulus = 0;  ///< E [Pa]
    std::string m_method;
    double m_tolerance = 0;              ///< [-]; 0 if the method has none
    double m_medianMilliseconds = 0;     ///< per step [ms]
    double m_cpuMilliseconds = 0;        ///< median processor time per step [ms]
    double m_worstMilliseconds = 0;      ///< per step [ms]
    double m_setupSeconds = 0;           ///< [s]
    double m_heapMegabytes = 0;          ///< heap in use after the last step [MB, 1e6 B]; 0 if unknown
    double m_factorMegabytes = 0;        ///< of the packed factor [MB]; 0 without a factor
    bool m_sameModel = true;             ///< false: residual, tip error and m_counts are not comparable
    double m_meanIterations = 0;         ///< per step [-]
    double m_worstResidual = 0;          ///< largest |b - A dv| / |b| of all steps [-]
    double m_worstTipError = 0;          ///< largest tipError of all steps [-]
    bool m_counts = false;               ///< residual and tip error within their bounds
    double m_timesFasterThanBullet = 0;  ///< Bullet's median time over that of this row [-]; 0 if Bullet was not run
    double m_cpuTimesFaster = 0;         ///< ratio of the median processor times [-]
    std::vector<double> m_tipHeights;    ///< at listedSteps(steps) [m]
};

/// Steps whose tip heights are listed: 1, 11, 21, 31, 41, 51 and 60, up to `steps`.
std::vector<int> listedSteps(int steps);

/// |a - b| / max(|b|, 1 cm) [-]: at most 0.1 % means within max(0.1 %, 1e-5 m) of b.
double tipError(double a, double b);

/// Summarises `run`. Tip errors are relative to `exact`, the scheme's own solution at 1e-8. The ratios to Bullet stay
/// 0.
BeamFigures summarise(const BeamCase& beam, const BeamRun& run, const BeamRun& exact);

/// Verified tip heights [m] at listedSteps(60) for 1,536 and 12,288 tets, E = 1e6 and 1e7 Pa, without the tension term;
/// empty for other cases.
std::vector<double> verifiedTipHeights(int tets, double youngModulus);

/// Prints two tables: times with their errors, then tip heights (with verified heights if `withVerified`).
void printTable(std::ostream& out, const std::vector<BeamFigures>& rows, int steps, bool withVerified);

/// The results as JSON, one object per row.
nlohmann::json toJson(const std::vector<BeamFigures>& rows, int steps);

}  // namespace bullet_fem
