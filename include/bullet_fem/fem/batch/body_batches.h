// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{

/// Bodies put in order so that those that share their model stand together, and divided into batches: what one thread
/// solves, side by side as far as it can. Which bodies are together has no effect on the bits of what becomes of them.
/// Allocates while it grows.
class BULLETFEM_API BodyBatches
{
public:
    /// `together`: false makes every body a batch of its own. Every body once, none null.
    void divide(const std::vector<const Body*>& bodies, int threads, bool together);

    /// Indices of the bodies.
    const std::vector<int>& order() const { return m_order; }

    /// Ranges of order(), of one model each; the long ones first.
    const std::vector<Range>& batches() const { return m_batches; }

private:
    int numberOf(const BodyModel* model);
    void putInOrder();
    void divideModel(const Range& all, int sideBySide);

    std::vector<int> m_order;
    std::vector<Range> m_batches, m_alone;   // those of one body
    std::vector<const BodyModel*> m_models;  // each once, in the order of the first bodies that have them
    std::vector<int> m_modelOf;              // per body
    std::vector<int> m_count, m_end;         // per model: its bodies, and where they end in m_order
};

}  // namespace bullet_fem
