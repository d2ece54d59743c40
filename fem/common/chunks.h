// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cstdint>

#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{

// Shorter pieces would cost more to hand out than they take: some 10 us each.
constexpr int kBlocksPerChunk = 64;     ///< element blocks, 1,024 elements
constexpr int kDomainsPerChunk = 1024;  ///< edge domains of strains
constexpr int kNodesPerChunk = 512;     ///< nodes of which something is computed
constexpr int kEntriesPerChunk = 2048;  ///< nodes of vectors that are added or multiplied

/// [0, size) in pieces of nearly equal length, not much shorter than asked for. They depend on the size alone, never on
/// the number of threads, so that sums over pieces have the same bits for all of them.
class Chunks
{
public:
    static constexpr int kMost = 64;

    Chunks(int size, int shortest) : m_size(size), m_count(std::clamp(size / shortest, 1, kMost)) {}

    int count() const { return m_count; }
    Range operator[](int k) const { return {bound(k), bound(k + 1)}; }

private:
    int bound(int k) const { return static_cast<int>(static_cast<std::int64_t>(m_size) * k / m_count); }

    int m_size, m_count;
};

/// Calls task(k) for every k in [0, tasks), on the caller's thread where there are no others (null).
template <class Task>
void runTasks(const Threads* threads, int tasks, const Task& task)
{
    if (threads)
        threads->run(tasks, task);
    else
        for (int k = 0; k < tasks; ++k) task(k);
}

/// Calls run(range) for ranges that make up [0, size): the whole at once on one thread, else pieces. Only for what has
/// the same bits however it is divided.
template <class Run>
void runRanges(const Threads* threads, const Chunks& pieces, const Run& run)
{
    if (!threads || threads->count() == 1)
        run(Range{pieces[0].m_begin, pieces[pieces.count() - 1].m_end});
    else
        threads->run(pieces.count(), [&](int k) { run(pieces[k]); });
}

}  // namespace bullet_fem
