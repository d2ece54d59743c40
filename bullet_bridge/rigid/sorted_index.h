// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace bullet_fem
{

/// Positions in an array by key, as a sorted list: unlike a hash map it allocates only when it is longer than ever.
template <class Key>
class SortedIndex
{
public:
    void clear() { m_entries.clear(); }

    /// Adds a key at a position.
    void add(Key key, std::size_t position)
    {
        const std::pair<Key, int> entry(key, static_cast<int>(position));
        m_entries.insert(std::upper_bound(m_entries.begin(), m_entries.end(), entry), entry);
    }

    /// Replaces all keys by keyOf(0), ..., keyOf(count - 1) at these positions.
    template <class KeyOf>
    void assign(std::size_t count, const KeyOf& keyOf)
    {
        m_entries.clear();
        for (std::size_t k = 0; k < count; ++k) m_entries.emplace_back(keyOf(k), static_cast<int>(k));
        std::sort(m_entries.begin(), m_entries.end());
    }

    /// The smallest position with a key; -1 if there is none.
    int find(Key key) const
    {
        const auto at = std::lower_bound(m_entries.begin(), m_entries.end(), std::pair<Key, int>(key, 0));
        return at != m_entries.end() && at->first == key ? at->second : -1;
    }

private:
    std::vector<std::pair<Key, int>> m_entries;
};

}  // namespace bullet_fem
