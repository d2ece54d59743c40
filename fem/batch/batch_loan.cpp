// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/batch/batch_loan.h"

#include <algorithm>
#include <utility>

namespace bullet_fem
{

BatchMemory::BatchMemory() = default;
BatchMemory::~BatchMemory() = default;

BatchLoan::BatchLoan(BatchMemory& memory, const std::shared_ptr<const BodyModel>& model) : m_memory(memory)
{
    if (!takeFree(model)) m_loan = {model, std::make_unique<BatchArrays>(*model)};
    const std::lock_guard<std::mutex> lock(memory.m_mutex);
    // So that the destructor's push_back cannot fail.
    memory.m_free.reserve(memory.m_free.size() + memory.m_lent + 1);
    ++memory.m_lent;
}

bool BatchLoan::takeFree(const std::shared_ptr<const BodyModel>& model)
{
    const std::lock_guard<std::mutex> lock(m_memory.m_mutex);
    std::vector<BatchMemory::Arrays>& free = m_memory.m_free;
    const auto isOfNoModel = [](const BatchMemory::Arrays& one) { return one.m_model.expired(); };
    free.erase(std::remove_if(free.begin(), free.end(), isOfNoModel), free.end());
    const auto fits = [&](const BatchMemory::Arrays& one) { return one.m_model.lock() == model; };
    const auto found = std::find_if(free.begin(), free.end(), fits);
    if (found == free.end()) return false;
    m_loan = std::move(*found);
    free.erase(found);
    return true;
}

BatchLoan::~BatchLoan()
{
    const std::lock_guard<std::mutex> lock(m_memory.m_mutex);
    --m_memory.m_lent;
    m_memory.m_free.push_back(std::move(m_loan));
}

}  // namespace bullet_fem
