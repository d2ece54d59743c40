// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kernels/timed_work.h"

namespace bullet_fem
{

/// One kernel on one beam: one row of the table.
struct KernelFigures
{
    int m_tets = 0;
    std::string m_kernel;
    Timing m_time;
    double m_bytes = 0;       ///< minimum memory traffic [B]; 0 if not meaningful
    double m_operations = 0;  ///< additions and multiplications [flop]; 0 if not counted

    double nanosecondsPerTet() const { return 1e9 * m_time.m_best / m_tets; }
    double gigabytesPerSecond() const { return 1e-9 * m_bytes / m_time.m_best; }
    double gigaflops() const { return 1e-9 * m_operations / m_time.m_best; }
};

/// Time of the triangular solves of one beam relative to reading the memory that they use.
struct SolveFigures
{
    int m_tets = 0;
    double m_factorMegabytes = 0;     ///< packed [MB]
    double m_readGigabytes = 0;       ///< read bandwidth of a buffer of that size, read repeatedly [GB/s]
    double m_solveOverTwoReads = 0;   ///< one solve pair over two reads of such a buffer, measured alternately [-]
    double m_solveOverBestReads = 0;  ///< ratio of the best times when each is repeated on its own [-]
    double m_lanesOverOne = 0;        ///< time of 16 right-hand sides over that of one [-]
};

/// All kernels on a beam of one size.
struct KernelRun
{
    std::vector<KernelFigures> m_kernels;
    SolveFigures m_solves;
};

/// Times the kernels of the beam of `tets` = 24 n^3 elements, each for about `seconds`. Throws std::invalid_argument.
KernelRun measureKernels(int tets, double seconds);

}  // namespace bullet_fem
