// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/batch/body_batches.h"

#include <algorithm>

#include "fem/batch/batch_arrays.h"

namespace bullet_fem
{
namespace
{

// Time of a batch of any size, in units of the time of a single body.
constexpr int kBatchCostInBodies = 7;

// Number of full batches of kBatchWidth, the last one possibly smaller, that minimizes the total time on so many
// threads; the remaining bodies are solved one by one.
int batchesSideBySide(int bodies, int threads)
{
    const auto time = [&](int batches)
    {
        const int longest = (batches + threads - 1) / threads * kBatchCostInBodies;
        const int work = batches * kBatchCostInBodies + std::max(0, bodies - batches * kBatchWidth);
        return std::max(longest, (work + threads - 1) / threads);
    };
    int best = 0;
    for (int batches = 1; batches <= (bodies + kBatchWidth - 1) / kBatchWidth; ++batches)
        if (time(batches) < time(best)) best = batches;
    return best;
}

}  // namespace

int BodyBatches::numberOf(const BodyModel* model)
{
    const auto found = std::find(m_models.begin(), m_models.end(), model);
    const auto number = static_cast<int>(found - m_models.begin());
    if (found != m_models.end()) return number;
    m_models.push_back(model);
    m_count.push_back(0);
    return number;
}

void BodyBatches::divide(const std::vector<const Body*>& bodies, int threads, bool together)
{
    m_models.clear();
    m_count.clear();
    m_modelOf.clear();
    for (const Body* body : bodies)
    {
        m_modelOf.push_back(numberOf(body->m_model.get()));
        ++m_count[m_modelOf.back()];
    }
    putInOrder();
    m_batches.clear();
    m_alone.clear();
    for (std::size_t m = 0; m < m_models.size(); ++m)
    {
        const Range all = {m_end[m] - m_count[m], m_end[m]};
        const bool lanes = together && canBeBatched(*m_models[m]);
        if (lanes && threads == 1)
            m_batches.push_back(all);
        else
            divideModel(all, lanes ? batchesSideBySide(m_count[m], threads) : 0);
    }
    m_batches.insert(m_batches.end(), m_alone.begin(), m_alone.end());
}

// Counting sort by model, stable.
void BodyBatches::putInOrder()
{
    m_end.clear();  // holds the beginning of each model for now
    int begin = 0;
    for (const int count : m_count)
    {
        m_end.push_back(begin);
        begin += count;
    }
    m_order.resize(m_modelOf.size());
    for (std::size_t k = 0; k < m_order.size(); ++k) m_order[m_end[m_modelOf[k]]++] = static_cast<int>(k);
}

void BodyBatches::divideModel(const Range& all, int sideBySide)
{
    int k = all.m_begin;
    for (int batch = 0; batch < sideBySide; ++batch, k = m_batches.back().m_end)
        m_batches.push_back({k, std::min(k + kBatchWidth, all.m_end)});
    for (; k < all.m_end; ++k) m_alone.push_back({k, k + 1});
}

}  // namespace bullet_fem
