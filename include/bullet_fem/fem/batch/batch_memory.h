// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// What bodies that share a model work in while they are solved side by side, sixteen at a time: some 3 KB an element,
/// once for every thread that solves so at the same time. Made when a model first needs it, kept as long as there is
/// the model, and used again. May be shared by threads.
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
