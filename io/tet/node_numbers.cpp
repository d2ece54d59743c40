// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/node_numbers.h"

#include <algorithm>

#include "fem/common/message.h"
#include "io/tet/mesh_scanner.h"

namespace bullet_fem
{
namespace
{

[[noreturn]] void failTwice(std::uint64_t number, const MeshScanner& scanner)
{
    scanner.fail(message("of the nodes up to here two have the number ", number, "; each must have its own"));
}

}  // namespace

NodeNumbers::NodeNumbers(const std::vector<std::uint64_t>& numbers, const MeshScanner& scanner)
{
    if (numbers.empty()) return;
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    m_first = *least;
    const std::uint64_t range = *most - m_first;
    if (range / 4 <= numbers.size())
    {
        m_table.assign(static_cast<std::size_t>(range) + 1, -1);
        for (std::size_t i = 0; i < numbers.size(); ++i)
        {
            int& place = m_table[static_cast<std::size_t>(numbers[i] - m_first)];
            if (place >= 0) failTwice(numbers[i], scanner);
            place = static_cast<int>(i);
        }
        return;
    }
    m_sorted.reserve(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) m_sorted.emplace_back(numbers[i], static_cast<int>(i));
    std::sort(m_sorted.begin(), m_sorted.end());
    for (std::size_t i = 1; i < m_sorted.size(); ++i)
        if (m_sorted[i].first == m_sorted[i - 1].first) failTwice(m_sorted[i].first, scanner);
}

int NodeNumbers::find(std::uint64_t number) const
{
    if (!m_sorted.empty())
    {
        const auto at = std::lower_bound(m_sorted.begin(), m_sorted.end(), std::make_pair(number, -1));
        return at != m_sorted.end() && at->first == number ? at->second : -1;
    }
    const std::uint64_t place = number - m_first;  // wraps around below the first
    return place < m_table.size() ? m_table[static_cast<std::size_t>(place)] : -1;
}

}  // namespace bullet_fem
