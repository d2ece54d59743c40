// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/bisected_tets.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bullet_fem
{
namespace
{

constexpr std::array<std::array<int, 3>, 6> kAxisOrders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

std::uint64_t edgeKey(int a, int b)
{
    const auto [low, high] = std::minmax({a, b});
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
}

double signedVolume(const std::array<Vec3, 4>& x)
{
    return dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
}

}  // namespace

void BisectedTets::addCube(int cube, bool whole)
{
    m_added.push_back(cube);
    const std::array<int, 3> low = {cube % m_cubes[0], cube / m_cubes[0] % m_cubes[1], cube / m_cubes[0] / m_cubes[1]};
    for (const std::array<int, 3>& order : kAxisOrders)
    {
        std::array<int, 3> place;
        for (int a = 0; a < 3; ++a) place[a] = low[a] + (low[a] & 1);  // the corner with even coordinates
        BisectedTet tet;
        tet.m_whole = whole;
        tet.m_corners[0] = nodeAt(place);
        for (int n = 0; n < 3; ++n)
        {
            const int axis = order[n];
            place[axis] = low[axis] + 1 - (low[axis] & 1);
            tet.m_corners[n + 1] = nodeAt(place);
        }
        m_tets.push_back(tet);
    }
}

int BisectedTets::firstOf(const std::array<int, 3>& place) const
{
    const int cube = (place[2] * m_cubes[1] + place[1]) * m_cubes[0] + place[0];
    const auto at = std::lower_bound(m_added.begin(), m_added.end(), cube);
    return at != m_added.end() && *at == cube ? 6 * static_cast<int>(at - m_added.begin()) : -1;
}

bool BisectedTets::halve(std::vector<char>& marks, std::size_t most)
{
    for (bool any = true; any;)
    {
        any = false;
        const int count = static_cast<int>(m_tets.size());
        for (int t = 0; t < count; ++t)
        {
            if (m_tets[t].m_child != 0 || (marks[t] == 0 && !hasHalvedEdge(m_tets[t]))) continue;
            halve(t);
            any = true;
            if (m_tets.size() > most) return false;
        }
        marks.assign(m_tets.size(), 0);
    }
    return true;
}

std::array<Vec3, 4> BisectedTets::corners(int tet) const
{
    const Tet t = orientedTet(tet);
    return {m_nodes[t[0]], m_nodes[t[1]], m_nodes[t[2]], m_nodes[t[3]]};
}

Tet BisectedTets::orientedTet(int tet) const
{
    Tet t = m_tets[tet].m_corners;
    if (signedVolume({m_nodes[t[0]], m_nodes[t[1]], m_nodes[t[2]], m_nodes[t[3]]}) < 0) std::swap(t[2], t[3]);
    return t;
}

double BisectedTets::volume(int tet) const
{
    return std::ldexp(1.0 / 6, -m_tets[tet].m_generation);
}

int BisectedTets::nodeAt(const std::array<int, 3>& place)
{
    const std::uint64_t nx = m_cubes[0] + 1, ny = m_cubes[1] + 1;
    const auto [at, isNew] = m_places.try_emplace((place[2] * ny + place[1]) * nx + place[0], 0);
    if (isNew)
    {
        at->second = static_cast<int>(m_nodes.size());
        m_nodes.push_back({1.0 * place[0], 1.0 * place[1], 1.0 * place[2]});
        m_atHalved.push_back(0);
    }
    return at->second;
}

int BisectedTets::middleOf(int a, int b)
{
    const auto [at, isNew] = m_middles.try_emplace(edgeKey(a, b), 0);
    if (isNew)
    {
        at->second = static_cast<int>(m_nodes.size());
        m_nodes.push_back(0.5 * (m_nodes[a] + m_nodes[b]));  // exact: coordinates are multiples of 1 / 2^levels
        m_atHalved.push_back(0);
        m_atHalved[a] = m_atHalved[b] = 1;
    }
    return at->second;
}

bool BisectedTets::hasHalvedEdge(const BisectedTet& tet) const
{
    for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b)
            if (m_atHalved[tet.m_corners[a]] && m_atHalved[tet.m_corners[b]] &&
                m_middles.count(edgeKey(tet.m_corners[a], tet.m_corners[b])) > 0)
                return true;
    return false;
}

void BisectedTets::halve(int tet)
{
    BisectedTet first = m_tets[tet];
    const Tet c = first.m_corners;
    const int last = 3 - first.m_generation % 3, middle = middleOf(c[0], c[last]);
    ++first.m_generation;
    BisectedTet second = first;
    first.m_corners[last] = middle;
    for (int a = 0; a < last; ++a) second.m_corners[a] = c[a + 1];
    second.m_corners[last] = middle;
    m_tets[tet].m_child = static_cast<int>(m_tets.size());
    m_tets.push_back(first);
    m_tets.push_back(second);
}

}  // namespace bullet_fem
