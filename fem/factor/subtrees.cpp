// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/subtrees.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

// Minimum entries of a factor that is divided, 1 MB: smaller solves finish before other threads wake up.
constexpr double kMinEntriesToDivide = 250e3;

// Maximum share of the entries in a subtree: smaller subtrees occupy more threads, but enlarge the top, which one
// thread solves. Subtrees below the minimum share are not worth rows of their own.
constexpr double kLargestSubtreeShare = 0.28;
constexpr double kSmallestSubtreeShare = 1. / 400;

double entries(const Supernode& s)
{
    return 9. * s.m_columns * (s.m_columns + s.m_rows);
}

// Number of entries of every supernode with all its descendants.
std::vector<double> subtreeEntries(const SupernodeTree& tree)
{
    std::vector<double> sum;
    for (const Supernode& s : tree.m_supernodes) sum.push_back(entries(s));
    for (std::size_t s = 0; s < sum.size(); ++s)
        if (tree.m_supernodes[s].m_parent >= 0) sum[tree.m_supernodes[s].m_parent] += sum[s];
    return sum;
}

// The first descendant of every supernode, or itself.
std::vector<int> firstDescendants(const SupernodeTree& tree)
{
    std::vector<int> first(tree.m_supernodes.size());
    for (std::size_t s = 0; s < first.size(); ++s) first[s] = static_cast<int>(s);
    for (std::size_t s = 0; s < first.size(); ++s)
    {
        const int parent = tree.m_supernodes[s].m_parent;
        if (parent >= 0) first[parent] = std::min(first[parent], first[s]);
    }
    return first;
}

// Gives the rows above a subtree indices from firstAbove on. These are rows of the root, for all its descendants.
void renumberAbove(const SupernodeTree& tree, const Subtree& subtree, std::vector<int>& forwardRow)
{
    const Supernode& root = tree.m_supernodes[subtree.m_end - 1];
    const int columnsEnd = root.m_first + root.m_columns;
    const auto above = tree.m_row.begin() + root.m_rowStart;
    for (int s = subtree.m_begin; s < subtree.m_end; ++s)
    {
        const Supernode& supernode = tree.m_supernodes[s];
        for (int k = supernode.m_rowStart; k < supernode.m_rowStart + supernode.m_rows; ++k)
            if (tree.m_row[k] >= columnsEnd)
                forwardRow[k] = subtree.m_firstAbove +
                                static_cast<int>(std::lower_bound(above, above + root.m_rows, tree.m_row[k]) - above);
    }
}

}  // namespace

TreeDivision::TreeDivision(const SupernodeTree& tree) : m_forwardRow(tree.m_row), m_rowCount(tree.m_nodeCount)
{
    const std::vector<double> sum = subtreeEntries(tree);
    const std::vector<int> first = firstDescendants(tree);
    double total = 0;
    for (const Supernode& s : tree.m_supernodes) total += entries(s);
    for (int s = static_cast<int>(sum.size()) - 1; s >= 0;)
    {
        const bool own = total >= kMinEntriesToDivide && sum[s] <= kLargestSubtreeShare * total &&
                         sum[s] >= kSmallestSubtreeShare * total;
        if (own)
        {
            m_subtrees.push_back({first[s], s + 1, m_rowCount});
            m_rowCount += tree.m_supernodes[s].m_rows;
            renumberAbove(tree, m_subtrees.back(), m_forwardRow);
            s = first[s] - 1;
        }
        else
            m_top.push_back(s--);
    }
    std::reverse(m_subtrees.begin(), m_subtrees.end());
    std::reverse(m_top.begin(), m_top.end());
}

}  // namespace bullet_fem
