// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body_batches.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

// Several batches a thread, so that none has to wait long for the last one; beyond some bodies a batch gains nothing.
constexpr int kBatchesOfThread = 3, kMostBodies = 16;

int bodiesOfBatch(int bodies, int threads, bool together)
{
    if (!together) return 1;
    return threads == 1 ? std::max(bodies, 1) : std::clamp(bodies / (kBatchesOfThread * threads), 1, kMostBodies);
}

}  // namespace

int BodyBatches::numberOf(const BodyModel* model)
{
    const auto found = std::find(m_models.begin(), m_models.end(), model);
    const auto number = static_cast<int>(found - m_models.begin());
    if (found != m_models.end()) return number;
    m_models.push_back(model);
    m_end.push_back(0);
    return number;
}

void BodyBatches::divide(const std::vector<const Body*>& bodies, int threads, bool together)
{
    m_models.clear();
    m_end.clear();
    m_batches.clear();
    m_modelOf.clear();
    for (const Body* body : bodies)
    {
        m_modelOf.push_back(numberOf(body->m_model.get()));
        ++m_end[m_modelOf.back()];
    }
    const int most = bodiesOfBatch(static_cast<int>(bodies.size()), threads, together);
    int begin = 0;
    for (int& end : m_end)  // how many bodies have the model; then where they begin
    {
        const int count = end;
        for (int k = 0; k < count; k += most) m_batches.push_back({begin + k, begin + std::min(k + most, count)});
        end = begin;
        begin += count;
    }
    m_order.resize(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) m_order[m_end[m_modelOf[k]]++] = static_cast<int>(k);
}

}  // namespace bullet_fem
