// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "fem/contact/envelope_factor.h"

namespace bullet_fem
{

class ComplianceCache;

/// Cholesky factors of the blocks of A0^-1 between sets of nodes of one model: constants, as the columns are that they
/// are made of, whoever asked for them before. The latest ones are kept within a budget. Allocates where a set is new.
class NodeSetFactors
{
public:
    static constexpr std::size_t kBudget = 16'000'000;  ///< for all that are kept: 15 sets of 121 nodes [B]

    /// The factor for these nodes in this order, three rows a node. Valid for as long as it is held. The nodes must be
    /// among those that the cache was made for; requests their columns of it where the set is new.
    std::shared_ptr<const EnvelopeFactor> of(const std::vector<int>& nodes, ComplianceCache& columns);

private:
    struct Kept
    {
        std::vector<int> m_nodes;
        std::shared_ptr<const EnvelopeFactor> m_factor;
    };
    void makeRoom(std::size_t bytes);

    std::vector<Kept> m_kept;  // that asked for last comes last
};

}  // namespace bullet_fem
