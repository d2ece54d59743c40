// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/factor/block_matrix.h"
#include "fem/factor/fill_order.h"
#include "fem/factor/packed_factor.h"
#include "fem/factor/rest_matrix.h"

namespace bullet_fem
{

/// A0 = s M + (h^2 + h beta) K over all nodes [kg]. s is 1 + h alpha, and more where K is so much larger that single
/// precision would lose the masses: what the factor makes of rigid motions is then smaller by that.
BlockMatrix assembleA0(const RestShape& shape, const FactorInput& input);

/// s of a model's A0 [-].
double massScale(const BodyModel& model);

/// The lower triangle of A's pattern over some nodes, ascending; position is a node's place among them, or -1.
SparsePattern blockPattern(const BlockMatrix& A, const std::vector<int>& nodes, const std::vector<int>& position);

/// The factor of A0 over the free nodes, and where every node stands in it. On the low-memory path it is that of
/// (1 + h alpha) M + (h^2 + h beta) (lambda + 4 mu) / 3 L, L the scalar Laplacian, for each of the three directions: of
/// every block of A0 a third of its trace. No other scale of L needs fewer iterations, see docs/performance.md.
class RestFactor
{
public:
    /// Throws std::runtime_error if A0 cannot be factored. Writes backend, ordering and fill to the report.
    RestFactor(const RestShape& shape, const FactorInput& input, FactorReport& report);

    /// One that was made before, of its parts. They must fit together.
    RestFactor(std::vector<int> position, std::vector<double> diagonal, PackedFactor lower, RestMatrix rest)
        : m_position(std::move(position)),
          m_diagonal(std::move(diagonal)),
          m_lower(std::move(lower)),
          m_rest(std::move(rest))
    {
    }

    const PackedFactor& lower() const { return m_lower; }
    /// A0 itself over the free nodes on the low-memory path, where it cannot be had from the factor; else empty.
    const RestMatrix& rest() const { return m_rest; }
    /// Block row of a node in the factor's order; -1 for nodes that were fixed when it was built.
    int position(int node) const { return m_position[node]; }
    /// Mean diagonal entry of A0 at a node [kg]: all there is to precondition a node that is not in the factor.
    double diagonal(int node) const { return m_diagonal[node]; }
    /// Nodes that the factor holds.
    int freeNodeCount() const { return m_lower.size() / 3; }

private:
    std::vector<int> m_position;
    std::vector<double> m_diagonal;
    PackedFactor m_lower;
    RestMatrix m_rest;
};

}  // namespace bullet_fem
