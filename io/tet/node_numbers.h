// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace bullet_fem
{

class MeshScanner;

/// Map from a file's node numbers, arbitrary 64-bit integers, to their positions in the file.
class NodeNumbers
{
public:
    /// Fails at the scanner's position if a number occurs twice.
    NodeNumbers(const std::vector<std::uint64_t>& numbers, const MeshScanner& scanner);

    /// The index of a node, or -1.
    int find(std::uint64_t number) const;

private:
    std::uint64_t m_first = 0;
    std::vector<int> m_table;  // by number - m_first, -1 for none; empty if the numbers are too far apart
    // used in that case; a hash table could be attacked by collisions
    std::vector<std::pair<std::uint64_t, int>> m_sorted;
};

}  // namespace bullet_fem
