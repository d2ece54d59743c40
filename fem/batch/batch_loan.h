// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_fem/fem/batch/batch_memory.h"
#include "fem/batch/batch_arrays.h"

namespace bullet_fem
{

/// Batch arrays and their model. The weak pointer identifies the model even if its address has been reused.
struct BatchMemory::Arrays
{
    std::weak_ptr<const BodyModel> m_model;
    std::unique_ptr<BatchArrays> m_arrays;
};

/// Batch arrays borrowed from a BatchMemory, returned by the destructor.
class BatchLoan
{
public:
    /// Requires canBeBatched(*model). Allocates if the memory has no free arrays of this model.
    BatchLoan(BatchMemory& memory, const std::shared_ptr<const BodyModel>& model);
    ~BatchLoan();
    BatchLoan(const BatchLoan&) = delete;
    BatchLoan& operator=(const BatchLoan&) = delete;

    BatchArrays& arrays() { return *m_loan.m_arrays; }

private:
    bool takeFree(const std::shared_ptr<const BodyModel>& model);

    BatchMemory& m_memory;
    BatchMemory::Arrays m_loan;
};

}  // namespace bullet_fem
