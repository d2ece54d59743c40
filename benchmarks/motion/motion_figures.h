// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "benchmarks/motion/motion_world.h"

namespace bullet_fem
{

/// Quantity that is measured against the step size.
enum class MotionCase
{
    tip,
    swing,
    drop,
    rebound,
    roll10,
    roll20
};

/// Result of one case, method and step size.
struct MotionFigures
{
    MotionCase m_case = MotionCase::tip;
    MotionMethod m_method = MotionMethod::euler;
    int m_rate = 60;            ///< steps per second
    double m_value = 0;         ///< in the unit of the case
    double m_reference = 0;     ///< value at the reference step size; NaN if there is none
    double m_milliseconds = 0;  ///< processor time per step, median [ms]
    double m_young = 0;         ///< modulus of the body, where it varies [Pa]
};

/// Name without blanks, for files and options.
const char* nameOf(MotionCase motionCase);

/// The case with that name. Throws std::invalid_argument.
MotionCase motionCase(const std::string& name);

/// Measures a case at all rates, by both methods and, for rolling cases, with Bullet's rigid sphere. Rates [1/s] are
/// multiples of 30. Reports progress on std::cerr.
std::vector<MotionFigures> measureMotion(MotionCase motionCase, const std::vector<int>& rates, int referenceRate,
                                         int ballCells);

/// Prints one table per case.
void printTable(std::ostream& out, const std::vector<MotionFigures>& rows);

/// The results as JSON, one object per row.
nlohmann::json toJson(const std::vector<MotionFigures>& rows);

}  // namespace bullet_fem
