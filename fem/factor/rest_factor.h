// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/factor/block_matrix.h"
#include "fem/factor/fill_order.h"
#include "fem/factor/packed_factor.h"

namespace bullet_fem
{

/// A0 = s M + (h^2 + h beta) K over all nodes [kg]. s is 1 + h alpha, or more if K is so large that single precision
/// would lose the masses: the factor's rigid motions are then smaller in this ratio.
BlockMatrix assembleA0(const RestShape& shape, const FactorInput& input);

/// Mass scale s of a model's A0 [-].
double massScale(const BodyModel& model);

/// The lower triangle of A's pattern over a subset of nodes, ascending; `position` is a node's index in it, or -1.
SparsePattern blockPattern(const BlockMatrix& A, const std::vector<int>& nodes, const std::vector<int>& position);

/// The factor of A0 over the free nodes, and the position of every node in it. On the low-memory path it is that of (1
/// + h alpha) M + (h^2 + h beta) (lambda + 4 mu) / 3 L, L the scalar Laplacian, for each of the three directions: a
/// third of the trace of every block of A0. No other scale of L needs fewer iterations (docs/performance.md).
class RestFactor
{
public:
    /// Factors A0. Writes backend, ordering and fill to the report. Throws std::runtime_error if A0 cannot be factored.
    /// Allocates.
    RestFactor(const RestShape& shape, const FactorInput& input, FactorReport& report);

    /// A factor assembled from consistent parts.
    RestFactor(std::vector<int> position, std::vector<double> diagonal, PackedFactor lower, RestMatrix rest)
        : m_position(std::move(position)),
          m_diagonal(std::move(diagonal)),
          m_lower(std::move(lower)),
          m_rest(std::move(rest))
    {
    }

    const PackedFactor& lower() const { return m_lower; }
    /// A0 over the free nodes on the low-memory path, whose factor does not represent it; else empty.
    const RestMatrix& rest() const { return m_rest; }
    /// Block row of a node in the factor's order; -1 for nodes that were fixed when it was built.
    int position(int node) const { return m_position[node]; }
    /// Mean diagonal entry of A0 at a node [kg], the preconditioner of nodes that are not in the factor.
    double diagonal(int node) const { return m_diagonal[node]; }
    /// Number of nodes in the factor.
    int freeNodeCount() const { return m_lower.size() / 3; }

private:
    std::vector<int> m_position;
    std::vector<double> m_diagonal;
    PackedFactor m_lower;
    RestMatrix m_rest;
};

}  // namespace bullet_fem
