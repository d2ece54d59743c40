// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_fem/fem/step/batch_memory.h"
#include "fem/step/batch_arrays.h"

namespace bullet_fem
{

/// Lanes, and the model that they fit, which is known again though its address may be that of another by then.
struct BatchMemory::Lanes
{
    std::weak_ptr<const BodyModel> m_model;
    std::unique_ptr<BodyLanes> m_lanes;
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

    BodyLanes& lanes() { return *m_loan.m_lanes; }

private:
    bool takeFree(const std::shared_ptr<const BodyModel>& model);

    BatchMemory& m_memory;
    BatchMemory::Lanes m_loan;
};

}  // namespace bullet_fem
