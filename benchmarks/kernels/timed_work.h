// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace bullet_fem
{

/// A piece of work to be timed again and again.
struct TimedWork
{
    std::string m_name;
    std::function<void()> m_run;
    std::function<void()> m_prepare;  ///< what every repetition needs before it and is not timed; may be empty
};

/// What came out of it.
struct Timing
{
    double m_best = 0;    ///< shortest repetition [s]: other programs only ever add
    double m_median = 0;  ///< [s]
    int m_count = 0;      ///< repetitions
};

/// Times all of `work` in turns, five rounds of at least `seconds` / 5 and one repetition each, so that a disturbance
/// of the machine meets all alike. One result for each, in its order.
std::vector<Timing> timeInTurns(const std::vector<TimedWork>& work, double seconds);

/// The median of how many times as long as `other` a piece of work takes, when they alternate, one repetition each, for
/// `seconds`: neither finds in the caches what it has just left there itself.
double medianRatio(const TimedWork& work, const TimedWork& other, double seconds);

}  // namespace bullet_fem
