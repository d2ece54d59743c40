// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Scratch memory for solving bodies of one model side by side, sixteen at a time: some 3 KB per element and per thread
/// that does so at once. Allocated when a model first needs it, kept as long as the model exists, and reused. May be
/// shared by threads.
class BULLETFEM_API BatchMemory
{
public:
    BatchMemory();
    ~BatchMemory();
    BatchMemory(const BatchMemory&) = delete;
    BatchMemory& operator=(const BatchMemory&) = delete;

private:
    friend class BatchLoan;
    struct Arrays;

    std::mutex m_mutex;
    std::vector<Arrays> m_free;
    std::size_t m_lent = 0;
};

}  // namespace bullet_fem
