// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/topology_marks.h"

#include <hwy/cache_control.h>

#include <algorithm>

namespace bullet_fem
{
namespace
{

// A hash of the node indices of a part of the tetrahedra, independent of the address of the nodes' array. Four
// independent sums avoid the latency of dependent products. Tetrahedra are prefetched, because each covers some five
// cache lines of which only one is needed.
std::uint64_t markOf(const btSoftBody& body, int part)
{
    constexpr int kAhead = 48;
    constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15;  // odd, so that the product loses no bits
    const auto first = reinterpret_cast<std::uintptr_t>(&body.m_nodes[0]);
    const auto bound = [&body](int k)
    { return static_cast<int>(std::int64_t{body.m_tetras.size()} * k / TopologyMarks::kTurns); };
    const int end = bound(part + 1);
    std::uint64_t sums[4] = {};
    for (int e = bound(part); e < end; ++e)
    {
        const auto& ahead = body.m_tetras[std::min(e + kAhead, end - 1)].m_n;
        hwy::Prefetch(&ahead[0]);
        hwy::Prefetch(&ahead[3]);
        for (int a = 0; a < 4; ++a)
            sums[a] = kFactor * sums[a] + (reinterpret_cast<std::uintptr_t>(body.m_tetras[e].m_n[a]) - first);
    }
    std::uint64_t mark = 0;
    for (const std::uint64_t sum : sums) mark = kFactor * mark + sum;
    return mark;
}

}  // namespace

TopologyMarks::TopologyMarks(const btSoftBody& body) : m_tetras(&body.m_tetras[0])
{
    for (int k = 0; k < kTurns; ++k) m_marks[k] = markOf(body, k);
}

bool TopologyMarks::match(const btSoftBody& body) const
{
    for (int k = 0; k < kTurns; ++k)
        if (!partMatches(body, k)) return false;
    return true;
}

bool TopologyMarks::matchInTurn(const btSoftBody& body)
{
    if (body.m_bUpdateRtCst || &body.m_tetras[0] != m_tetras)
    {
        m_tetras = &body.m_tetras[0];
        return match(body);
    }
    m_turn = (m_turn + 1) % kTurns;
    return partMatches(body, m_turn);
}

bool TopologyMarks::partMatches(const btSoftBody& body, int part) const
{
    return markOf(body, part) == m_marks[part];
}

}  // namespace bullet_fem
