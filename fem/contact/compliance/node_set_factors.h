// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "fem/contact/compliance/envelope_factor.h"

namespace bullet_fem
{

class ComplianceCache;

/// Cholesky factors of the blocks of A0^-1 between sets of nodes of one model. They are constants, because the columns
/// are, and do not depend on earlier requests. The latest ones are kept within a budget. Allocates for a new set.
class NodeSetFactors
{
public:
    static constexpr std::size_t kBudget = 16'000'000;  ///< for all kept sets: 15 sets of 121 nodes [B]

    /// The factor for these nodes in this order, three rows per node. Valid as long as the pointer is held. The nodes
    /// must be among those of the cache; requests their columns if the set is new.
    std::shared_ptr<const EnvelopeFactor> of(const std::vector<int>& nodes, ComplianceCache& columns);

private:
    struct Kept
    {
        std::vector<int> m_nodes;
        std::shared_ptr<const EnvelopeFactor> m_factor;
    };
    void makeRoom(std::size_t bytes);

    std::vector<Kept> m_kept;  // least recently used first
};

}  // namespace bullet_fem
