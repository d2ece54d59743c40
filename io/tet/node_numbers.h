// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace bullet_fem
{

class MeshScanner;

/// From a file's own numbers of nodes, any 64-bit ones, to their places in the file.
class NodeNumbers
{
public:
    /// Fails at the scanner's place if a number is given twice.
    NodeNumbers(const std::vector<std::uint64_t>& numbers, const MeshScanner& scanner);

    /// The place of a node, or -1.
    int find(std::uint64_t number) const;

private:
    std::uint64_t m_first = 0;
    std::vector<int> m_table;  // by number - m_first, -1 for none; empty if the numbers are too far apart
    std::vector<std::pair<std::uint64_t, int>> m_sorted;  // used then; a hash could be made to collide
};

}  // namespace bullet_fem
