// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "fem/common/chunks.h"

namespace bullet_fem
{

/// The order in which rows are swept in turn: a tree of parts, such that parts of one level have no mover in common and
/// may be swept at the same time. Movers, what the impulses of rows move, are cut into two halves by position again and
/// again; a row belongs to the smallest part that has both its movers, and the parts are swept from the smallest to the
/// whole, which has what lies across the first cut. Depends on the rows alone, never on the number of threads; of few
/// rows there is one part. Grows, never shrinks.
class SweepParts
{
public:
    static constexpr int kRowsOfPart = 1024;  ///< sought in a smallest part: a sweep of fewer is over at once
    static constexpr int kMaxLevels = 5;
    static constexpr int kMax = 1 << kMaxLevels;  ///< parts, of which number 0 is none

    /// Begins with so many movers and no rows.
    void clear(int movers);

    /// The next row: its movers, -1 for none, and where it is [m].
    void add(int a, int b, const Vec3& at);

    /// When all rows are added: divides them, or, if not `many`, makes them one part.
    void divide(bool many);

    /// Sorts rows by their parts, and leaves those of one part in their order.
    void sort(std::vector<int>& rows);

    /// The number of levels, >= 1. Level k has the parts [2^k, 2^(k+1)).
    int levels() const { return m_levels; }
    int parts() const { return 1 << m_levels; }
    int partOf(int row) const { return m_part[row]; }

    /// The rows of a part among those sorted last.
    Range rows(int part) const { return {m_first[part], m_first[part + 1]}; }

    /// Calls sweep(part, rows(part)) for all parts in their order, those of a level on these threads at the same time.
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
        Vec3 m_at;       // mean of its rows [m]
        int m_rows = 0;  // that it has
    };

    void cut(Range movers, int part, int levels);
    int longestAxis(Range movers) const;
    int middle(Range movers) const;
    int partOf(const Row& row) const;

    int m_levels = 1;
    std::vector<Row> m_rows;
    std::vector<Mover> m_movers;
    std::vector<int> m_order;     // of the movers that have rows
    std::vector<int> m_smallest;  // per mover: the smallest part that has it
    std::vector<int> m_part;      // per row
    std::vector<int> m_first;     // per part, of the rows sorted last, and the end
    std::vector<int> m_unsorted;  // those rows as they were given
};

}  // namespace bullet_fem
