// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_fem/fem/batch/batch_memory.h"
#include "fem/batch/batch_arrays.h"

namespace bullet_fem
{

/// Lanes, and the model that they fit, which is known again though its address may be that of another by then.
struct BatchMemory::Arrays
{
    std::weak_ptr<const BodyModel> m_model;
    std::unique_ptr<BatchArrays> m_arrays;
};

/// Lanes for bodies of a model, which go back to their memory in the end.
class BatchLoan
{
public:
    /// The model can be side by side. Allocates where the memory has no lanes of its left.
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
