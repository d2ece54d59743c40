// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/beam/setup_stages.h"

#include "benchmarks/figures.h"
#include "fem/factor/numeric_factor.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

std::vector<int> freeNodesOf(const FactorInput& input)
{
    std::vector<int> nodes;
    for (std::size_t i = 0; i < input.m_fixed.size(); ++i)
        if (!input.m_fixed[i]) nodes.push_back(static_cast<int>(i));
    return nodes;
}

std::vector<int> placesOf(const std::vector<int>& nodes, int nodeCount)
{
    std::vector<int> position(nodeCount, -1);
    for (std::size_t k = 0; k < nodes.size(); ++k) position[nodes[k]] = static_cast<int>(k);
    return position;
}

/// Operations of the Cholesky factorization [flop]: sum over the columns of all supernodes of (rows at and below the
/// column)^2. Each entry of the lower half that a column updates takes one multiplication and one addition.
double choleskyOperations(const SupernodeTree& tree, NodeEntry entry)
{
    double sum = 0;
    for (const Supernode& s : tree.m_supernodes)
    {
        const double c = double(rowsOfNode(entry)) * s.m_columns, r = double(rowsOfNode(entry)) * s.m_rows;
        sum += c * c * c / 3 + c * c * r + c * r * r;
    }
    return sum;
}

/// Entries of the lower half, diagonal included, of a symmetric matrix with these 3x3 blocks.
double lowerEntries(const SparsePattern& pattern)
{
    return 9.0 * double(pattern.m_rowIndex.size()) - 3.0 * pattern.m_size;
}

}  // namespace

SetupStages measureSetup(const BodyModel& model)
{
    SetupStages stages;
    Stopwatch watch;
    const BlockMatrix A0 = assembleA0(model.shape(), model.factorInput());
    const std::vector<int> nodes = freeNodesOf(model.factorInput());
    const SparsePattern pattern = blockPattern(A0, nodes, placesOf(nodes, A0.nodeCount()));
    stages.m_assembly = watch.seconds();

    watch = Stopwatch();
    auto [method, order] = fillReducingOrder(pattern);
    stages.m_ordering = method;
    stages.m_order = watch.seconds();

    watch = Stopwatch();
    const SupernodeTree tree = buildSupernodeTree(pattern, order);
    for (int& node : order) node = nodes[node];
    stages.m_tree = watch.seconds();

    watch = Stopwatch();
    const NodeEntry entry = model.factor().lower().entry();
    PackedFactor factor(tree, entry);
    factorSupernodes(
        A0, order, tree, [&factor](int s, const double* S, const double* M) { factor.pack(s, S, M); }, entry);
    stages.m_numeric = watch.seconds();
    stages.m_operations = choleskyOperations(tree, entry);
    stages.m_fill = static_cast<double>(tree.m_entries) / lowerEntries(pattern);
    return stages;
}

}  // namespace bullet_fem
