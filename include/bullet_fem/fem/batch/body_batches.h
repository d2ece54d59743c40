// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{

/// Sorts bodies by model and divides them into batches, each solved by one thread, side by side as far as possible. The
/// division has no effect on the bits of the results. Allocates while it grows.
class BULLETFEM_API BodyBatches
{
public:
    /// Divides `bodies`, each listed once and not null, for a number of `threads`, >= 1. `together` false: every body
    /// is a batch of its own.
    void divide(const std::vector<const Body*>& bodies, int threads, bool together);

    /// Indices into `bodies`, sorted by model.
    const std::vector<int>& order() const { return m_order; }

    /// Ranges of order(), each of one model; the long ones first.
    const std::vector<Range>& batches() const { return m_batches; }

private:
    int numberOf(const BodyModel* model);
    void putInOrder();
    void divideModel(const Range& all, int sideBySide);

    std::vector<int> m_order;
    std::vector<Range> m_batches, m_alone;   // m_alone: batches of a single body
    std::vector<const BodyModel*> m_models;  // each once, ordered by first body
    std::vector<int> m_modelOf;              // per body
    std::vector<int> m_count, m_end;         // per model: number of its bodies, and their end in m_order
};

}  // namespace bullet_fem
