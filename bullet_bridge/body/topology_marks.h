// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{

/// Tells whether the tetrahedra of a body still join the nodes that they did. Bullet says so (m_bUpdateRtCst) of what
/// it appends; a program may write to m_tetras as well. To look at all of them in every step is a twentieth of its
/// time, because each lies in lines of the cache of its own: parts take turns.
class TopologyMarks
{
public:
    static constexpr int kTurns = 8;  ///< after so many steps all have been looked at

    /// Of a body with at least one node and one tetrahedron, as it is now.
    explicit TopologyMarks(const btSoftBody& body);

    /// Of a body with as many nodes and tetrahedra: false if any joins other nodes, counted from the first.
    bool match(const btSoftBody& body) const;

    /// The same of all tetrahedra if Bullet says that some are new, or their array has moved, and of the part whose
    /// turn it is otherwise.
    bool matchInTurn(const btSoftBody& body);

private:
    bool partMatches(const btSoftBody& body, int part) const;

    std::array<std::uint64_t, kTurns> m_marks;
    const btSoftBody::Tetra* m_tetras;  // as seen last
    int m_turn = 0;
};

}  // namespace bullet_fem
