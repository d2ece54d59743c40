// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/kernels/timed_work.h"

#include <algorithm>

#include "benchmarks/figures.h"

namespace bullet_fem
{
namespace
{

constexpr int kRounds = 5;
constexpr std::size_t kMaxSamples = 1000000;  // per work, over all turns

/// Time of one repetition [s].
double timeOf(const TimedWork& work)
{
    if (work.m_prepare) work.m_prepare();
    const Stopwatch watch;
    work.m_run();
    return watch.seconds();
}

/// Appends the times of repetitions [s].
void repeat(const TimedWork& work, double seconds, std::vector<double>& samples)
{
    const Stopwatch whole;
    do samples.push_back(timeOf(work));
    while (whole.seconds() < seconds && samples.size() < kMaxSamples);
}

}  // namespace

std::vector<Timing> timeInTurns(const std::vector<TimedWork>& work, double seconds)
{
    std::vector<std::vector<double>> samples(work.size());
    for (int round = 0; round < kRounds; ++round)
        for (std::size_t k = 0; k < work.size(); ++k) repeat(work[k], seconds / kRounds, samples[k]);
    std::vector<Timing> timings;
    for (const std::vector<double>& times : samples)
        timings.push_back(
            {*std::min_element(times.begin(), times.end()), median(times), static_cast<int>(times.size())});
    return timings;
}

double medianRatio(const TimedWork& work, const TimedWork& other, double seconds)
{
    std::vector<double> ratios;
    const Stopwatch whole;
    do
    {
        const double time = timeOf(work);
        ratios.push_back(time / timeOf(other));
    } while (whole.seconds() < seconds && ratios.size() < kMaxSamples);
    return median(ratios);
}

}  // namespace bullet_fem
