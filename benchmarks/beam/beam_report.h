// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

#include "benchmarks/beam/beam_case.h"

namespace bullet_fem
{

/// The figures of one run: one row of the table.
struct BeamFigures
{
    int m_tets = 0;
    int m_nodes = 0;
    double m_mass = 0;          ///< of the free nodes [kg]
    double m_youngModulus = 0;  ///< E [Pa]
    std::string m_method;
    double m_tolerance = 0;              ///< [-]; 0 where there is none to set
    double m_medianMilliseconds = 0;     ///< a step [ms]
    double m_cpuMilliseconds = 0;        ///< median of a step's processor time [ms]
    double m_worstMilliseconds = 0;      ///< a step [ms]
    double m_setupSeconds = 0;           ///< [s]
    double m_heapMegabytes = 0;          ///< held after the last step [MB, 1e6 B]; 0 if unknown
    double m_factorMegabytes = 0;        ///< of the packed factor [MB]; 0 where there is none
    bool m_sameModel = true;             ///< false: residual, tip error and m_counts mean nothing
    double m_meanIterations = 0;         ///< a step [-]
    double m_worstResidual = 0;          ///< largest |b - A dv| / |b| of all steps [-]
    double m_worstTipError = 0;          ///< largest tipError of all steps [-]
    bool m_counts = false;               ///< residual and tip error within their bounds
    double m_timesFasterThanBullet = 0;  ///< Bullet's median over this one's [-]; 0 if Bullet was not run
    double m_cpuTimesFaster = 0;         ///< the same of processor times [-]
    std::vector<double> m_tipHeights;    ///< at listedSteps(steps) [m]
};

/// The steps whose tip heights are listed, 1, 11, 21, 31, 41, 51, 60: those of them within `steps`.
std::vector<int> listedSteps(int steps);

/// |a - b| / max(|b|, 1 cm) [-]: at most 0.1 % means within max(0.1 %, 1e-5 m) of b.
double tipError(double a, double b);

/// Sums up `run`; tips are measured against `exact`, the scheme's own solution at 1e-8. Leaves the
/// ratio to Bullet at 0.
BeamFigures summarise(const BeamCase& beam, const BeamRun& run, const BeamRun& exact);

/// The digits at listedSteps(60) that the project verifies itself with, for 1,536 and 12,288 tets, E = 1e6 and 1e7, no
/// tension term [m]; empty for other cases.
std::vector<double> verifiedTipHeights(int tets, double youngModulus);

/// Two tables: times with their errors, then tip heights (with the verified digits, if `withVerified`).
void printTable(std::ostream& out, const std::vector<BeamFigures>& rows, int steps, bool withVerified);

/// The same figures, one object a row.
nlohmann::json toJson(const std::vector<BeamFigures>& rows, int steps);

}  // namespace bullet_fem
