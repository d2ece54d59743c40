// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "fem/common/chunks.h"

namespace bullet_fem
{

/// Partition of the rows for parallel Gauss-Seidel sweeps: a tree of parts, such that parts of one level have no mover
/// in common and may be swept concurrently. Movers, the objects that the rows' impulses move, are bisected by position
/// recursively; a row belongs to the smallest part that contains both its movers. Parts are swept from the smallest to
/// the whole, which has the rows across the first cut. Depends on the rows alone, never on the number of threads; few
/// rows form one part. Grows, never shrinks.
class SweepParts
{
public:
    /// Target size of a smallest part: a sweep of fewer is too short to share.
    static constexpr int kRowsOfPart = 1024;
    static constexpr int kMaxLevels = 5;
    static constexpr int kMax = 1 << kMaxLevels;  ///< number of parts; part 0 does not exist

    /// Begins with this many movers and no rows.
    void clear(int movers);

    /// Appends a row: its movers, -1 for none, and its position [m].
    void add(int a, int b, const Vec3& at);

    /// Call when all rows are added: divides them, or, if not `many`, makes one part.
    void divide(bool many);

    /// Sorts rows by part, stably.
    void sort(std::vector<int>& rows);

    /// The number of levels, >= 1. Level k has the parts [2^k, 2^(k+1)).
    int levels() const { return m_levels; }
    int parts() const { return 1 << m_levels; }
    int partOf(int row) const { return m_part[row]; }

    /// The rows of a part among those of the last sort.
    Range rows(int part) const { return {m_first[part], m_first[part + 1]}; }

    /// Calls sweep(part, rows(part)) for all parts in their order, those of a level concurrently on these threads.
    template <class Sweep>
    void inTurn(const Threads* threads, const Sweep& sweep) const
    {
        for (int level = m_levels - 1; level >= 0; --level)
        {
            const int first = 1 << level;
            runTasks(threads, first, [&](int k) { sweep(first + k, rows(first + k)); });
        }
    }

private:
    struct Row
    {
        int m_a, m_b;
    };
    struct Mover
    {
        Vec3 m_at;       // mean position of its rows [m]
        int m_rows = 0;  // number of its rows
    };

    void cut(Range movers, int part, int levels);
    int longestAxis(Range movers) const;
    int middle(Range movers) const;
    int partOf(const Row& row) const;

    int m_levels = 1;
    std::vector<Row> m_rows;
    std::vector<Mover> m_movers;
    std::vector<int> m_order;     // order of the movers with rows
    std::vector<int> m_smallest;  // per mover: the smallest part that contains it
    std::vector<int> m_part;      // part of each row
    std::vector<int> m_first;     // per part: start in the sorted rows, then the end
    std::vector<int> m_unsorted;  // the rows before sorting
};

}  // namespace bullet_fem
