// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Multifrontal factorization [Duff & Reid 1983; Liu 1992]: each supernode is a dense front of its columns and rows,
// assembled from A and its children's update matrices; eliminating its columns leaves the update matrix for its parent.
#include "fem/factor/numeric_factor.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "fem/common/message.h"
#include "fem/factor/dense_kernels.h"

namespace bullet_fem
{
namespace
{

// Memory of the fronts. Update matrices A22 wait for their parents on two stacks, one from either end: a supernode's
// own is pushed on the stack of its depth's parity, its children's are popped from the other one, so nothing has to
// move. A11 and A21 of the current front lie between the stacks.
class FrontArena
{
public:
    FrontArena(const SupernodeTree& tree, int rowsOfNode);

    DenseFront front(int s);
    const std::vector<int>& children(int s) const { return m_children[s]; }

private:
    struct Place
    {
        std::size_t m_pivots, m_rows;  // sizes [scalars]
        std::size_t m_A22, m_A11;      // starts; that of A22 from the end of the arena at odd depths
        int m_depth;
    };

    std::vector<Place> m_places;
    std::vector<std::vector<int>> m_children;
    std::size_t m_size = 0;
    std::unique_ptr<double[]> m_memory;
};

FrontArena::FrontArena(const SupernodeTree& tree, int rowsOfNode)
    : m_places(tree.m_supernodes.size()), m_children(tree.m_supernodes.size())
{
    for (int s = static_cast<int>(m_places.size()) - 1; s >= 0; --s)
    {
        const Supernode& supernode = tree.m_supernodes[s];
        const int parent = supernode.m_parent;
        m_places[s].m_pivots = rowsOfNode * static_cast<std::size_t>(supernode.m_columns);
        m_places[s].m_rows = rowsOfNode * static_cast<std::size_t>(supernode.m_rows);
        m_places[s].m_depth = parent >= 0 ? m_places[parent].m_depth + 1 : 0;
        if (parent >= 0) m_children[parent].push_back(s);
    }
    std::size_t top[2] = {0, 0};
    for (std::size_t s = 0; s < m_places.size(); ++s)
    {
        Place& place = m_places[s];
        const int parity = place.m_depth % 2;
        top[parity] += place.m_rows * place.m_rows;
        place.m_A22 = parity == 0 ? top[0] - place.m_rows * place.m_rows : top[1];
        place.m_A11 = top[0];
        m_size = std::max(m_size, top[0] + top[1] + place.m_pivots * (place.m_pivots + place.m_rows));
        for (int child : m_children[s]) top[1 - parity] -= m_places[child].m_rows * m_places[child].m_rows;
    }
    m_memory.reset(new double[m_size]);  // not cleared: each front clears what it uses
}

DenseFront FrontArena::front(int s)
{
    const Place& place = m_places[s];
    double* const A11 = m_memory.get() + place.m_A11;
    double* const A22 = m_memory.get() + (place.m_depth % 2 == 0 ? place.m_A22 : m_size - place.m_A22);
    return {static_cast<int>(place.m_pivots), static_cast<int>(place.m_rows), A11,
            A11 + place.m_pivots * place.m_pivots, A22};
}

class Fronts
{
public:
    Fronts(const BlockMatrix& A, const std::vector<int>& order, const SupernodeTree& tree, NodeEntry entry);

    // Assembles and eliminates supernode s: afterwards A11 holds S, and A21 holds M.
    DenseFront factor(int s);

private:
    // A run of a child's rows that are consecutive in the front, too.
    struct Run
    {
        int m_from, m_to, m_count;  // first row in the child, in the front, and length [scalars]
    };

    void number(const Supernode& s);
    bool holds(const Supernode& s, int row) const;
    void clear(const DenseFront& front);
    void addMatrix(const Supernode& s, const DenseFront& front);
    void addChild(int child, const DenseFront& front);
    void findRuns(const Supernode& child, int columns);

