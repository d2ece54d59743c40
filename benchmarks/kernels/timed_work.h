// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace bullet_fem
{

/// Work that is timed repeatedly.
struct TimedWork
{
    std::string m_name;
    std::function<void()> m_run;
    std::function<void()> m_prepare;  ///< preparation before each repetition, not timed; may be empty
};

/// Result of the repetitions.
struct Timing
{
    double m_best = 0;    ///< shortest repetition [s], which other programs disturb least
    double m_median = 0;  ///< [s]
    int m_count = 0;      ///< repetitions
};

/// Times all of `work` in turns, five turns of at least `seconds` / 5 and one repetition each, so that external load
/// affects all alike. Returns one result for each, in order.
std::vector<Timing> timeInTurns(const std::vector<TimedWork>& work, double seconds);

/// Median ratio of the time of `work` to that of `other`, run alternately one repetition each for `seconds`. Neither
/// then finds its own data in the caches.
double medianRatio(const TimedWork& work, const TimedWork& other, double seconds);

}  // namespace bullet_fem
