// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/baked/baked_checks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fem/common/message.h"
#include "fem/factor/packed_factor.h"

namespace bullet_fem
{
namespace
{

bool isPositive(double value)
{
    return value > 0 && std::isfinite(value);
}

// Columns and rows are stored consecutively; rows ascend, and follow the columns.
SupernodeTree treeOf(const BakedHeader& header, const BakedArrays& a)
{
    SupernodeTree tree;
    tree.m_row = a.m_row;
    tree.m_nodeCount = static_cast<int>(header.m_freeNodes);
    tree.m_entries = static_cast<long>(header.m_entries);
    tree.m_supernodes.reserve(a.m_supernodes.size());
    int column = 0, row = 0;
    for (std::size_t s = 0; s < a.m_supernodes.size(); ++s)
    {
        const auto [columns, rows, parent] = a.m_supernodes[s];
        if (columns < 1 || columns > tree.m_nodeCount - column || rows < 0 ||
            rows > static_cast<int>(a.m_row.size()) - row)
            reject("supernode ", s, " has ", columns, " columns and ", rows, " rows");
        tree.m_supernodes.push_back({column, columns, row, rows, parent});
        column += columns;
        for (int k = row; k < row + rows; ++k)
            if (a.m_row[k] < (k == row ? column : a.m_row[k - 1] + 1) || a.m_row[k] >= tree.m_nodeCount)
                reject("row ", k, " of the factor is node ", a.m_row[k]);
        row += rows;
    }
    if (column != tree.m_nodeCount || row != static_cast<int>(a.m_row.size()))
        reject("the supernodes have ", column, " of ", tree.m_nodeCount, " columns and ", row, " of ", a.m_row.size(),
               " rows");
    return tree;
}

void checkRowsOfParent(const SupernodeTree& tree, int s)
{
    const Supernode& child = tree.m_supernodes[s];
    const int count = static_cast<int>(tree.m_supernodes.size());
    if (child.m_parent < -1 || (child.m_parent >= 0 && child.m_parent <= s) || child.m_parent >= count ||
        (child.m_parent < 0 && child.m_rows > 0))
        reject("supernode ", s, " has the parent ", child.m_parent, " and ", child.m_rows, " rows");
    if (child.m_parent < 0) return;
    const Supernode& parent = tree.m_supernodes[child.m_parent];
    const auto own = tree.m_row.begin() + child.m_rowStart;
    const auto beyond = std::lower_bound(own, own + child.m_rows, parent.m_first + parent.m_columns);
    const auto above = tree.m_row.begin() + parent.m_rowStart;
    if ((child.m_rows > 0 && *own < parent.m_first) ||
        !std::includes(above, above + parent.m_rows, beyond, own + child.m_rows))
        reject("supernode ", s, " has rows that its parent ", child.m_parent, " has not");
}

// The descendants of a supernode directly precede it.
void checkPostorder(const SupernodeTree& tree)
{
    std::vector<int> first(tree.m_supernodes.size()), size(tree.m_supernodes.size(), 1);
    for (std::size_t s = 0; s < first.size(); ++s) first[s] = static_cast<int>(s);
    for (std::size_t s = 0; s < first.size(); ++s)
    {
        if (static_cast<int>(s) - first[s] + 1 != size[s]) reject("supernode ", s, " does not follow its descendants");
        const int parent = tree.m_supernodes[s].m_parent;
        if (parent < 0) continue;
        first[parent] = std::min(first[parent], first[s]);
        size[parent] += size[s];
    }
}

}  // namespace

SupernodeTree checkedTree(const BakedHeader& header, const BakedArrays& arrays)
{
    SupernodeTree tree = treeOf(header, arrays);
    for (std::size_t s = 0; s < tree.m_supernodes.size(); ++s) checkRowsOfParent(tree, static_cast<int>(s));
    checkPostorder(tree);
    const NodeEntry entry = header.m_lowMemory ? NodeEntry::number : NodeEntry::block;
    if (PackedFactor::bytesFor(tree, entry) != sizeof(float) * header.m_panelFloats)
        reject("the factor's panels take ", sizeof(float) * header.m_panelFloats, " bytes, and should take ",
               PackedFactor::bytesFor(tree, entry));
    return tree;
}

std::vector<int> checkedPositions(const BakedArrays& a)
{
    std::vector<int> position(a.m_fixed.size(), -1);
    for (std::size_t k = 0; k < a.m_order.size(); ++k)
    {
        const int node = a.m_order[k];
        if (node < 0 || node >= static_cast<int>(position.size()) || a.m_fixed[node] || position[node] >= 0)
            reject("column ", k, " of the factor is node ", node, ", which is fixed, there twice or not in [0, ",
                   position.size(), ")");
        position[node] = static_cast<int>(k);
    }
    if (static_cast<std::ptrdiff_t>(a.m_order.size()) != std::count(a.m_fixed.begin(), a.m_fixed.end(), 0))
        reject("the factor has ", a.m_order.size(), " columns, and there are more free nodes");
    return position;
}

void checkValues(const BakedHeader& header, const BakedArrays& a)
{
    for (std::size_t i = 0; i < a.m_fixed.size(); ++i)
    {
        if (a.m_fixed[i] > 1) reject("the fixed flag of node ", i, " is ", static_cast<int>(a.m_fixed[i]));
        if (!isPositive(a.m_inverseMass[i]) || !isPositive(1 / a.m_inverseMass[i]) || !isPositive(a.m_diagonal[i]))
            reject("node ", i, " has the inverse mass ", a.m_inverseMass[i], " / kg and the diagonal entry ",
                   a.m_diagonal[i], " kg, not in (0, inf)");
    }
    for (std::size_t v = 0; v < a.m_vertexTet.size(); ++v)
    {
        bool good = a.m_vertexTet[v] >= 0 && a.m_vertexTet[v] < static_cast<int>(header.m_tets);
        for (const double weight : a.m_weights[v]) good = good && std::isfinite(weight);
        if (!good) reject("embedded vertex ", v, " is in element ", a.m_vertexTet[v], " with weights that are none");
    }
    for (std::size_t t = 0; t < a.m_triangles.size(); ++t)
        for (const int v : a.m_triangles[t])
            if (v < 0 || v >= static_cast<int>(header.m_embedded))
                reject("triangle ", t, " of the embedded surface has vertex ", v, ", not in [0, ", header.m_embedded,
                       ")");
}

void checkRestMatrix(const BakedHeader& header, const BakedArrays& a)
{
    if (!header.m_lowMemory) return;
    const int blocks = static_cast<int>(header.m_restBlocks);
    if (a.m_restRowStart.front() != 0 || a.m_restRowStart.back() != blocks)
        reject("the rows of A0 go from ", a.m_restRowStart.front(), " to ", a.m_restRowStart.back(), ", not from 0 to ",
               blocks);
    for (int k = 0; k < static_cast<int>(header.m_freeNodes); ++k)
    {
        const int begin = a.m_restRowStart[k], end = a.m_restRowStart[k + 1];
        if (begin < 0 || end <= begin || end > blocks) reject("row ", k, " of A0 goes from ", begin, " to ", end);
        for (int b = begin; b < end; ++b)
            if (a.m_restColumn[b] < (b == begin ? 0 : a.m_restColumn[b - 1] + 1) || a.m_restColumn[b] > k)
                reject("block ", b, " of A0 is in column ", a.m_restColumn[b]);
        if (a.m_restColumn[end - 1] != k) reject("row ", k, " of A0 has no diagonal");
    }
    checkPanels(a.m_restValues.data(), a.m_restValues.size());
}

void checkPanels(const float* panels, std::size_t count)
{
    constexpr std::uint32_t kExponent = 0x7F800000;  // all bits set: infinite or NaN
    std::uint32_t bad = 0;
    for (std::size_t k = 0; k < count; ++k)
    {
        std::uint32_t bits = 0;
        std::memcpy(&bits, panels + k, sizeof bits);
        bad |= static_cast<std::uint32_t>((bits & kExponent) == kExponent);
    }
    if (bad) reject("the factor has numbers that are not finite");
}

}  // namespace bullet_fem