    const BlockMatrix& m_A;
    const std::vector<int>& m_order;
    const SupernodeTree& m_tree;
    const int m_rowsOfNode;
    FrontArena m_arena;
    std::vector<int> m_column;  // column of each node of A; -1 if left out
    std::vector<int> m_place;   // position of each column in the current front [nodes]
    std::vector<double> m_scratch;
    std::vector<Run> m_runs;
};

std::vector<int> columnOfNode(const BlockMatrix& A, const std::vector<int>& order, const SupernodeTree& tree)
{
    if (static_cast<int>(order.size()) != tree.m_nodeCount)
        reject("elimination order has ", order.size(), " entries; the tree has ", tree.m_nodeCount, " columns");
    std::vector<int> column(A.nodeCount(), -1);
    for (std::size_t k = 0; k < order.size(); ++k)
    {
        if (order[k] < 0 || order[k] >= A.nodeCount() || column[order[k]] >= 0)
            reject("elimination order names node ", order[k], " at place ", k, "; nodes are 0 ... ", A.nodeCount() - 1,
                   " and come at most once");
        column[order[k]] = static_cast<int>(k);
    }
    return column;
}

Fronts::Fronts(const BlockMatrix& A, const std::vector<int>& order, const SupernodeTree& tree, NodeEntry entry)
    : m_A(A),
      m_order(order),
      m_tree(tree),
      m_rowsOfNode(rowsOfNode(entry)),
      m_arena(tree, m_rowsOfNode),
      m_column(columnOfNode(A, order, tree)),
      m_place(order.size(), -1)
{
    std::size_t scratch = 0;
    for (const Supernode& s : tree.m_supernodes)
        scratch = std::max(scratch, eliminationScratch(m_rowsOfNode * s.m_columns, m_rowsOfNode * s.m_rows));
    m_scratch.resize(scratch);
}

DenseFront Fronts::factor(int s)
{
    const Supernode& supernode = m_tree.m_supernodes[s];
    const DenseFront front = m_arena.front(s);
    number(supernode);
    clear(front);
    addMatrix(supernode, front);
    for (int child : m_arena.children(s)) addChild(child, front);

    double pivotValue = 0;
    const int failed = eliminatePivots(front, m_scratch.data(), pivotValue);
    if (failed >= 0)
        throw std::runtime_error(message("the matrix is not positive definite: pivot ", pivotValue, " at node ",
                                         m_order[supernode.m_first + failed / m_rowsOfNode],
                                         "; check masses, moduli and element volumes there"));
    return front;
}

bool Fronts::holds(const Supernode& s, int row) const
{
    const int place = m_place[row];
    if (place < 0 || place >= s.m_columns + s.m_rows) return false;
    return row == (place < s.m_columns ? s.m_first + place : m_tree.m_row[s.m_rowStart + place - s.m_columns]);
}

void Fronts::number(const Supernode& s)
{
    for (int k = 0; k < s.m_columns; ++k) m_place[s.m_first + k] = k;
    for (int k = 0; k < s.m_rows; ++k) m_place[m_tree.m_row[s.m_rowStart + k]] = s.m_columns + k;
}

// Clears the upper halves, too: they are unused, but kernels compute there, and must not meet NaN.
void Fronts::clear(const DenseFront& front)
{
    const std::size_t p = front.m_pivots, r = front.m_rows;
    std::fill_n(front.m_A11, p * p, 0.0);
    std::fill_n(front.m_A21, r * p, 0.0);
    std::fill_n(front.m_A22, r * r, 0.0);
}

// A submatrix of a column-major matrix.
struct Submatrix
{
    double* m_start;
    std::ptrdiff_t m_stride;
};

// The front's lower half from entry (i, j) on, up to the end of the block that contains it.
Submatrix submatrix(const DenseFront& front, int i, int j)
{
    const std::ptrdiff_t p = front.m_pivots, r = front.m_rows;
    if (i < p) return {front.m_A11 + i + j * p, p};
    if (j < p) return {front.m_A21 + (i - p) + j * r, r};
    return {front.m_A22 + (i - p) + (j - p) * r, r};
}

// Adds the blocks of A in the supernode's columns, on and below the diagonal.
void Fronts::addMatrix(const Supernode& s, const DenseFront& front)
{
    for (int k = 0; k < s.m_columns; ++k)
    {
        const int node = m_order[s.m_first + k];
        for (int a = m_A.m_rowStart[node]; a < m_A.m_rowStart[node + 1]; ++a)
        {
            const int row = m_column[m_A.m_column[a]];
            if (row < s.m_first + k) continue;  // left out, or in an earlier column
            if (!holds(s, row))
                reject("the tree has no room for the matrix's block of nodes ", node, " and ", m_A.m_column[a],
                       "; it must be built from a pattern that has that block");
            const Submatrix to = submatrix(front, m_rowsOfNode * m_place[row], m_rowsOfNode * k);
            if (m_rowsOfNode == 1)
            {
                *to.m_start += trace(m_A.m_block[a]) / 3;
                continue;
            }
            for (int j = 0; j < 3; ++j)  // this row of A holds the transpose
                for (int i = 0; i < 3; ++i) to.m_start[i + j * to.m_stride] += m_A.m_block[a](j, i);
        }
    }
}

void Fronts::findRuns(const Supernode& child, int columns)
{
    m_runs.clear();
    for (int k = 0; k < child.m_rows; ++k)
    {
        const int to = m_place[m_tree.m_row[child.m_rowStart + k]];
        const bool joins = k > 0 && to != columns &&
                           m_runs.back().m_to + m_runs.back().m_count == m_rowsOfNode * to;  // none crosses A11's end
        if (!joins) m_runs.push_back({m_rowsOfNode * k, m_rowsOfNode * to, 0});
        m_runs.back().m_count += m_rowsOfNode;
    }
}

void add(const Submatrix& from, const Submatrix& to, int rows, int columns)
{
    for (int j = 0; j < columns; ++j)
    {
        const double* __restrict source = from.m_start + j * from.m_stride;
        double* __restrict target = to.m_start + j * to.m_stride;
        for (int i = 0; i < rows; ++i) target[i] += source[i];
    }
}

// Adds a child's update matrix to the front, lower half to lower half.
void Fronts::addChild(int child, const DenseFront& front)
{
    const std::ptrdiff_t size = m_rowsOfNode * m_tree.m_supernodes[child].m_rows;
    findRuns(m_tree.m_supernodes[child], front.m_pivots / m_rowsOfNode);
    for (std::size_t c = 0; c < m_runs.size(); ++c)
        for (std::size_t r = c; r < m_runs.size(); ++r)
        {
            const Run &columns = m_runs[c], &rows = m_runs[r];
            const Submatrix from = {m_arena.front(child).m_A22 + rows.m_from + columns.m_from * size, size};
            add(from, submatrix(front, rows.m_to, columns.m_to), rows.m_count, columns.m_count);
        }
}

}  // namespace

void factorSupernodes(const BlockMatrix& A, const std::vector<int>& order, const SupernodeTree& tree,
                      const SupernodeTaker& take, NodeEntry entry)
{
    Fronts fronts(A, order, tree, entry);
    for (int s = 0; s < static_cast<int>(tree.m_supernodes.size()); ++s)
    {
        const DenseFront front = fronts.factor(s);
        take(s, front.m_A11, front.m_A21);
    }
}

}  // namespace bullet_fem
