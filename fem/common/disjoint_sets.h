// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace bullet_fem
{

/// Union-find over [0, n); the lowest member represents each set.
class DisjointSets
{
public:
    explicit DisjointSets(std::size_t count) : m_parent(count) { std::iota(m_parent.begin(), m_parent.end(), 0); }

    int root(int i)
    {
        while (m_parent[i] != i) i = m_parent[i] = m_parent[m_parent[i]];
        return i;
    }

    void join(int i, int j)
    {
        const int r = root(i), s = root(j);
        m_parent[std::max(r, s)] = std::min(r, s);
    }

private:
    std::vector<int> m_parent;
};

}  // namespace bullet_fem
