// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/supernode_tree.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

// Cost model of a pair of triangular solves, in bytes of memory traffic: M is read twice (up and down the tree), all of
// S once. A supernode costs its calls and cold starts, a row below its gathering and scattering.
constexpr double kBytesPerEntry = 4;
constexpr double kBytesPerSupernode = 2000;
constexpr double kBytesPerRow = 48;

// Maximum columns of a supernode [nodes]; wider ones are cut. S is stored in full, so that p columns take p^2 entries
// where narrow supernodes take p^2 / 2, and arithmetic grows alike. A smaller maximum gains little and adds calls.
constexpr int kWidestSupernode = 64;

// The graph of the pattern, and an elimination order of its rows.
struct OrderedGraph : PatternGraph<int>
{
    using PatternGraph::PatternGraph;
    std::vector<int> m_order, m_position;  // inverse to each other

    int size() const { return static_cast<int>(m_order.size()); }

    // Calls visit(k) for every neighbour of the i-th row; the neighbour is the k-th row.
    template <class Visit>
    void forNeighbours(int i, const Visit& visit) const
    {
        for (int a = m_start[m_order[i]]; a < m_start[m_order[i] + 1]; ++a) visit(m_position[m_neighbour[a]]);
    }

    // Makes row i the place[i]-th row.
    void reorder(const std::vector<int>& place)
    {
        std::vector<int> order(m_order.size());
        for (int i = 0; i < size(); ++i) order[place[i]] = m_order[i];
        m_order = std::move(order);
        for (int i = 0; i < size(); ++i) m_position[m_order[i]] = i;
    }
};

std::vector<int> inversePermutation(const std::vector<int>& order, int size)
{
    if (static_cast<int>(order.size()) != size)
        throw std::invalid_argument(message("elimination order has ", order.size(), " entries; the pattern has ", size,
                                            " rows and every row must come once"));
    std::vector<int> position(size, -1);
    for (int k = 0; k < size; ++k)
    {
        if (order[k] < 0 || order[k] >= size || position[order[k]] >= 0)
            throw std::invalid_argument(message("elimination order names row ", order[k], " at place ", k,
                                                "; every row 0 ... ", size - 1, " must come once"));
        position[order[k]] = k;
    }
    return position;
}

OrderedGraph orderedGraph(const SparsePattern& pattern, const std::vector<int>& order)
{
    OrderedGraph graph(pattern);
    graph.m_order = order;
    graph.m_position = inversePermutation(order, pattern.m_size);
    return graph;
}

// The elimination tree: the parent of each column is its first row below the diagonal, fill included; -1 at a root.
// [Liu 1986]
std::vector<int> eliminationTree(const OrderedGraph& graph)
{
    std::vector<int> parent(graph.size(), -1), ancestor(graph.size(), -1);
    for (int i = 0; i < graph.size(); ++i)
        graph.forNeighbours(i,
                            [&](int k)
                            {
                                while (k >= 0 && k < i)
                                {
                                    const int next = ancestor[k];
                                    ancestor[k] = i;  // path compression
                                    if (next < 0) parent[k] = i;
                                    k = next;
                                }
                            });
    return parent;
}

// Postorder position of each vertex, with every subtree consecutive and its root last. Parents have greater indices
// than their children; vertices of weight 0 take no position.
std::vector<int> postorder(const std::vector<int>& parent, const std::vector<int>& weight)
{
    const int n = static_cast<int>(parent.size());
    std::vector<int> size = weight, free(n), place(n);
    for (int v = 0; v < n; ++v)
        if (parent[v] >= 0) size[parent[v]] += size[v];
    int freeRoot = 0;
    for (int v = n - 1; v >= 0; --v)
    {
        int& first = parent[v] >= 0 ? free[parent[v]] : freeRoot;
        free[v] = first;
        first += size[v];
        place[v] = first - 1;
    }
    return place;
}

// Permutes the graph into postorder and returns its elimination tree.
std::vector<int> postorderedTree(OrderedGraph& graph)
{
    const std::vector<int> parent = eliminationTree(graph);
    const std::vector<int> place = postorder(parent, std::vector<int>(parent.size(), 1));
    graph.reorder(place);
    std::vector<int> result(parent.size());
    for (int v = 0; v < graph.size(); ++v) result[place[v]] = parent[v] >= 0 ? place[parent[v]] : -1;
    return result;
}

