// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Positions of a surface's vertices when contacts were last searched for, to tell a body that has hardly moved since.
/// Allocates at construction only.
class NotedPlace
{
public:
    NotedPlace() = default;
    /// `vertices`, ascending, are indices of the values in all calls.
    explicit NotedPlace(const std::vector<int>& vertices) : m_vertices(vertices), m_positions(vertices.size()) {}

    /// Notes the positions x [m].
    void note(const std::vector<Vec3>& x)
    {
        for (std::size_t k = 0; k < m_vertices.size(); ++k) m_positions[k] = x[m_vertices[k]];
        m_isNoted = true;
    }

    /// Discards the positions: isStill() is false until the next note().
    void forget() { m_isNoted = false; }
    bool isNoted() const { return m_isNoted; }

    /// True if all vertices at x [m] with velocities v [m/s] are and stay within `reach` [m] of their noted positions
    /// during a step of h [s].
    bool isStill(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h, double reach) const
    {
        bool isStill = m_isNoted;
        for (std::size_t k = 0; isStill && k < m_vertices.size(); ++k)
        {
            const int i = m_vertices[k];
            isStill = norm(x[i] - m_positions[k]) + h * norm(v[i]) <= reach;
        }
        return isStill;
    }

    /// The positions, one per vertex [m], for a snapshot; empty if there are none.
    std::vector<Vec3> positions() const { return m_isNoted ? m_positions : std::vector<Vec3>(); }
    /// Restores positions(): one per vertex, or none.
    void restore(const std::vector<Vec3>& positions)
    {
        m_isNoted = positions.size() == m_positions.size();
        if (m_isNoted) m_positions.assign(positions.begin(), positions.end());
    }

private:
    std::vector<int> m_vertices;
    std::vector<Vec3> m_positions;
    bool m_isNoted = false;
};

}  // namespace bullet_fem
