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

/// What is measured against the step.
enum class MotionCase
{
    tip,
    swing,
    drop,
    roll10,
    roll20
};

/// A measure in steps of one size.
struct MotionFigures
{
    MotionCase m_case = MotionCase::tip;
    MotionMethod m_method = MotionMethod::euler;
    int m_rate = 60;            ///< steps a second
    double m_value = 0;         ///< of the case, in its unit
    double m_reference = 0;     ///< the same in steps of the reference's size; NaN where there is none
    double m_milliseconds = 0;  ///< processor time of a step, median [ms]
};

/// A name without blanks, for files and options.
const char* nameOf(MotionCase motionCase);

/// The case of that name. Throws std::invalid_argument.
MotionCase motionCase(const std::string& name);

/// A case in all steps, by both methods and, for those that roll, Bullet's rigid sphere. Rates [1/s] are multiples of
/// 30. Tells on std::cerr where it is.
std::vector<MotionFigures> measureMotion(MotionCase motionCase, const std::vector<int>& rates, int referenceRate,
                                         int ballCells);

/// A table a case.
void printTable(std::ostream& out, const std::vector<MotionFigures>& rows);

/// The same figures, one object a row.
nlohmann::json toJson(const std::vector<MotionFigures>& rows);

}  // namespace bullet_fem
