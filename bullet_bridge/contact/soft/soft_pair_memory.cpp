// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/soft_pair_memory.h"

#include <algorithm>
#include <numeric>

namespace bullet_fem
{

void SoftPairMemory::beginStep()
{
    m_lastComplete.swap(m_nextComplete);
    std::sort(m_lastComplete.begin(), m_lastComplete.end());
    m_nextComplete.clear();
    takeOverContacts();
    m_next.clear();
    m_nextOrigins.clear();
}

// The contacts are sorted already unless a pair was thinned.
void SoftPairMemory::takeOverContacts()
{
    if (std::is_sorted(m_nextOrigins.begin(), m_nextOrigins.end()))
    {
        m_last.swap(m_next);
        m_lastOrigins.swap(m_nextOrigins);
        m_next.reserve(m_last.capacity());  // keeps capacity, as a copy would
        m_nextOrigins.reserve(m_lastOrigins.capacity());
        return;
    }
    m_order.resize(m_next.size());
    std::iota(m_order.begin(), m_order.end(), 0);
    std::sort(m_order.begin(), m_order.end(),
              [this](int a, int b)
              { return m_nextOrigins[a] < m_nextOrigins[b] || (!(m_nextOrigins[b] < m_nextOrigins[a]) && a < b); });
    m_last.clear();
    m_lastOrigins.clear();
    for (int k : m_order)
    {
        m_last.push_back(m_next[k]);
        m_lastOrigins.push_back(m_nextOrigins[k]);
    }
}

void SoftPairMemory::remember(const Contacts& contacts, const std::vector<SoftPairIds>& completePairs)
{
    m_nextComplete.insert(m_nextComplete.end(), completePairs.begin(), completePairs.end());
    m_next.insert(m_next.end(), contacts.m_contacts, contacts.m_contacts + contacts.m_count);
    m_nextOrigins.insert(m_nextOrigins.end(), contacts.m_origins, contacts.m_origins + contacts.m_count);
}

void SoftPairMemory::restore(const Kept& kept)
{
    m_next.assign(kept.m_contacts.begin(), kept.m_contacts.end());
    m_nextOrigins.assign(kept.m_origins.begin(), kept.m_origins.end());
    m_nextComplete.assign(kept.m_completePairs.begin(), kept.m_completePairs.end());
}

bool SoftPairMemory::isComplete(const SoftPairIds& pair) const
{
    return std::binary_search(m_lastComplete.begin(), m_lastComplete.end(), pair);
}

SoftPairMemory::Last SoftPairMemory::lastOf(int firstId, int secondId) const
{
    SoftPairOrigin from;
    from.m_firstId = firstId;
    from.m_secondId = secondId;
    from.m_feature = from.m_otherFeature = -1;
    const auto begin = std::lower_bound(m_lastOrigins.begin(), m_lastOrigins.end(), from);
    const auto end = std::find_if_not(begin, m_lastOrigins.end(),
                                      [&](const SoftPairOrigin& origin) { return origin.isOfPair(firstId, secondId); });
    const auto first = begin - m_lastOrigins.begin();
    return {m_last.data() + first, m_lastOrigins.data() + first, static_cast<std::size_t>(end - begin)};
}

}  // namespace bullet_fem
