// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <ostream>
#include <vector>

namespace bullet_fem
{

// Functions shared by the reports of the benchmarks.

/// The median; of two middle values, the upper one. `values` must not be empty.
inline double median(std::vector<double> values)
{
    const auto middle = values.begin() + values.size() / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Largest of values >= 0; NaN if any value is NaN.
inline double largest(const std::vector<double>& values)
{
    double result = 0;
    for (double value : values)
        if (!(value <= result) && !std::isnan(result)) result = value;
    return result;
}

/// printf to a stream; at most 255 characters.
template <class... Values>
void print(std::ostream& out, const char* format, Values... values)
{
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    out << line;
}

/// Time since construction.
class Stopwatch
{
public:
    /// Wall time [s].
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count(); }

    /// Processor time of the calling thread [s], which is nearly independent of other programs. Call it from the thread
    /// that made this object; 0 if the system does not count it.
    double cpuSeconds() const { return cpuNow() - m_cpuStart; }

private:
    static double cpuNow()
    {
#ifdef CLOCK_THREAD_CPUTIME_ID
        timespec now{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
#else
        return 0;
#endif
    }

    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
    double m_cpuStart = cpuNow();
};

}  // namespace bullet_fem
