// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cstdint>

#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{

// Minimum chunk sizes: handing out a chunk costs about as much as 10 us of work.
constexpr int kBlocksPerChunk = 64;     ///< element blocks, 1,024 elements
constexpr int kPatchesPerChunk = 128;   ///< patches whose strains are assumed
constexpr int kNodesPerChunk = 512;     ///< nodes in per-node computations
constexpr int kEntriesPerChunk = 2048;  ///< entries of vectors that are added or multiplied

/// Divides [0, size) into chunks of nearly equal length, at least about the minimum. The division depends on the size
/// alone, never on the number of threads, so that sums over chunks are bitwise reproducible.
class Chunks
{
public:
    static constexpr int kMax = 64;

    Chunks(int size, int shortest) : m_size(size), m_count(std::clamp(size / shortest, 1, kMax)) {}

    int count() const { return m_count; }
    Range operator[](int k) const { return {bound(k), bound(k + 1)}; }

private:
    int bound(int k) const { return static_cast<int>(static_cast<std::int64_t>(m_size) * k / m_count); }

    int m_size, m_count;
};

/// Calls task(k) for every k in [0, tasks), on the calling thread if `threads` is null.
template <class Task>
void runTasks(const Threads* threads, int tasks, const Task& task)
{
    if (threads)
        threads->run(tasks, task);
    else
        for (int k = 0; k < tasks; ++k) task(k);
}

/// Calls run(range) for ranges that cover [0, size): one range on a single thread, else the chunks. For work whose
/// result is bitwise independent of the division.
template <class Run>
void runRanges(const Threads* threads, const Chunks& pieces, const Run& run)
{
    if (!threads || threads->count() == 1)
        run(Range{pieces[0].m_begin, pieces[pieces.count() - 1].m_end});
    else
        threads->run(pieces.count(), [&](int k) { run(pieces[k]); });
}

}  // namespace bullet_fem
