// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/common/aligned_array.h"
#include "fem/contact/compliance/column_solver.h"
#include "fem/contact/compliance/node_set_factors.h"

namespace bullet_fem
{

/// Cache of the constant 3x3 blocks of A0^-1 without rest modes between nodes of one model that may be in contact
/// [1/kg]. A node's column is solved at its first request and kept while there is room: within the budget, or as many
/// as one request has needed. Bodies of one model may share a cache on one thread. On the low-memory path, whose factor
/// is not that of A0, a column is iterated to some 1e-3 of sqrt((A0^-1)_ii (A0^-1)_jj); such columns cost some ten to
/// thirty times those of the full factor. request() allocates at its first call, for more nodes than ever before, and
/// for more useful threads than ever before.
class ComplianceCache
{
public:
    static constexpr std::size_t kBudget = 16'000'000;  ///< for all columns of a body of 4,000 tets [B]

    /// A cache for the nodes of the mesh's surface.
    explicit ComplianceCache(std::shared_ptr<const BodyModel> model, std::size_t budget = kBudget);

    /// A cache for these distinct nodes.
    ComplianceCache(std::shared_ptr<const BodyModel> model, std::vector<int> nodes, std::size_t budget = kBudget);

    ComplianceCache(const ComplianceCache&) = delete;
    ComplianceCache& operator=(const ComplianceCache&) = delete;

    const BodyModel& model() const { return *m_model; }

    /// True if the node is one of the cache's.
    bool serves(int node) const { return m_placeOfNode[node] >= 0; }

    /// Makes the columns of these nodes of the cache available until the next request; uses up to four of these threads
    /// (if not null). Repeated nodes are allowed.
    void request(const std::vector<int>& nodes, const Threads* threads = nullptr);

    /// The block between nodes i and j of the cache; the column of j must have been requested. Zero if either was
    /// fixed when the factor was built; the caller adds the inverse diagonal if that node is free now.
    Mat3 block(int i, int j) const;

    /// The data of block(), for kernels: the blocks of all nodes i of the cache, nine values each, row by
    /// row; that of i begins at offset(i).
    const float* column(int j) const { return m_columns[m_slotOfNode[j]].get(); }
    int offset(int i) const { return 9 * m_placeOfNode[i]; }

    /// See NodeSetFactors; requests the columns of these nodes if the set is new.
    std::shared_ptr<const EnvelopeFactor> factorOf(const std::vector<int>& nodes)
    {
        return m_setFactors.of(nodes, *this);
    }

    /// True if a request may drop columns of an earlier one.
    bool forgets() const { return m_columns.size() < m_nodes.size(); }

    /// Columns solved so far.
    long solvedColumns() const { return m_solvedColumns; }

private:
    void makeRoom(std::size_t columns);
    int claimSlot();
    void solveNewColumns(const Threads* threads);

    std::shared_ptr<const BodyModel> m_model;
    std::size_t m_budget;            // [B]
    std::vector<int> m_nodes;        // nodes of the cache
    std::vector<int> m_placeOfNode;  // per node: its index in m_nodes, or -1
    std::vector<int> m_slotOfNode;   // per node, or -1
    std::vector<int> m_nodeOfSlot;
    std::vector<unsigned long> m_lastUse;  // per slot: number of the request that last named it
    std::vector<AlignedFloats> m_columns;
    std::vector<int> m_newNodes;
    std::vector<ColumnSolver::Column> m_newColumns;
    std::vector<std::unique_ptr<ColumnSolver>> m_solvers;  // one per useful thread
    NodeSetFactors m_setFactors;
    unsigned long m_requestCount = 0;
    long m_solvedColumns = 0;
};

}  // namespace bullet_fem