// Number of rows below the diagonal of each column. Row i of the factor holds the columns on the tree paths from the
// neighbours of i up to i.
std::vector<int> rowsBelow(const OrderedGraph& graph, const std::vector<int>& parent)
{
    std::vector<int> count(graph.size(), 0), seenBy(graph.size(), -1);
    for (int i = 0; i < graph.size(); ++i)
    {
        seenBy[i] = i;
        graph.forNeighbours(i,
                            [&](int k)
                            {
                                for (; k < i && seenBy[k] != i; k = parent[k])
                                {
                                    seenBy[k] = i;
                                    ++count[k];
                                }
                            });
    }
    return count;
}

// A set of columns that may become a supernode.
struct Group
{
    int m_columns = 0, m_rows = 0, m_parent = -1;
    std::vector<int> m_parts;  // first columns of its runs

    double entries() const
    {
        const double p = 3. * m_columns;
        return p * (p + 1) / 2 + p * 3 * m_rows;
    }
    double solveCost() const
    {
        const double p = 3. * m_columns, r = 3. * m_rows;
        return kBytesPerEntry * (p * p + 2 * p * r) + kBytesPerRow * m_rows + kBytesPerSupernode;
    }
};

// Fundamental supernodes: runs of columns with equal rows below. Returns the groups, children before parents.
std::vector<Group> fundamentalSupernodes(const std::vector<int>& parent, const std::vector<int>& rows)
{
    const int n = static_cast<int>(parent.size());
    std::vector<Group> groups;
    std::vector<int> groupOf(n);
    for (int c = 0; c < n; ++c)
    {
        const bool joins = c > 0 && parent[c - 1] == c && rows[c - 1] == rows[c] + 1;
        if (!joins) groups.push_back({0, 0, -1, {c}});
        ++groups.back().m_columns;
        groups.back().m_rows = rows[c];
        groupOf[c] = static_cast<int>(groups.size()) - 1;
    }
    for (int c = 0; c < n; ++c)
        if (parent[c] >= 0 && groupOf[parent[c]] != groupOf[c]) groups[groupOf[c]].m_parent = groupOf[parent[c]];
    return groups;
}

// Reduction of the solve cost if the child's columns become columns of the parent.
double mergeGain(const Group& child, const Group& parent)
{
    const Group merged = {child.m_columns + parent.m_columns, parent.m_rows, -1, {}};
    return child.solveCost() + parent.solveCost() - merged.solveCost();
}

// Merges children into parents where it pays, the highest gain first. A merged group is left without columns.
void mergeGroups(std::vector<Group>& groups)
{
    std::vector<std::vector<int>> children(groups.size());
    for (int s = 0; s < static_cast<int>(groups.size()); ++s)
    {
        Group& parent = groups[s];
        std::vector<std::pair<double, int>> candidates;
        for (int c : children[s]) candidates.push_back({-mergeGain(groups[c], parent), c});
        std::sort(candidates.begin(), candidates.end());
        for (const auto& [loss, c] : candidates)
        {
            Group& child = groups[c];
            if (mergeGain(child, parent) < 0) continue;
            parent.m_columns += child.m_columns;
            parent.m_parts.insert(parent.m_parts.end(), child.m_parts.begin(), child.m_parts.end());
            child = {0, 0, s, {}};
        }
        if (parent.m_parent >= 0) children[parent.m_parent].push_back(s);
    }
}

// The supernodes without their rows, in postorder; permutes the graph accordingly.
SupernodeTree placeGroups(const std::vector<Group>& groups, const std::vector<int>& runLength, OrderedGraph& graph)
{
    const int n = static_cast<int>(groups.size());
    std::vector<int> parent(n), alive(n);
    for (int s = n - 1; s >= 0; --s)
    {
        alive[s] = groups[s].m_columns > 0;
        const int up = groups[s].m_parent;
        parent[s] = up >= 0 && !alive[up] ? parent[up] : up;
    }
    const std::vector<int> place = postorder(parent, alive);

    SupernodeTree tree;
    std::vector<int> groupAt;
    for (int s = 0; s < n; ++s)
        if (alive[s]) groupAt.push_back(s);
    std::sort(groupAt.begin(), groupAt.end(), [&place](int a, int b) { return place[a] < place[b]; });
    std::vector<int> newColumn(graph.size());
    for (int s : groupAt)
    {
        const Group& group = groups[s];
        tree.m_supernodes.push_back({tree.m_nodeCount, group.m_columns, 0, 0, parent[s] >= 0 ? place[parent[s]] : -1});
        std::vector<int> parts = group.m_parts;
        std::sort(parts.begin(), parts.end());  // descendants before ancestors
        for (int first : parts)
            for (int c = 0; c < runLength[first]; ++c) newColumn[first + c] = tree.m_nodeCount++;
        tree.m_entries += static_cast<long>(group.entries());
    }
    graph.reorder(newColumn);
    return tree;
}

