// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/record/btFemFactorAccount.h"

#include <algorithm>
#include <cmath>

using namespace bullet_fem;

namespace
{

// Cost model: nanoseconds on one core of an AMD EPYC with AVX-512, within 50 % of measurements by
// bulletfem_bench_kernels and bulletfem_bench_scaling from 1,536 to 98,304 elements. Only ratios matter, which differ
// less between machines.
constexpr double kSetUpOfTet = 2000;        // assembly, order and supernodes
constexpr double kFactorOfFlop = 1.0 / 20;  // numeric phase
constexpr double kProductOfTet = 8;         // A p
constexpr double kSolveOfEntry = 0.1;       // forward and backward substitution, panels in cache
constexpr double kSolveOfFarEntry = 0.5;    // forward and backward substitution, panels in memory
constexpr double kCacheEntries = 5e6;       // 20 MB

// Flops over records^1.5, .18 to .21 in the beams of the benchmarks; .94 for a dense matrix.
constexpr double kFlops = 0.2;

constexpr double kMeanWeight = 1.0 / 16;  // weight of a step in the mean
constexpr double kHighestDearness = 64;

// Iterations with a fresh factor: in the beams of the benchmarks 1.4 at 1e-3, 4.4 at 1e-6, 6.3 at 1e-8.
double usualIterations(double tolerance)
{
    return std::max(1.0, -std::log10(tolerance) - 1.6);
}

}  // namespace

double refactorPrice(const BodyModel& model)
{
    const double tets = model.mesh().tetCount();
    const FactorReport& report = model.factorReport();
    const bool low = report.m_path == FactorPath::lowMemory;
    const double share = low && report.m_fullBytes > 0 ? double(report.m_bytes) / double(report.m_fullBytes) : 1;
    const double records = std::max(share * static_cast<double>(report.m_entries), 1.0);
    const double solve = records < kCacheEntries ? kSolveOfEntry : kSolveOfFarEntry;
    const double factor = kSetUpOfTet * tets + kFactorOfFlop * kFlops * records * std::sqrt(records);
    return factor / (kProductOfTet * tets + solve * records);
}

// A' has the eigenvalues of A times 1/mismatch^2 (a step in h^2 K) to mismatch^2, so that they spread by k = mismatch^2
// more; conjugate gradients then need n steps with 2 ((sqrt k - 1) / (sqrt k + 1))^n <= tolerance [Saad 2003, eq.
// 6.128].
double iterationsLostTo(double mismatch, double tolerance)
{
    if (!(mismatch > 1)) return 0;
    if (std::isinf(mismatch)) return mismatch;
    return std::floor(std::log(2 / tolerance) / std::log((mismatch + 1) / (mismatch - 1)));
}

void btFemFactorAccount::note(int iterations, double mismatch, double tolerance)
{
    m_stale = mismatch > 1;
    if (m_stale)
    {
        const double fresh = m_fresh >= 0 ? m_fresh : usualIterations(tolerance);
        m_lost += std::clamp(iterations - fresh, 0.0, iterationsLostTo(mismatch, tolerance));
        ++m_staleSteps;
        return;
    }
    m_fresh = m_fresh >= 0 ? m_fresh + kMeanWeight * (iterations - m_fresh) : iterations;
    m_owed -= m_rate;
    if (m_owed <= 0) m_dearness = 1;
}

void btFemFactorAccount::spend(double price)
{
    const double dearness = std::min(2 * m_dearness, kHighestDearness);
    const double rate = m_lost / std::max(m_staleSteps, 1);
    clear();
    m_dearness = dearness;
    m_owed = price;
    m_rate = rate;
}
