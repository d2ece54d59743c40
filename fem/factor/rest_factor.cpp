// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/rest_factor.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "fem/factor/numeric_factor.h"

namespace bullet_fem
{

namespace
{

// Minimum ratio of s times mass to stiffness at the node with the least stiffness for its mass [-], so that no sliver
// decides. Node rotations, which differ slightly, mix stiffness into rigid motions, and so does rounding, 6e-8; this
// bound limits how much the preconditioner amplifies the mixing.
constexpr double kMinMass = 1e-6;  // [-]

double dampedMass(const RestShape& shape, const FactorInput& input)
{
    return 1 + input.m_step * shape.m_material.m_massDamping;
}

}  // namespace

BlockMatrix assembleA0(const RestShape& shape, const FactorInput& input)
{
    const double h = input.m_step, beta = shape.m_material.m_stiffnessDamping;
    BlockMatrix A0 = assembleRestStiffness(shape);
    for (Mat3& block : A0.m_block) block *= h * h + h * beta;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < A0.nodeCount(); ++i) least = std::min(least, trace(A0.at(i, i)) / 3 / input.m_mass[i]);
    const double scale = std::max(dampedMass(shape, input), kMinMass * least);
    for (int i = 0; i < A0.nodeCount(); ++i) A0.at(i, i) += Mat3::diagonal(scale * input.m_mass[i]);
    return A0;
}

// If s comes from kMinMass, the minimum of diagonal entry over mass is s + s / kMinMass.
double massScale(const BodyModel& model)
{
    const FactorInput& input = model.factorInput();
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < model.nodeCount(); ++i) least = std::min(least, model.factor().diagonal(i) / input.m_mass[i]);
    return std::max(dampedMass(model.shape(), input), least * kMinMass / (1 + kMinMass));
}

SparsePattern blockPattern(const BlockMatrix& A, const std::vector<int>& nodes, const std::vector<int>& position)
{
    SparsePattern pattern;
    pattern.m_size = static_cast<int>(nodes.size());
    pattern.m_columnStart.push_back(0);
    for (int c = 0; c < pattern.m_size; ++c)
    {
        for (int k = A.m_rowStart[nodes[c]]; k < A.m_rowStart[nodes[c] + 1]; ++k)
            if (position[A.m_column[k]] >= c) pattern.m_rowIndex.push_back(position[A.m_column[k]]);
        pattern.m_columnStart.push_back(static_cast<int>(pattern.m_rowIndex.size()));
    }
    return pattern;
}

namespace
{

bool isBeyondLimit(const FactorInput& input, std::size_t bytes)
{
    return input.m_maxBytes > 0 && bytes > input.m_maxBytes;
}

FactorPath choosePath(const FactorInput& input, std::size_t fullBytes)
{
    const bool low = input.m_choice == FactorChoice::lowMemory ||
                     (input.m_choice == FactorChoice::lowMemoryBeyond && isBeyondLimit(input, fullBytes));
    return low ? FactorPath::lowMemory : FactorPath::full;
}

void refuseBeyondLimit(const FactorInput& input, const SupernodeTree& tree, NodeEntry entry)
{
    const std::size_t bytes = PackedFactor::bytesFor(tree, entry);
    if (!isBeyondLimit(input, bytes)) return;
    std::string remedy = "; raise the limit";
    if (entry == NodeEntry::block)
        remedy += ", choose the low-memory path (" + std::to_string(PackedFactor::bytesFor(tree, NodeEntry::number)) +
                  " bytes)";
    throw std::runtime_error("the factor of " + std::to_string(tree.m_nodeCount) + " free nodes would take " +
                             std::to_string(bytes) + " bytes, more than the limit of " +
                             std::to_string(input.m_maxBytes) + remedy + " or make a coarser mesh");
}

}  // namespace

RestFactor::RestFactor(const RestShape& shape, const FactorInput& input, FactorReport& report)
{
    const BlockMatrix A0 = assembleA0(shape, input);
    const int n = shape.m_mesh.nodeCount();
    std::vector<int> freeNodes;
    m_position.assign(n, -1);
    m_diagonal.resize(n);
    for (int i = 0; i < n; ++i)
    {
        m_diagonal[i] = trace(A0.at(i, i)) / 3;
        if (input.m_fixed[i]) continue;
        m_position[i] = static_cast<int>(freeNodes.size());
        freeNodes.push_back(i);
    }
    report.m_backend = orderingBackend();
    if (freeNodes.empty()) return;

    const SparsePattern pattern = blockPattern(A0, freeNodes, m_position);
    auto [method, order] = fillReducingOrder(pattern);
    const SupernodeTree tree = buildSupernodeTree(pattern, order);
    for (std::size_t k = 0; k < order.size(); ++k)
    {
        order[k] = freeNodes[order[k]];
        m_position[order[k]] = static_cast<int>(k);
    }
    report.m_fullBytes = PackedFactor::bytesFor(tree);
    report.m_path = choosePath(input, report.m_fullBytes);
    const NodeEntry entry = report.m_path == FactorPath::full ? NodeEntry::block : NodeEntry::number;
    refuseBeyondLimit(input, tree, entry);
    m_lower = PackedFactor(tree, entry);
    factorSupernodes(
        A0, order, tree, [this](int s, const double* S, const double* M) { m_lower.pack(s, S, M); }, entry);
    if (report.m_path == FactorPath::lowMemory) m_rest = RestMatrix(A0, order, m_position);
    report.m_ordering = method;
    report.m_entries = tree.m_entries;
    report.m_supernodes = static_cast<int>(tree.m_supernodes.size());
    report.m_bytes = m_lower.byteCount();
}

}  // namespace bullet_fem