// The rows of a supernode are those of its columns' neighbours and of its children, minus its own columns.
void collectRows(const OrderedGraph& graph, SupernodeTree& tree)
{
    const int n = static_cast<int>(tree.m_supernodes.size());
    std::vector<int> seenBy(graph.size(), -1);
    std::vector<std::vector<int>> children(n);
    for (int s = 0; s < n; ++s)
    {
        Supernode& supernode = tree.m_supernodes[s];
        const int end = supernode.m_first + supernode.m_columns;
        supernode.m_rowStart = static_cast<int>(tree.m_row.size());
        const auto add = [&](int row)
        {
            if (row < end || seenBy[row] == s) return;
            seenBy[row] = s;
            tree.m_row.push_back(row);
        };
        for (int c = supernode.m_first; c < end; ++c) graph.forNeighbours(c, add);
        for (int child : children[s])
            for (int k = 0; k < tree.m_supernodes[child].m_rows; ++k)
                add(tree.m_row[tree.m_supernodes[child].m_rowStart + k]);
        std::sort(tree.m_row.begin() + supernode.m_rowStart, tree.m_row.end());
        supernode.m_rows = static_cast<int>(tree.m_row.size()) - supernode.m_rowStart;
        if (supernode.m_parent >= 0) children[supernode.m_parent].push_back(s);
    }
}

// Cuts wide supernodes into chains, each link the parent of the previous one; children belong to the first link.
SupernodeTree cutWide(const SupernodeTree& whole)
{
    const auto links = [](const Supernode& s) { return (s.m_columns + kWidestSupernode - 1) / kWidestSupernode; };
    std::vector<int> firstLink;
    int count = 0;
    for (const Supernode& s : whole.m_supernodes)
    {
        firstLink.push_back(count);
        count += links(s);
    }

    SupernodeTree tree;
    tree.m_nodeCount = whole.m_nodeCount;
    tree.m_entries = whole.m_entries;
    for (const Supernode& s : whole.m_supernodes)
        for (int k = 0; k < links(s); ++k)
        {
            const int begin = s.m_columns * k / links(s), end = s.m_columns * (k + 1) / links(s);
            const int next = static_cast<int>(tree.m_supernodes.size()) + 1;
            const int parent = s.m_parent >= 0 ? firstLink[s.m_parent] : -1;
            tree.m_supernodes.push_back({s.m_first + begin, end - begin, static_cast<int>(tree.m_row.size()),
                                         s.m_columns - end + s.m_rows, k + 1 < links(s) ? next : parent});
            for (int c = end; c < s.m_columns; ++c) tree.m_row.push_back(s.m_first + c);
            const auto rows = whole.m_row.begin() + s.m_rowStart;
            tree.m_row.insert(tree.m_row.end(), rows, rows + s.m_rows);
        }
    return tree;
}

}  // namespace

int SupernodeTree::widestColumns() const
{
    int widest = 0;
    for (const Supernode& s : m_supernodes) widest = std::max(widest, s.m_columns);
    return widest;
}

int SupernodeTree::longestRows() const
{
    int longest = 0;
    for (const Supernode& s : m_supernodes) longest = std::max(longest, s.m_rows);
    return longest;
}

SupernodeTree buildSupernodeTree(const SparsePattern& pattern, std::vector<int>& order)
{
    OrderedGraph graph = orderedGraph(pattern, order);
    const std::vector<int> parent = postorderedTree(graph);
    std::vector<Group> groups = fundamentalSupernodes(parent, rowsBelow(graph, parent));
    std::vector<int> runLength(graph.size());
    for (const Group& group : groups) runLength[group.m_parts[0]] = group.m_columns;
    mergeGroups(groups);
    SupernodeTree tree = placeGroups(groups, runLength, graph);
    collectRows(graph, tree);
    order = graph.m_order;
    return cutWide(tree);
}

long blocksOfFactor(const SparsePattern& pattern, const std::vector<int>& order)
{
    const OrderedGraph graph = orderedGraph(pattern, order);
    const std::vector<int> rows = rowsBelow(graph, eliminationTree(graph));
    return std::accumulate(rows.begin(), rows.end(), long(graph.size()));
}

}  // namespace bullet_fem
