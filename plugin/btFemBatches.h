// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "plugin/btFemBodyRegistry.h"

/// Bodies that one thread steps together: m_begin ... m_end - 1 of btFemBatches::entries().
struct btFemBatch
{
    int m_begin, m_end;
};

/// The bodies of a step, put in order so that those that share their model stand side by side, and divided among
/// threads. Which bodies are together has no effect on the bits of what becomes of them. Allocates while it grows.
class btFemBatches
{
public:
    /// `together`: false makes every body a batch of its own.
    void divide(const std::vector<btFemEntry*>& entries, int threads, bool together);

    const std::vector<btFemEntry*>& entries() const { return m_entries; }
    const std::vector<btFemBatch>& batches() const { return m_batches; }

private:
    int modelOf(const btFemEntry& entry);

    std::vector<btFemEntry*> m_entries;
    std::vector<btFemBatch> m_batches;
    std::vector<const bullet_fem::BodyModel*> m_models;  // each once, in the order of the first bodies that have them
    std::vector<int> m_modelOf;                          // per body
    std::vector<int> m_end;                              // per model, among m_entries
};
