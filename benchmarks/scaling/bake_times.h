// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

#include "benchmarks/beam/beam_case.h"

namespace bullet_fem
{

/// Time saved by a baked body. Times are medians of consecutive runs, so that the file is in the system's cache.
struct BakeTimes
{
    int m_tets = 0;
    double m_fileMegabytes = 0;  ///< [1e6 B]
    double m_setupSeconds = 0;   ///< from positions and elements to a factored model [s]
    double m_writeSeconds = 0;   ///< to write such a model [s]
    double m_mappedSeconds = 0;  ///< to load the model from the file with BakedLoading::mapped [s]
    double m_copiedSeconds = 0;  ///< to load the model from the file with BakedLoading::copied [s]
    bool m_sameMotion = false;   ///< ten steps of both models are bitwise equal
};

/// Bakes the beam to a file in the system's temporary folder and removes it. Throws std::runtime_error if the file
/// cannot be written.
BakeTimes measureBake(const BeamCase& beam);

void printTable(std::ostream& out, const std::vector<BakeTimes>& rows);
nlohmann::json toJson(const std::vector<BakeTimes>& rows);

}  // namespace bullet_fem
